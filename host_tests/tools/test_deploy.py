# SPDX-License-Identifier: MIT
"""tools/deploy: what it copies, what it leaves alone, and that power may fail at every step."""

import json
from types import SimpleNamespace

import pytest

import main
import settings_file
from deploy_bench import (
    FLASH,
    FROZEN,
    MPY,
    NEWER,
    OLD,
    RP2040,
    FakeChip,
    PowerCut,
    deploy,
    firmware,
    running,
)
from hal.store import FileStore
from tiers import TOP
from tools.deploying import arrival, deployment, image, plan, ports, targets
from tools.deploying.errors import DeployError

INTERPRETERS = "host"


@pytest.fixture(autouse=True)
def empty_flash():
    FLASH.clear()


def deployed(sources=OLD):
    """A chip on which a firmware was deployed."""
    chip = FakeChip()
    deploy(chip, firmware(sources))
    return chip


def names():
    return sorted(set(FLASH.files) - {"deployed.json"})


# ---- what is copied -------------------------------------------------------------------------


def test_onto_an_empty_chip_everything_is_copied_and_the_chip_restarted():
    chip = FakeChip()
    said = deploy(chip, firmware(OLD))
    wanted = firmware(OLD).files(MPY)
    there = FLASH.files
    assert {path: there[path] for path in wanted} == wanted
    assert sorted(there) == sorted([*wanted, "deployed.json"])
    assert "main.py" in wanted and "board.py" in wanted and "uss/master.mpy" in wanted
    put = [entry[2] for entry in chip.log if entry[0] == "replace"]
    assert put.count("main.py") == 1 and put[-2:] == ["main.py", "deployed.json"]
    assert chip.restarts == 1
    assert "All 8 files are there" in said


def test_it_says_before_it_interrupts_that_the_drives_stop():
    said = []
    chip = FakeChip()
    chip.interrupt = lambda: said.append("INTERRUPTED") or ">>> "
    deploy(chip, firmware(OLD), said)
    assert "stops all its drives now" in said[0] and said[1] == "INTERRUPTED"


def test_a_panel_that_has_stopped_its_drives_is_reported():
    chip = FakeChip()
    chip.heard = main.STOPPED + "\r\n>>> "
    assert "It has stopped them." in deploy(chip, firmware(OLD))
    assert "It has stopped them." not in deploy(FakeChip(), firmware(OLD))


def test_main_goes_first_and_comes_last():
    deployed()
    chip = FakeChip()
    deploy(chip, firmware(NEWER))
    changes = [entry for entry in chip.log if "main.py" in entry or "main.py.new" in entry]
    assert changes == [("remove", "main.py"), ("replace", "main.py.new", "main.py")]
    order = [entry[-1] for entry in chip.log if entry[0] in ("replace", "remove")]
    assert order[:3] == ["deployed.json", "app.py", "main.py"]
    assert order[-3:] == ["main.py", "deployed.json", "app.py"]


def test_only_what_differs_is_copied():
    deployed()
    chip = FakeChip()
    deploy(chip, firmware(OLD | {"uss/master.py": b"speed = 3"}))
    copied = [entry[2] for entry in chip.log if entry[0] == "replace"]
    assert copied == ["deployed.json", "app.py", "uss/master.mpy", "main.py", "deployed.json"]


def test_when_nothing_differs_nothing_is_written():
    deployed()
    chip = FakeChip()
    assert "nothing is copied" in deploy(chip, firmware(OLD))
    assert chip.steps == 0 and chip.restarts == 1
    deploy(FakeChip(free=0), firmware(OLD))  # nor is room wanted


def test_what_an_interruption_has_left_goes_even_when_nothing_differs():
    for left in ("deployed.json.new", "app.py.new", "uss/master.mpy.new"):
        deployed()
        FLASH.put(left)
        deploy(FakeChip(), firmware(OLD))
        assert left not in FLASH.files


def test_what_is_no_longer_part_is_removed_with_its_folder():
    deployed()
    deploy(FakeChip(), firmware(NEWER))
    assert names() == sorted(firmware(NEWER).files(MPY))
    assert "hal" not in FLASH.folders


def test_what_others_have_put_there_stays():
    others = ("boot.py", "settings.json", "settings.json.bad", "uss/mine.py", "lib/mine.py")
    for path in others:
        FLASH.put(path)
    deployed()
    deploy(FakeChip(), firmware(NEWER))
    for path in others:
        assert FLASH.files[path] == b"mine", path
    deploy(FakeChip(), firmware({}))
    assert names() == sorted(others)


def test_settings_outlive_an_update_and_the_way_back():
    before = b'{\n  "baud": 9600,\n  "drives": [7, 3],\n  "kinds": {"7": "g110/127"}\n}\n'
    deployed()
    FLASH.put("settings.json", before)
    for sources in (NEWER, OLD):
        deploy(FakeChip(), firmware(sources))
        assert FLASH.files["settings.json"] == before
    store = FileStore("settings.json", FLASH.open, FLASH)
    settings = settings_file.load(store)  # as this firmware takes them over
    assert (settings.baud, settings.drives, settings.kind(7)) == (9600, (7, 3), "g110/127")
    assert settings.complaint is None


def test_a_dry_run_tells_and_changes_nothing():
    deployed()
    before = FLASH.copy()
    chip = FakeChip()
    said = deploy(chip, firmware(NEWER), dry_run=True)
    assert FLASH.copy() == before and chip.steps == 0 and chip.restarts == 1
    assert "would copy    panel/pages/home.mpy  12 bytes" in said
    assert "would remove  uss/old.mpy" in said
    assert "Would copy 4 of 7 files" in said and "remove 2." in said


def test_remove_takes_away_all_that_was_copied():
    deployed()
    chip = FakeChip()
    deploy(chip, firmware({}))
    assert FLASH.copy() == ({}, {""})
    assert chip.restarts == 1


# ---- compiled files -------------------------------------------------------------------------


@pytest.mark.parametrize(
    "header, chip_mpy, suits",
    [
        (b"M\x06\x00\x1f", 0x1306, True),
        (b"M\x06\x13\x1f", 0x1306, True),  # machine code for ARMv6-M
        (b"M\x06\x00\x1f", 0x1206, True),  # the sub-version is about machine code
        (b"M\x06\x13\x1f", 0x1206, False),
        (b"M\x06\x13\x1f", 0x1706, True),  # a later ARM (persistentcode.h, ARCH_TEST)
        (b"M\x06\x17\x1f", 0x1306, False),  # an earlier one
        (b"M\x06\x13\x1f", 0x2B06, False),  # for another processor
        (b"M\x06\x00\x1f", 0x1307, False),
        (b"M\x06\x00\x1f", 0, False),  # a chip that takes none
        (b"C\x06\x00\x1f", 0x1306, False),  # of CircuitPython
    ],
)
def test_which_compiled_files_a_chip_takes(header, chip_mpy, suits):
    assert image.suits(header, chip_mpy) is suits


def test_a_chip_that_wants_another_version_gets_the_sources():
    chip = FakeChip(("micropython", (1, 40, 0), RP2040, 0x1307))
    assert "version 7.3: the sources are copied" in deploy(chip, firmware(OLD))
    assert names() == sorted(OLD)


def test_without_mpy_cross_the_sources_are_copied():
    assert "no mpy-cross" in deploy(FakeChip(), firmware(OLD, compiled=False))
    assert names() == sorted(OLD)
    assert running({"old": OLD}) == "old"


def test_sources_make_place_for_compiled_files_and_these_for_sources():
    compiled, sources = firmware(OLD), firmware(OLD, compiled=False)
    for made in (compiled, sources, compiled):
        deploy(FakeChip(), made)
        assert names() == sorted(made.files(MPY))


def test_the_whole_firmware_of_the_tree_is_taken():
    made = image.Firmware.read(TOP, "pico")
    wanted = {"main.py", "app.py", "board.py", "chips/rp2.py", "uss/master.py"}
    assert wanted | {"panel/pages/home.py"} <= set(made.sources)
    assert not [path for path in made.sources if path.startswith(image.LEFT_OUT)]
    own = TOP / "boards" / "sim" / "board.py"
    other = image.Firmware.read(TOP, "pico", own)
    assert other.sources["board.py"] == own.read_bytes() != made.sources["board.py"]
    assert "chips/rp2.py" in other.sources


def test_a_board_file_for_a_chip_that_nobody_knows_is_refused(tmp_path):
    own = tmp_path / "mine.py"
    own.write_text("import os\nfrom chips import z80\n")
    with pytest.raises(DeployError, match=r"mine\.py wants chips/z80\.py"):
        image.Firmware.read(TOP, "pico", own)


def test_a_board_file_with_a_slip_is_refused_before_any_drive_is_stopped(tmp_path):
    own = tmp_path / "mine.py"
    for text, says in (
        (b"from chips import rp2\nKEYS = (\n", r"mine\.py, line 2: '\(' was never closed"),
        (b"\xff\xfe\x00", r"mine\.py: "),
    ):
        own.write_bytes(text)
        with pytest.raises(DeployError, match=says):
            image.Firmware.read(TOP, "pico", own)


# ---- what is not ours -----------------------------------------------------------------------


def test_a_board_file_of_your_own_is_kept():
    FLASH.put("board.py", b"my pins")
    assert "board.py on the chip is not the tree's, and is kept" in deploy(
        FakeChip(), firmware(OLD)
    )
    deploy(FakeChip(), firmware(NEWER))
    assert FLASH.files["board.py"] == b"my pins" and FLASH.files["app.mpy"]


def test_a_board_file_that_was_changed_on_the_chip_is_kept():
    deployed()
    FLASH.put("board.py", b"pins = 7")
    deploy(FakeChip(), firmware(NEWER))
    assert FLASH.files["board.py"] == b"pins = 7"


def test_a_board_file_that_was_named_replaces_it_and_is_yours_from_then_on():
    FLASH.put("board.py", b"my pins")
    deploy(FakeChip(), firmware(OLD | {"board.py": b"new_pins = 1"}), new_board=True)
    assert FLASH.files["board.py"] == b"new_pins = 1"
    deploy(FakeChip(), firmware(NEWER))
    assert FLASH.files["board.py"] == b"new_pins = 1"
    deploy(FakeChip(), firmware({}))
    assert names() == ["board.py"]


def test_the_boards_own_file_comes_with_each_deployment():
    deployed()
    deploy(FakeChip(), firmware(NEWER))
    assert FLASH.files["board.py"] == NEWER["board.py"]


@pytest.mark.parametrize("path", ["main.py", "app.py", "app.mpy", "uss/master.py", "settings.py"])
def test_a_file_of_others_in_the_way_is_a_refusal_and_replace_replaces_it(path):
    sources = OLD | {"settings.py": b"settings = 1"}
    FLASH.put(path)
    chip = FakeChip()
    with pytest.raises(DeployError, match="are in the way(.|\n)*" + path):
        deploy(chip, firmware(sources))
    assert FLASH.files == {path: b"mine"} and chip.steps == 0 and chip.restarts == 1
    assert f"{path} on the chip is not ours, and is replaced" in deploy(
        FakeChip(), firmware(sources), replace=True
    )
    assert names() == sorted(firmware(sources).files(MPY))


def test_a_folder_of_others_in_the_way_is_never_replaced():
    FLASH.put("app/__init__.py")
    with pytest.raises(DeployError, match="in the way(.|\n)*app"):
        deploy(FakeChip(), firmware(OLD), replace=True)
    assert FLASH.files == {"app/__init__.py": b"mine"}


def test_a_file_of_ours_that_was_changed_on_the_chip_is_not_overwritten_silently():
    deployed()
    FLASH.put("uss/master.mpy", b"changed")
    with pytest.raises(DeployError, match="uss/master.mpy"):
        deploy(FakeChip(), firmware(NEWER))


def test_files_that_were_copied_by_hand_and_are_the_same_are_no_obstacle():
    for path, data in firmware(OLD).files(MPY).items():
        FLASH.put(path, data)
    deployed()
    assert running({"old": firmware(OLD).files(MPY)}) == "old"


def test_a_damaged_list_makes_everything_somebody_elses():
    deployed()
    FLASH.put("deployed.json", b'{"files": {"app')
    chip = FakeChip()
    with pytest.raises(DeployError, match="app.mpy board.py|app.mpy"):
        deploy(chip, firmware(NEWER))
    deploy(FakeChip(), firmware(NEWER), replace=True)
    assert running({"newer": without(firmware(NEWER).files(MPY), "board.py")}) == "newer"


def without(files, path):
    return {other: files[other] for other in files if other != path}


@pytest.mark.parametrize(
    "path", ["settings.json", "settings.json.bad", "boot.py", "../outside", "/outside", "a//b", ""]
)
def test_a_list_never_makes_us_remove_what_is_not_ours_to_list(path):
    FLASH.put("deployed.json", json.dumps({"files": {path: [plan.sha256(b"mine")]}}).encode())
    FLASH.files[path] = b"mine"
    deploy(FakeChip(), firmware({}))
    assert FLASH.files[path] == b"mine"


# ---- who is refused -------------------------------------------------------------------------


@pytest.mark.parametrize(
    "identity, modules, reason",
    [
        (("circuitpython", (9, 2, 1), RP2040.lower(), 517), "", "is not MicroPython"),
        (("micropython", (1, 24, 1), RP2040, MPY), "", "1.24.1 is too old: 1.25"),
        (("micropython", (1, 25, 0), "Raspberry Pi Pico2 with RP2350", 7942), "", "RP2350"),
        (("micropython", (1, 25, 0), "rp2", MPY), "", "for the RP2040"),
        (
            ("micropython", (1, 25, 0), "Pico2 with RP2350", MPY),
            "",
            "for the RP2040, not for Pico2",
        ),
        (None, "main blinky", "another program is frozen"),
    ],
)
def test_what_cannot_run_it_is_refused_and_left_as_it_was(identity, modules, reason):
    chip = FakeChip(identity, modules)
    with pytest.raises(DeployError, match=reason):
        deploy(chip, firmware(OLD))
    assert FLASH.files == {} and chip.restarts == 1


def test_a_file_system_that_is_too_full_is_refused_before_anything_changes():
    chip = FakeChip(free=20)
    with pytest.raises(DeployError, match="96 KiB are wanted, 80 KiB are free"):
        deploy(chip, firmware(OLD))
    assert FLASH.files == {} and chip.restarts == 1
    deploy(FakeChip(free=24), firmware(OLD))


def test_an_update_wants_room_for_what_grows_and_one_file_more():
    deployed()
    big = OLD | {"uss/master.py": b"x" * 41_000}
    with pytest.raises(DeployError, match="too full"):
        deploy(FakeChip(free=16 + 10), firmware(big))
    deploy(FakeChip(free=16 + 11), firmware(big))
    # The room of a file that is replaced is free again when the next one is written.
    bigger = big | {"uss/old.py": b"x" * 41_000}
    deploy(FakeChip(free=16 + 11), firmware(bigger))
    other = {"uss/master.py": b"y" * 41_000, "uss/old.py": b"y" * 41_000}
    deploy(FakeChip(free=16 + 11), firmware(bigger | other))


# ---- interrupted at any point ---------------------------------------------------------------


def compiled(sources):
    return firmware(sources).files(MPY)


def frozen_in(sources):
    """The firmware as it is frozen in, of a third generation."""
    return {path: data + b" # frozen" for path, data in sources.items()}


FROZEN_FILES = frozen_in(OLD)

# Before, what is deployed then, whether the chip has the panel frozen in.
CASES = {
    "first copying": (None, firmware(OLD), False),
    "update": (firmware(OLD), firmware(NEWER), False),
    "to sources": (firmware(OLD), firmware(NEWER, compiled=False), False),
    "from sources": (firmware(OLD, compiled=False), firmware(NEWER), False),
    "sources": (firmware(OLD, compiled=False), firmware(NEWER, compiled=False), False),
    "removal": (firmware(OLD), firmware({}), False),
    "onto a frozen panel": (None, firmware(OLD), True),
    "update over a frozen panel": (firmware(OLD), firmware(NEWER), True),
    "sources over a frozen panel": (firmware(OLD), firmware(NEWER, compiled=False), True),
    "removal over a frozen panel": (firmware(OLD), firmware({}), True),
}


def prepare(before, frozen):
    """An empty chip, and what was there before."""
    FLASH.clear()
    FLASH.put("settings.json", b"settings")
    FLASH.put("boot.py", b"boot")
    if before:
        deploy(FakeChip(modules=FROZEN if frozen else "gc"), before)


def versions(before, then, frozen):
    """Name -> files of what may start."""
    may = {"before": before, "then": then}
    may = {name: made.files(MPY) for name, made in may.items() if made and made.sources}
    if not frozen:
        return may
    # The frozen main.py is the one that runs.
    may = {name: without(files, "main.py") for name, files in may.items()}
    return may | {"frozen": FROZEN_FILES}


def expected(made, frozen, name):
    if made and made.sources:
        return name
    return "frozen" if frozen else None


@pytest.mark.parametrize("error", [PowerCut, DeployError, KeyboardInterrupt])
@pytest.mark.parametrize("case", CASES)
def test_interrupted_at_any_step_nothing_half_starts_and_the_next_run_ends_it(case, error):
    before, then, is_frozen = CASES[case]
    frozen = FROZEN_FILES if is_frozen else None
    modules = FROZEN if is_frozen else "gc"
    may = versions(before, then, is_frozen)
    old, new = expected(before, is_frozen, "before"), expected(then, is_frozen, "then")
    cut_at, seen = 1, []
    while True:
        prepare(before, is_frozen)
        assert running(may, frozen) == old
        chip = FakeChip(modules=modules, cut_at=cut_at, error=error)
        try:
            deploy(chip, then)
        except error:
            starts = running(may, frozen)
            assert starts in (None, old, new), (cut_at, starts)
            seen.append(starts)
            deploy(FakeChip(modules=modules), then)
        else:
            assert chip.steps < cut_at
            break
        assert running(may, frozen) == new, cut_at
        left = {path for path in FLASH.files if path.endswith(".new")}
        assert not left and FLASH.files["settings.json"] == b"settings", cut_at
        assert FLASH.files["boot.py"] == b"boot"
        cut_at += 1
    assert cut_at > 15 and None in seen  # there were steps, and times at which nothing started


@pytest.mark.parametrize("is_frozen", [False, True])
def test_interrupted_and_then_another_version_follows(is_frozen):
    frozen = FROZEN_FILES if is_frozen else None
    modules = FROZEN if is_frozen else "gc"
    third = firmware({path: data + b" # 3" for path, data in OLD.items()})
    may = versions(None, third, is_frozen)
    for cut_at in range(1, 200):
        prepare(firmware(OLD), is_frozen)
        chip = FakeChip(modules=modules, cut_at=cut_at)
        try:
            deploy(chip, firmware(NEWER))
        except PowerCut:
            deploy(FakeChip(modules=modules), third)
            assert running(may, frozen) == "then", cut_at
            assert not set(names()) - set(third.files(MPY)) - {"settings.json", "boot.py"}
        else:
            return
    raise AssertionError("it never came to its end")


def test_after_an_interruption_it_says_what_that_means():
    for cut_at in range(1, 200):
        prepare(firmware(OLD), False)
        chip = FakeChip(cut_at=cut_at, error=DeployError)
        said = []
        try:
            deploy(chip, firmware(NEWER), said)
        except DeployError:
            if "Nothing was changed. Restarted." in said[-1]:
                assert running(versions(firmware(OLD), None, False)) == "before"
                assert chip.restarts == 1
            else:
                assert "starts no panel until tools/deploy" in said[-1]
                assert chip.restarts == 0
        else:
            assert cut_at > 20
            return
    raise AssertionError("it never came to its end")


def test_a_chip_that_is_gone_is_not_waited_for():
    said = []
    with pytest.raises(PowerCut):
        deploy(FakeChip(cut_at=1), firmware(OLD), said)
    assert "It could not be restarted: unplug it" in said[-1]


def test_a_file_that_arrives_changed_is_noticed_before_the_panel_may_start():
    for path in ("uss/master.mpy", "main.py"):
        prepare(firmware(OLD), False)
        chip = FakeChip()
        chip.spoilt = path + ".new"
        with pytest.raises(DeployError, match=path + " did not arrive as it was sent"):
            deploy(chip, firmware(NEWER))
        assert running(versions(firmware(OLD), firmware(NEWER), False)) is None
        assert chip.restarts == 0


def test_a_frozen_panel_keeps_its_main_and_that_is_said():
    said = deploy(FakeChip(modules=FROZEN), firmware(OLD))
    assert "but for main.py,\n    which stays the frozen one" in said
    assert "tools/deploy --remove takes it away again" in said
    assert "main.py" not in FLASH.files and "app.mpy" in FLASH.files


def test_what_lies_beside_a_frozen_panel_is_listed_and_removed():
    prepare(firmware(OLD), True)
    listed = deploy(FakeChip(modules=FROZEN), firmware({}), dry_run=True)
    names = {line.split()[2] for line in listed.splitlines() if line.startswith("would remove")}
    assert names == {*firmware(OLD).files(MPY)} - {"main.py"}
    said = deploy(FakeChip(modules=FROZEN), firmware({}))
    assert said.splitlines()[-2:] == [
        "The panel that is frozen into its MicroPython runs now.",
        "Restarted.",
    ]
    assert not names & {*FLASH.files}


def test_a_main_of_ours_goes_when_the_panel_is_frozen_in_later():
    deployed()
    deploy(FakeChip(modules=FROZEN), firmware(OLD))
    assert "main.py" not in FLASH.files


# ---- the port -------------------------------------------------------------------------------


def usb(device, vid=0x2E8A, pid=0x0005, serial_number="E66"):
    return SimpleNamespace(device=device, vid=vid, pid=pid, serial_number=serial_number)


OTHER = usb("/dev/ttyUSB0", 0x0403, 0x6001)


def test_the_one_pico_is_found_among_other_ports():
    assert ports.choose([OTHER, usb("/dev/ttyACM0"), usb("/dev/ttyS0", None, None)]) == (
        "/dev/ttyACM0"
    )


def test_an_esp32_s3_is_found_and_what_may_be_a_line_of_drives_is_not():
    s3 = usb("/dev/ttyACM3", 0x303A, 0x4001)
    assert ports.choose([OTHER, usb("/dev/ttyACM0"), s3], chip="ESP32S3") == "/dev/ttyACM3"
    for chip in ("ESP32", "ESP32S3"):
        with pytest.raises(DeployError, match="behind a USB adapter: name that, --port"):
            ports.choose([OTHER, usb("/dev/ttyUSB1", 0x10C4, 0xEA60)], True, chip)


def test_the_firmware_for_each_board_is_what_its_chip_takes():
    """Version 6.3 of .mpy files; numbers of machine code: py/persistentcode.h."""
    compiler_of = {"RP2040": 4, "RP2350": 7, "ESP32S3": 10, "ESP32": 10}
    for board, chip, chips_file in (
        ("pico", "RP2040", "chips/rp2.py"),
        ("pico2", "RP2350", "chips/rp2.py"),
        ("esp32s3", "ESP32S3", "chips/esp32.py"),
        ("esp32", "ESP32", "chips/esp32.py"),
    ):
        made = image.Firmware.read(TOP, board)
        assert made.chip == chip and chips_file in made.sources
        code = {"armv6m": 4, "xtensawin": 10}[targets.TARGETS[chip].machine_code]
        compiled = bytes((ord("M"), 6, code << 2 | 3))
        assert image.suits(compiled, (compiler_of[chip] << 2 | 3) << 8 | 6), chip
        assert not image.suits(compiled, ((14 - code) << 2 | 3) << 8 | 6), chip
        assert not image.suits(compiled, (compiler_of[chip] << 2 | 2) << 8 | 6), chip


def test_several_picos_are_listed():
    with pytest.raises(DeployError) as refusal:
        ports.choose([usb("/dev/ttyACM1", serial_number="B"), usb("/dev/ttyACM0")])
    assert str(refusal.value).splitlines()[1:] == [
        "    --port /dev/ttyACM0   serial number E66",
        "    --port /dev/ttyACM1   serial number B",
    ]


def test_no_pico_and_one_without_micropython():
    with pytest.raises(DeployError, match="no Pico with MicroPython is plugged in"):
        ports.choose([OTHER])
    with pytest.raises(DeployError, match="it waits for a .uf2 file"):
        ports.choose([OTHER], waits_for_uf2=True)


def test_a_pico_with_its_boot_rom_running_is_recognised(tmp_path):
    (tmp_path / "1-0:1.0").mkdir()  # an interface has no such files
    for name, product in (("1-2", "0005"), ("1-3", "0003")):
        assert not ports.waits_for_uf2(tmp_path)
        (tmp_path / name).mkdir()
        (tmp_path / name / "idVendor").write_text("2e8a\n")
        (tmp_path / name / "idProduct").write_text(product + "\n")
    assert ports.waits_for_uf2(tmp_path)
    assert not ports.waits_for_uf2(tmp_path / "no such folder")


# ---- whether the panel comes up -------------------------------------------------------------


class Line:
    """A serial port, in time that only passes while somebody waits.

    says: (second, bytes), (second, None): the port goes, (second, "back"): it is there again.
    """

    def __init__(self, *says, prompt=False):
        self.says = list(says)
        self.now = 0.0
        self.away = False
        self.prompt = prompt
        self.opened = 0

    def now_s(self):
        return self.now

    def sleep_s(self, seconds):
        self.now += seconds

    def open(self):
        self.hear_all()
        if self.away:
            raise DeployError("there is no port")
        self.opened += 1
        return self

    def close(self):
        pass

    def send(self, data):
        if self.prompt:
            self.says.append((self.now, data + b"\n>>> "))

    def hear(self):
        heard = self.hear_all()
        if self.away:
            raise DeployError("the port has gone")
        return heard

    def hear_all(self):
        heard = b""
        while self.says and self.says[0][0] <= self.now:
            said = self.says.pop(0)[1]
            if isinstance(said, bytes):
                heard += said
            else:
                self.away = said is None
        return heard

    def wait(self):
        arrival.wait_for_panel(self.open, self.now_s, self.sleep_s)


def test_the_panel_says_that_it_runs():
    line = Line((2, main.RUNS.encode() + b"\r\n"))
    line.wait()
    assert 2 <= line.now < 3


def test_the_port_may_go_and_come_again():
    line = Line((0, None), (1.5, "back"), (1.6, None), (2, "back"), (4, main.RUNS.encode()))
    line.wait()
    assert 4 <= line.now < 5


def test_the_traceback_of_a_panel_that_fails_is_shown():
    line = Line((1, b"Traceback\r\nImportError: no module named 'uss'\r\n"), (1, b">>> "))
    with pytest.raises(DeployError, match="    ImportError: no module named 'uss'"):
        line.wait()
    assert line.now < 2


def test_a_prompt_that_was_said_before_the_port_was_opened_shows_itself():
    line = Line(prompt=True)
    with pytest.raises(DeployError, match="has not started"):
        line.wait()
    assert line.now < 5


def test_a_silent_one_is_given_up():
    line = Line()
    with pytest.raises(DeployError, match="    nothing"):
        line.wait()
    assert arrival.START_S <= line.now < arrival.START_S + 5


def test_a_port_that_does_not_come_back_is_given_up():
    line = Line((0, None))
    with pytest.raises(DeployError, match="has not started"):
        line.wait()
    assert line.opened == 0


# ---- what the firmware promises tools/deploy ------------------------------------------------


def test_the_panel_says_what_is_waited_for():
    assert main.RUNS.encode().startswith(arrival.RUNS)
    assert main.STOPPED.startswith(deployment.STOPPED)


def test_the_app_is_the_first_that_main_imports_so_that_the_gate_holds_it():
    source = (TOP / "firmware" / "main.py").read_text()
    first = next(line for line in source.splitlines() if line.startswith(("import ", "from ")))
    assert first == "from app import App"
    with pytest.raises(ImportError, match="tools/deploy"):
        exec(plan.GATE_TEXT, {})
