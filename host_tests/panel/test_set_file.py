# SPDX-License-Identifier: MIT
"""The file of a parameter set, and what ten of them take."""

import io
from binascii import crc32

import catalogue
from boards.sim.chip.flash import BLOCK_BYTES, CAPACITY_BYTES, Flash
from hal.store import FileStore
from panel import texts
from panel.menu.sets import words
from panel.pages.parameter_words import NO_ANSWER
from panel.sets import pump, saving, set_file, work, writing
from pkw_bench import AskedDrive
from sets_bench import made
from uss import families, pkw
from uss.families.bop import on_bop
from uss.pkw import NUMBER_MAX

FILE_SYSTEM_BYTES = 1408 * 1024  # of a Pico with the firmware file: nothing else is in it
SECTOR_BYTES = 4096
WORDS = (b"U16", b"I16")


def store_with(**files):
    flash = Flash()
    for name in files:
        flash.files[name + set_file.ENDING] = files[name]
    return FileStore("settings.json", flash.open, flash)


def all_of(family):
    """A row for each value that the catalogue has of a family."""
    for row in catalogue.rows(family):
        number = catalogue.number(row)
        never = work.NEVER.get(family, work.USUAL_NEVER)
        if row[catalogue.KEY][:1] == b"P" and number not in never:
            kind = row[catalogue.TYPE]
            for index in range(catalogue.indices(row)):
                yield number, index, kind, b"1A2B" if kind in WORDS else b"1A2B3C4D"


def error_of(data):
    try:
        store = store_with(one=data)
        set_file.read_head(store, "one.set")
        return [row for row in set_file.rows(store, "one.set") if row]
    except ValueError as error:
        return error.args[0]


def test_what_was_written_is_read():
    rows = [
        (3, 0, b"U16", b"0003"),
        (1120, 0, b"Float", b"41200000"),
        (1120, 1, b"I32", b"FFFFFFFF"),
    ]
    data = made(rows, ratings=[(206, b"3F400000")])
    assert error_of(data) == [
        (0, 3, 0, b"U16", 0, 3), (1, 1120, 0, b"Float", 0x4120, 0),
        (2, 1120, 1, b"I32", 0xFFFF, 0xFFFF),
    ]  # fmt: skip
    head = set_file.read_head(store_with(one=data), "one.set")
    assert (head.family, head.address, head.name) == ("mm440", 1, b"MADE")
    assert head.ratings == {206: (0x3F40, 0)}


def test_a_head_is_to_the_letter_too():
    """Its check was made anew each time: whoever wrote it meant what stands there."""
    rows, ratings = [(3, 0, b"U16", b"0003")], [(206, b"3F400000")]
    for name in (b"A", b"0123456789", b" PUMP \xb0C"):
        for address in (0, 31):
            data = made(rows, address=address, name=name, ratings=ratings)
            head = set_file.read_head(store_with(one=data), "one.set")
            assert (head.address, head.name) == (address, name)
    for options in (
        {"address": -1},
        {"address": 32},
        {"name": b""},
        {"name": b"01234567890"},
        {"name": b"PUMP\x1f1"},
        {"ratings": [(206, b"3f400000")]},
        {"ratings": [(206, b"3F40000")]},
        {"ratings": [(206, b"3F400000 ")]},
        {"ratings": [(206, b"3F40000G")]},
    ):
        assert error_of(made(rows, **options)) == words.DAMAGED, options


def sealed(text, count):
    """With a last line that fits it."""
    return text + b"end %d %08X\n" % (count, crc32(text) & 0xFFFFFFFF)


def test_the_first_line_and_the_names_of_the_head_are_those_of_a_set():
    text = b"USS SET 1\nfamily mm440\naddress 1\nname MADE\npanel 0.0\nP0003 0 U16 0003\n"
    assert len(error_of(sealed(text, 1))) == 1
    for old, new, outcome in (
        (b"SET 1", b"SET 10", words.NO_SET),
        (b"SET 1", b"SET 2", words.NO_SET),
        (b"SET 1", b"SET 0", words.NO_SET),
        (b"family", b"familz", words.DAMAGED),
        (b"address", b"addresr", words.DAMAGED),
        (b"name", b"namf", words.DAMAGED),
        (b"panel", b"pamel", words.DAMAGED),
        (b"family ", b"family:", words.DAMAGED),
        (b"panel 0.0", b"panel", words.DAMAGED),
        (b"address 1", b"address 01", words.DAMAGED),
        (b"address 1", b"address +1", words.DAMAGED),
        (b"address 1", b"address one", words.DAMAGED),
    ):
        assert error_of(sealed(text.replace(old, new), 1)) == outcome, new


def test_a_row_is_to_the_letter_too():
    row = (1120, 0, b"Float", b"41200000")
    assert len(error_of(made([row, (1120, 254, b"U16", b"0003")]))) == 2
    for wrong in (
        (1120, 0, b"U64", b"00000003"),
        (1120, 0, b"float", b"41200000"),
        (1120, 0, b"Float", b"4120000"),
        (1120, 0, b"Float", b"41200000 "),
        (1120, 0, b"Float", b"4120000a"),
        (1120, 0, b"U16", b"41200000"),
        (1120, 255, b"U16", b"0003"),
        (NUMBER_MAX + 1, 0, b"U16", b"0003"),
    ):
        assert error_of(made([wrong])) == words.DAMAGED, wrong
    assert len(error_of(made([(NUMBER_MAX, 0, b"U16", b"0003")]))) == 1


def test_the_rows_stand_in_their_order():
    """By number, and by index where that is the same; none stands there twice."""
    places = (3, 0), (3, 1), (4, 0), (300, 254), (301, 0)
    rows = [place + (b"U16", b"0003") for place in places]
    assert len(error_of(made(rows))) == 5
    for at in range(4):
        for some in ([rows[at + 1], rows[at]], [rows[at], rows[at]]):
            assert error_of(made(some)) == words.DAMAGED, some


def test_a_file_has_no_more_than_128_kb():
    """With remarks, of which the last line here has as many as it takes."""
    data = made([(3, 0, b"U16", b"0003")])
    assert len(error_of(data + b"#" * (131072 - len(data)))) == 1
    assert error_of(data + b"#" * (131073 - len(data))) == words.TOO_BIG


def test_a_line_has_64_characters_at_the_most_without_its_remark():
    """Wherever the piece ends that is read at once."""
    for length in (64, 65):
        texts = []
        for before in range(180, 260, 5):
            line = b"panel " + b"x" * (length - 6)
            data = b"USS SET 1 #" + b"-" * before + b"\nfamily mm440\naddress 1\nname A\n" + line
            texts.append(error_of(data))
        assert (words.NO_SET in texts) == (length > 64), texts


def test_each_type_has_its_width():
    for kind in (b"U16", b"I16"):
        assert set_file.row_line(1120, 1, kind, 0, 0xAB) == b"P1120 1 %s 00AB" % kind
        assert error_of(made([(1120, 1, kind, b"00AB")])) == [(0, 1120, 1, kind, 0, 0xAB)]
        assert error_of(made([(1120, 1, kind, b"000000AB")])) == words.DAMAGED, kind
    for kind in (b"U32", b"I32", b"Float", b"BICO"):
        assert set_file.row_line(3, 0, kind, 0x1F, 0xAB) == b"P0003 0 %s 001F00AB" % kind
        assert error_of(made([(3, 0, kind, b"001F00AB")])) == [(0, 3, 0, kind, 0x1F, 0xAB)]
        assert error_of(made([(3, 0, kind, b"00AB")])) == words.DAMAGED, kind


def test_a_head_is_written_as_it_is_read():
    ratings = {207: (0, 0x1234), 206: (0x3F40, 0)}
    assert set_file.head_lines(b"mm440", 31, b"PUMP 1", b"1.0", ratings) == [
        b"USS SET 1", b"family mm440", b"address 31", b"name PUMP 1", b"panel 1.0",
        b"rating 206 3F400000", b"rating 207 00001234",
    ]  # fmt: skip


def test_whoever_reads_a_file_gives_way_behind_every_second_row_and_is_told_its_check():
    rows = [(3, index, b"U16", b"0003") for index in range(5)]
    data = made(rows)
    told = []
    found = set_file.rows(store_with(one=data), "one.set")

    def read():
        told.append((yield from found))

    places = [row and row[0] for row in read()]
    assert places == [0, 1, None, 2, 3, None, 4], places
    assert told == [crc32(data[: data.index(b"end ")])] and b"%08X" % told[0] in data


def test_a_file_that_ends_too_soon_says_so_and_one_that_goes_on_is_damaged():
    rows, ratings = [(3, 0, b"U16", b"0003"), (4, 0, b"U16", b"0003")], [(206, b"3F400000")]
    whole = made(rows, ratings=ratings)
    lines = whole.split(b"\n")[:-1]
    assert len(lines) == 9
    for count in range(9):
        cut = b"".join([line + b"\n" for line in lines[:count]])
        assert error_of(cut) == words.CUT_SHORT, cut
    for more in (b"\n", b"P0005 0 U16 0003\n", lines[-1] + b"\n", b" "):
        assert error_of(whole + more) == words.DAMAGED, more
    for more in (b"# as it was delivered\n", b"   # so\n#\n"):
        assert len(error_of(whole + more)) == 2, more
    for at in range(1, 9):
        blank = lines[:at] + [b""] + lines[at:]
        assert error_of(b"\n".join(blank)) == words.DAMAGED, at


class Store:
    """Counts the files that are open."""

    def __init__(self, data):
        self.data = data
        self.opened = 0

    def open(self, name):
        self.opened += 1
        return File(self)


class File:
    def __init__(self, store):
        self.store = store
        self.read = io.BytesIO(store.data).read

    def close(self):
        self.store.opened -= 1


def test_no_file_stays_open_whatever_is_in_it():
    good = made([(3, 0, b"U16", b"0003")])
    for data in (good, good[:40], good.replace(b"0003", b"0004"), b""):
        store = Store(data)
        try:
            set_file.read_head(store, "one.set")
            assert store.opened == 0
            list(set_file.rows(store, "one.set"))
        except ValueError:
            pass
        assert store.opened == 0, data


def test_what_the_manual_prints_is_a_set():
    with open("firmware/panel/sets/README.md", "rb") as manual:
        text = manual.read()
    block = text[text.index(b"    USS SET") : text.index(b"\n\n", text.index(b"    end "))]
    found = error_of(block.replace(b"    ", b""))
    assert len(found) == 4, (block, found)


def test_remarks_count_as_nothing():
    """As a program on a PC has them behind most lines, however long; their characters too."""
    rows = [(3, 0, b"U16", b"0003"), (1120, 0, b"Float", b"41200000")]
    bare = made(rows, ratings=[(206, b"3F400000")])
    first, *others = bare.split(b"\n")
    aligned = b"%-34s  # 2026-11-24 15:40, MICROMASTER 440\n" % first + b"\n".join(others)
    all_lines = b"".join(
        [line + b"\t # 20 \xc2\xb0C, " + 500 * b"x#" + b"\n" for line in others[:-1]]
    )
    all_lines = first + b"#\n# of the pump in the cellar\n" + all_lines + b"  # whole\n"
    long_ones = first + b"\n" + 500 * b"#xy" + b"\n" + b"\n".join(others)
    for text in (
        aligned, all_lines, all_lines.replace(b"\n", b"\r\n"), all_lines[:-1], long_ones
    ):  # fmt: skip
        assert error_of(text) == error_of(bare), text
        head = set_file.read_head(store_with(one=text), "one.set")
        assert (head.family, head.name, head.ratings) == ("mm440", b"MADE", {206: (0x3F40, 0)})
    for wrong in (b"P0003 0 #", b"P0003 0 U16 00#03", b"# P0003 0 U16 0003"):
        spoilt = bare.replace(b"P0003 0 U16 0003", wrong)
        assert spoilt != bare and error_of(spoilt) == words.DAMAGED, wrong
    assert error_of(aligned[: aligned.rindex(b"end")]) == words.CUT_SHORT
    assert error_of(first + b"\n" + 300 * b"x" + b"# no line is as long") == words.NO_SET


def test_a_line_may_end_with_carriage_return_and_line_feed():
    rows = [(3, 0, b"U16", b"0003"), (1120, 0, b"Float", b"41200000")]
    bare = made(rows, ratings=[(206, b"3F400000")])
    ended = bare.replace(b"\n", b"\r\n")
    for text in (ended, ended[:-2]):
        assert error_of(text) == error_of(bare) and len(error_of(text)) == 2
        head = set_file.read_head(store_with(one=text), "one.set")
        assert (head.family, head.name) == ("mm440", b"MADE")
    for end in (b"\r\r\n", b" \n", b" \r\n"):
        assert error_of(bare.replace(b"0003\n", b"0003" + end)) == words.DAMAGED, end


def test_a_file_that_is_cut_anywhere_is_none():
    whole = made([(3, 0, b"U16", b"0003"), (1120, 0, b"Float", b"41200000")])
    for length in range(len(whole) - 1):  # the last line feed is no matter
        assert isinstance(error_of(whole[:length]), bytes), whole[:length]
    assert len(error_of(whole[:-1])) == 2


def test_a_file_with_any_character_changed_is_none():
    whole = made([(3, 0, b"U16", b"0003"), (1120, 0, b"Float", b"41200000")])
    for place in range(len(whole)):
        for bit in (1, 4, 0x20):
            spoilt = bytearray(whole)
            spoilt[place] ^= bit
            assert isinstance(error_of(bytes(spoilt)), bytes), bytes(spoilt)


def test_ten_sets_of_an_mm440_with_all_that_it_has_fit():
    ratings = [(number, b"00000000") for number in work.USUAL_RATINGS]
    data = made(all_of("mm440"), name=b"0123456789", ratings=ratings)
    store = store_with(one=data)
    count = sum([row is not None for row in set_file.rows(store, "one.set")])
    assert count == saving.COUNTS["mm440"] > 1090
    print("a set of %d values: %d bytes" % (count, len(data)))
    assert len(data) < set_file.SIZE_MAX // 2
    sectors = -(-len(data) // SECTOR_BYTES) + 1
    assert 10 * sectors * SECTOR_BYTES < FILE_SYSTEM_BYTES // 4
    store = store_with(**{"set%d" % number: data for number in range(10)})
    assert len(store.names(set_file.ENDING)) == 10 <= saving.SETS_MAX
    assert 10 * -(-len(data) // BLOCK_BYTES) * BLOCK_BYTES < CAPACITY_BYTES


def test_the_values_are_counted():
    found = {name: sum([1 for _ in all_of(name)]) for name in catalogue.FAMILIES}
    assert found == saving.COUNTS, found


def test_what_is_left_out_has_a_reason_for_every_family():
    """Whatever asks first because it may cut the bus off is none that another drive is given."""
    for name in catalogue.FAMILIES:
        family = getattr(families, name.upper())
        bus, motor = writing.OF_FAMILY.get(name, (writing.BUS_AND_SOURCES, writing.MOTOR))
        numbers = {catalogue.number(row) for row in catalogue.rows(name)}
        for first, last in bus + motor:
            assert [one for one in numbers if first <= one <= last] or name != "mm440", first
        wanted = (family.address_number, family.baud_number, family.off_time_number)
        for number in wanted + (family.pzd_words_number, family.pkw_words_number):
            if number is not None and name != "g120":
                assert [1 for first, last in bus if first <= number <= last], (name, number)


def test_a_value_is_written_with_the_task_that_the_family_has_for_it():
    """By family, number, index, type and whether it is to last; what is always kept is kept."""
    mm3, mm440, v20, g120 = families.MM3, families.MM440, families.V20, families.G120
    for family, number, index, kind, eeprom, task in (
        (mm440, 1120, 0, b"U16", False, pkw.WRITE_WORD),
        (mm440, 1120, 1, b"I16", True, pkw.WRITE_WORD_EEPROM),
        (mm440, 1120, 1, b"Float", False, pkw.WRITE_DOUBLE),
        (mm440, 1120, 0, b"BICO", True, pkw.WRITE_DOUBLE_EEPROM),
        (mm440, 2010, 0, b"U16", False, pkw.WRITE_WORD_EEPROM),
        (mm3, 5, 1, b"U16", True, pkw.WRITE_WORD),
        (mm3, 91, 0, b"U16", False, pkw.WRITE_WORD),
        (v20, 1120, 0, b"Float", False, pkw.WRITE_DOUBLE),
        (g120, 1120, 1, b"U16", False, pkw.WRITE_ELEMENT_WORD),
        (g120, 1120, 2, b"U32", False, pkw.WRITE_ELEMENT_DOUBLE),
        (g120, 1120, 1, b"I16", True, pkw.WRITE_ELEMENT_WORD_EEPROM),
        (g120, 1120, 1, b"I32", True, pkw.WRITE_ELEMENT_DOUBLE_EEPROM),
        (g120, 2020, 1, b"U16", False, pkw.WRITE_ELEMENT_WORD_EEPROM),
    ):
        aim = pump.writes(family, (0, number, index, kind, 3, 4), eeprom)
        assert aim == (task, number, index, 3, 4), (family, number, index, kind, eeprom)
    for family, index, task in (
        (mm440, 0, pkw.READ), (mm440, 1, pkw.READ), (g120, 0, pkw.READ),
        (g120, 1, pkw.READ_ELEMENT), (mm3, 1, pkw.READ),
    ):  # fmt: skip
        assert pump.reads(family, 1120, index) == (task, 1120, index), (family, index)


def of(*numbers):
    """Tasks about these parameters; 0: a step is over."""
    return iter([((pkw.READ, number), -number) if number else None for number in numbers])


def is_over(steps):
    try:
        next(steps)
    except StopIteration:
        return True
    return False


def test_two_readings_are_on_their_way_and_taken_in_order():
    drive, taken = AskedDrive(), []
    steps = pump.run(drive, of(1, 2, 3, 4), lambda job, tag: taken.append((job.number, tag)))
    assert not is_over(steps) and not is_over(steps) and drive.numbers() == [1, 2]
    first, second = drive.asked
    second.state = pkw.DONE
    assert not is_over(steps) and taken == [] and drive.numbers() == [1, 2]
    first.state = pkw.REFUSED
    assert not is_over(steps) and taken == [(1, -1), (2, -2)]
    assert len(drive.asked) == 4 and sorted([job.number for job in drive.asked[2:]]) == [3, 4]
    for job in drive.asked[2:]:
        job.state = pkw.DONE
    assert not is_over(steps) and is_over(steps) and taken[2:] == [(3, -3), (4, -4)]
    nothing = pump.run(drive, of(), None)
    assert not is_over(nothing) and is_over(nothing)


def test_one_write_is_on_its_way_at_a_time():
    drive, taken = AskedDrive(), []
    steps = pump.run(drive, of(1, 2), lambda job, tag: taken.append(tag), 1)
    for count in (1, 2):
        assert not is_over(steps) and not is_over(steps) and len(drive.asked) == count
        drive.asked[-1].state = pkw.TIMED_OUT
    assert not is_over(steps) and is_over(steps) and taken == [-1, -2]


def test_a_task_that_is_to_be_tried_again_is_asked_again():
    drive, taken = AskedDrive(), []

    def take(job, tag):
        taken.append(tag)
        return len(taken) < 3

    steps = pump.run(drive, of(7), take)
    for count in (1, 2, 3):
        assert not is_over(steps) and drive.numbers() == [7] * count
        drive.asked[-1].state = pkw.TIMED_OUT
    assert not is_over(steps) and is_over(steps) and taken == [-7] * 3


def test_what_takes_long_has_a_step_of_its_own():
    drive, taken = AskedDrive(), []
    steps = pump.run(drive, of(1, 0, 2, 0, 3), lambda job, tag: taken.append(tag))
    assert not is_over(steps) and drive.numbers() == [1]
    assert not is_over(steps) and [job.number for job in drive.asked[1:]] == [2]
    drive.asked[0].state = pkw.DONE
    assert not is_over(steps) and taken == [-1] and len(drive.asked) == 2
    assert not is_over(steps) and len(drive.asked) == 3  # nothing was taken in that step
    for job in drive.asked[1:]:
        job.state = pkw.DONE
    assert not is_over(steps) and is_over(steps) and taken == [-1, -2, -3]
    drive = AskedDrive()
    steps = pump.run(drive, of(1, 0, 2), lambda job, tag: taken.append(tag))
    assert not is_over(steps) and drive.numbers() == [1]
    drive.asked[0].state = pkw.DONE
    assert not is_over(steps) and len(drive.asked) == 1  # one was taken: that was enough
    assert not is_over(steps) and len(drive.asked) == 2


def test_nothing_is_asked_nor_taken_where_there_is_no_room():
    drive, taken = AskedDrive(), []
    steps = pump.run(drive, of(1, 2, 3), lambda job, tag: taken.append(tag))
    drive.full = True
    assert not is_over(steps) and drive.asked == []
    drive.full = False
    assert not is_over(steps) and len(drive.asked) == 2
    drive.full = True
    for job in drive.asked:
        job.state = pkw.DONE
    assert not is_over(steps) and taken == []
    drive.full = False
    assert not is_over(steps) and taken == [-1, -2] and len(drive.asked) == 3


class Panel:
    """What a work asks of its panel, of the drive that is shown, and of the clock."""

    mask = 0xFFFF
    errand = None
    contact = True
    active = False
    step_us = 0  # a reading of the clock later
    now_us = 0
    resumed = 0

    def __init__(self):
        self.board = self.clock = self.bus = self.control = self.drive = self.survey = self
        self.family = families.MM440

    def ticks_us(self):
        self.now_us += self.step_us
        return self.now_us & self.mask

    def resume(self):
        self.resumed += 1

    def is_active(self):
        return self.active


class Steps(work.Work):
    """Does so many steps, then what it is told to."""

    def __init__(self, panel, count=10**6, last=None):
        self.count, self.last, self.did, self.ahead = count, last, 0, 0
        work.Work.__init__(self, panel, panel)

    def work(self):
        for _ in range(self.count):
            self.did += 1
            yield
        if self.last is not None:
            raise self.last
        self.end(words.ALL_EQUAL)

    def look_ahead(self):
        if not self.ahead:
            return False
        self.ahead -= 1
        return True


def stepped(panel, steps, *times_ms):
    for now_ms in times_ms:
        steps.step(now_ms & panel.mask)
    return steps.outcome


def test_what_belongs_to_a_motor_and_what_is_no_value_is_known_of_each_family():
    """Power, current and voltage; operations and passwords. The BOP link changes neither."""
    of_mm4 = (10, 11, 12, 40, 340, 952, 970, 971, 1900, 1910, 1960, 2111, 3900)
    usual = [(206, 0x3F40, 5), (207, 0, 7), (208, 0, 7)]
    for family, ratings, never in (
        (families.MM440, usual, of_mm4),
        (on_bop(families.MM440), usual, of_mm4),
        (families.MM3, [(111, 0, 75), (112, 0, 7)], (944, 971)),
    ):
        panel, taken = Panel(), []
        panel.family = family
        steps = Steps(panel)
        assert steps.never == never
        steps.drive = drive = AskedDrive()
        reads = steps.read_ratings(lambda *told: taken.append(told))
        values = {111: (pkw.WORD, 75), 206: (pkw.DOUBLE, 5)}
        while not is_over(reads):
            for job in drive.asked:
                if job.state == pkw.PENDING:  # the high word of a single one is no matter
                    job.width, job.low = values.get(job.number, (pkw.WORD, 7))
                    job.high, job.state = 0x3F40, pkw.DONE
        assert taken == ratings, family


def test_a_work_ends_with_what_went_wrong():
    for error, outcome in (
        (None, (words.ALL_EQUAL,)), (OSError(28), (words.FLASH_FULL,)),
        (MemoryError(), (texts.NO_MEMORY,)), (ValueError(), (texts.NO_MEMORY,)),
        (ValueError("no text of ours"), (texts.NO_MEMORY,)),
        (ValueError(words.OTHER_FAMILY, b"MM3"), (words.OTHER_FAMILY, b"MM3")),
    ):  # fmt: skip
        for searches in (False, True):
            panel = Panel()
            steps = Steps(panel, 2, error)
            assert stepped(panel, steps, 0) is None and steps.did == 1
            if searches:
                steps.search()
            assert stepped(panel, steps, 10, 20) == outcome and steps.did == 2, error
            assert stepped(panel, steps, 30) == outcome and panel.resumed == 0
    panel = Panel()
    steps = Steps(panel)
    stepped(panel, steps, 0)
    panel.contact = False
    assert stepped(panel, steps, 10) == (texts.NO_CONTACT,)
    panel = Panel()
    panel.active = True
    assert stepped(panel, Steps(panel), 10) == (texts.STOP_FIRST,)
    # What was to be written into the flash is not written any more, and the bus goes on.
    panel = Panel()
    steps = Steps(panel)
    panel.errand = len
    steps.end(words.NOTHING_WRITTEN)
    assert (panel.errand, panel.resumed) == (None, 1)


def test_what_goes_wrong_ahead_of_a_step_ends_the_work_as_well():
    for error, outcome in (
        (OSError(28), words.FLASH_FULL), (MemoryError(), texts.NO_MEMORY),
        (ValueError(words.DAMAGED), words.DAMAGED),
    ):  # fmt: skip

        class Ahead(Steps):
            def look_ahead(self):
                raise error

        panel = Panel()
        steps = Ahead(panel)
        stepped(panel, steps, 0)
        steps.search()
        assert steps.outcome == (outcome,) and steps.did == 1


def test_a_work_that_comes_no_further_for_15_seconds_has_no_answer():
    panel = Panel()
    steps = Steps(panel)
    start_ms = 0xF000  # the clock begins anew meanwhile
    assert stepped(panel, steps, start_ms, start_ms + 15_000) is None
    steps.done = 1
    assert stepped(panel, steps, start_ms + 15_001, start_ms + 30_001) is None
    steps.asks = True  # nobody hurries whoever is asked
    assert stepped(panel, steps, start_ms + 30_002, start_ms + 50_000) is None
    steps.asks = False
    assert stepped(panel, steps, start_ms + 65_000) is None
    assert stepped(panel, steps, start_ms + 65_001) == (NO_ANSWER,)


def test_how_far_a_work_is_and_how_long_it_still_takes():
    panel = Panel()
    steps = Steps(panel)
    stepped(panel, steps, 0xFF00)
    assert (steps.percent(), steps.left_s, steps.asks) == (0, None, False)
    steps.total = 200
    for done, after_ms, percent, left_s in (
        (20, 3_000, 10, 27), (21, 3_000, 10, 25), (100, 10_000, 50, 10), (199, 20_000, 99, 0),
        (200, 20_000, 100, 0), (300, 21_000, 100, 0),
    ):  # fmt: skip
        steps.done = done
        stepped(panel, steps, 0xFF00 + after_ms)
        assert (steps.percent(), steps.left_s) == (percent, left_s), done
    steps.done = 10  # another round
    stepped(panel, steps, 0xFF00 + 22_000, 0xFF00 + 24_000)
    assert steps.left_s == 38


def test_a_step_of_the_loop_has_as_many_of_a_work_as_fit_half_a_millisecond():
    for step_us, did in ((0, 6), (99, 6), (100, 5), (250, 2), (500, 1), (2_000, 1)):
        panel = Panel()
        steps = Steps(panel)
        steps.search()
        assert steps.did == 0  # no step has told the time so far
        stepped(panel, steps, 100)
        panel.step_us = step_us
        panel.now_us = panel.mask - 150
        steps.search()
        assert steps.did == 1 + did, step_us
    panel = Panel()
    steps = Steps(panel)
    stepped(panel, steps, 0)
    steps.ahead = 2  # that comes first
    steps.search()
    assert steps.did == 1 + 4 and steps.ahead == 0


def test_flash_is_written_when_it_may_be_and_tells_what_it_could_not():
    for error, outcome in ((None, (words.ALL_EQUAL,)), (OSError(28), (words.FLASH_FULL,))):
        panel, written = Panel(), []

        def write(what):
            written.append(what)
            if error is not None:
                raise error

        class Writes(Steps):
            def work(self):
                yield from self.write_flash(write, 5)
                self.end(words.ALL_EQUAL)

        steps = Writes(panel)
        assert stepped(panel, steps, 0, 10) is None and written == []
        errand, panel.errand = panel.errand, None
        errand()
        assert written == [5]
        assert stepped(panel, steps, 20) == outcome and panel.resumed == 0


def test_a_reading_that_says_nothing_is_repeated_three_times():
    steps, job = Steps(Panel()), pkw.read(5)
    for state, repeated in (
        (pkw.TIMED_OUT, True), (pkw.TIMED_OUT, True), (pkw.UNANSWERED, True),
        (pkw.TIMED_OUT, False), (pkw.TIMED_OUT, True), (pkw.DONE, False), (pkw.TIMED_OUT, True),
        (pkw.TIMED_OUT, True), (pkw.REFUSED, False), (pkw.TIMED_OUT, True),
        (pkw.TIMED_OUT, True), (pkw.TIMED_OUT, True), (pkw.TIMED_OUT, False),
    ):  # fmt: skip
        job.state = state
        assert steps.is_to_be_repeated(job) == repeated


# --- a set and a drive that answers at once ------------------------------------------------------


class Answers(Panel):
    """A panel and its drive: values by number and index, each (width, high, low).

    settings: `marked` is what they were told of the half-written set.
    """

    dirty = False
    address = 2
    scaled = 0  # how often what the drive means was to be read anew

    def __init__(self, values, text, family=families.MM440, **half_written):
        Panel.__init__(self)
        self.family, self.values = family, values
        self.settings = self.channel = self
        self.store = store_with(one=text)
        self.half_written = half_written
        self.marked, self.wrote, self.reads = [], [], []
        self.errors = {}  # by number: with which a reading is refused; None: it is not answered
        self.bad = {}  # by number: with which a write is refused, as often as it is listed here

    def is_full(self):
        return False

    def recheck(self):
        self.scaled += 1

    def note_set(self, address, check=None):
        assert address == self.address
        self.marked.append(check)

    def ask(self, job):
        place = job.number, job.index
        job.state = pkw.DONE
        if not job.writes():
            self.reads.append(place)
            if job.number in self.errors and self.errors[job.number] is None:
                job.state = pkw.TIMED_OUT
            elif job.number in self.errors or place not in self.values:
                job.refuse(self.errors.get(job.number, pkw.NO_PARAMETER))
            else:
                job.width, job.high, job.low = self.values[place]
            return
        self.wrote.append((job.task,) + place + (job.low,))
        if self.bad.get(job.number):
            job.refuse(self.bad[job.number].pop(0))
            return
        self.values[place] = (pkw.WORD, 0, job.low)


def drive_of(*places, **more):
    """Its values are 1, and the set says 2 of each of these; of the others likewise 1."""
    values = {(number, 0): (pkw.WORD, 0, 1) for number in (3, 1120, 1121, 1200)}
    values.update({(number, 0): (pkw.WORD, 0, 1) for number in places})
    rows = [place + (b"U16", b"%04X" % (1 + (place[0] in places))) for place in sorted(values)]
    text = made(rows, address=2)
    for number in (206, 207, 208):
        more.setdefault("errors", {})[number] = pkw.NO_PARAMETER
    drive = Answers(values, text, more.pop("family", families.MM440), **more.pop("half", {}))
    for name in more:
        setattr(drive, name, more[name])
    drive.check = text.split(b" ")[-1].strip().decode()
    return drive


def ended(drive, eeprom=False, answers=(), most=2_000):
    """The work that writes the set, at its end or where nobody answers it any more."""
    one, answers, drive.phases = writing.Write(drive, drive, "one.set", eeprom), list(answers), []
    for now_ms in range(most):
        if one.phase not in drive.phases[-1:]:
            drive.phases.append(one.phase)
        if one.outcome is not None or one.asks and not answers:
            break
        if one.asks:
            one.answer = answers.pop(0)
        one.step(now_ms)
    return one


RAM, EEPROM = pkw.WRITE_WORD, pkw.WRITE_WORD_EEPROM


def test_a_set_that_is_equal_ends_its_own_mark_and_no_other():
    for eeprom in (None, False, True):
        drive = drive_of()
        assert ended(drive, eeprom).outcome == (words.ALL_EQUAL,)
        assert drive.marked == drive.wrote == [] and drive.scaled == 0
        for check, marked in ((drive.check, [None]), ("00000000", [])):
            drive.half_written = {"2": check}
            assert ended(drive, eeprom).outcome == (words.ALL_EQUAL,) and drive.marked == marked
            drive.marked = []


def test_what_differs_is_counted_and_the_first_twenty_are_listed():
    numbers = tuple(range(1201, 1222))
    drive = drive_of(700, *numbers)
    work = ended(drive, None)
    assert work.outcome == (words.DIFFER, 22) and (work.differs, work.cutting) == (22, 1)
    assert [row[0] for row in work.listed] == [700] + list(numbers[:19])
    assert work.listed[0] == (700, 0, b"U16", 0, 2, 0, 1) and work.cutters == work.listed[:1]
    assert drive.wrote == [] and (work.done, work.total) == (26, 26)


def test_a_value_that_the_drive_lacks_or_has_in_another_width_differs():
    drive = drive_of()
    drive.errors[1120] = pkw.NO_PARAMETER
    drive.values[1121, 0] = (pkw.DOUBLE, 0, 1)
    work = ended(drive, None)
    assert work.outcome == (words.DIFFER, 2)
    assert [row[-2:] for row in work.listed] == [(None, None), (0, 1)]


def test_a_reading_without_an_answer_ends_it_after_four_and_a_hidden_value_at_once():
    for error, asked, outcome in ((None, 4, NO_ANSWER), (204, 1, texts.ACCESS_TOO_LOW)):
        drive = drive_of()
        drive.errors[1120] = error
        assert ended(drive, None).outcome == (outcome,)
        assert drive.reads.count((1120, 0)) == asked


def test_only_what_differs_is_written_once_somebody_has_agreed():
    for eeprom, task in ((False, RAM), (True, EEPROM)):
        drive = drive_of(1120, 1200)
        work = ended(drive, eeprom, [False])
        assert work.outcome == (words.NOTHING_WRITTEN,) and drive.wrote == drive.marked == []
        drive.dirty = True  # until the mark is in the flash nothing is written
        work = ended(drive, eeprom, [True])
        assert work.outcome is None and drive.wrote == [] and drive.marked == [drive.check]
        drive = drive_of(1120, 1200)
        work = ended(drive, eeprom, [True])
        assert work.outcome == (words.WRITTEN_EQUAL,)
        assert drive.wrote == [  # it is opened for that
            (RAM, 3, 0, 3), (task, 1120, 0, 2), (task, 1200, 0, 2), (RAM, 3, 0, 1),
        ]  # fmt: skip
        assert drive.marked == [drive.check, None] and drive.scaled == 1
        assert (work.done, work.total) == (6, 6)
        assert drive.phases == [
            writing.CHECKS, writing.COMPARES, writing.ASKS, writing.WRITES, writing.VERIFIES
        ]  # fmt: skip


def test_an_access_level_that_is_high_enough_is_left_alone():
    for level, opens in ((1, True), (2, True), (3, False), (4, False)):
        drive = drive_of(1120)
        text = drive.store.open("one.set").read().replace(b"P0003 0 U16 0001\n", b"")
        text = text[: text.index(b"end")]
        drive.store = store_with(one=sealed(text, 3))
        drive.values[3, 0] = (pkw.WORD, 0, level)
        work = ended(drive, False, [True])
        assert work.outcome == (words.WRITTEN_EQUAL,) and work.opens == opens
        levels = [row[1:] for row in drive.wrote if row[1] == 3]
        assert levels == ([(3, 0, 3), (3, 0, level)] if opens else []), level


def test_the_access_level_of_a_set_is_written_last():
    drive = drive_of(3, 1120, 700)
    work = ended(drive, True, [True, True])
    assert work.outcome == (words.WRITTEN_EQUAL,)
    assert drive.wrote == [
        (RAM, 3, 0, 3), (EEPROM, 1120, 0, 2), (EEPROM, 700, 0, 2), (EEPROM, 3, 0, 2)
    ]  # fmt: skip
    drive = drive_of(3, 1120)  # which asks, too: nobody has agreed to it
    work = ended(drive, True, [True, False])
    assert [row[1:] for row in drive.wrote] == [(3, 0, 3), (1120, 0, 2), (3, 0, 1)]
    assert work.outcome == (words.WRITTEN_EQUAL,)


def test_p3_of_a_micromaster_3_is_a_value_like_others_and_p9_its_access_level():
    text = made(
        [(3, 0, b"U16", b"0002"), (9, 0, b"U16", b"0002")], b"mm3", 2, ratings=[(111, b"00000001")]
    )
    values = {(number, 0): (pkw.WORD, 0, 1) for number in (3, 9, 111)}
    for level in (1, 2):  # the set says 2
        drive = Answers(dict(values), text, families.MM3)
        drive.values[9, 0] = (pkw.WORD, 0, level)
        work = ended(drive, True, [True, True])
        assert work.outcome == (words.WRITTEN_EQUAL,), level
        assert [row[1:] for row in drive.wrote] == [(9, 0, 3), (3, 0, 2), (9, 0, 2)]
        assert {row[0] for row in drive.wrote} == {RAM}  # it has no other task


def test_what_cuts_the_bus_off_is_written_last_and_asked_about_once():
    drive = drive_of(700, 1120)
    work = ended(drive, False, [True])
    assert work.phase == writing.ASKS_CUT and work.outcome is None
    assert [row[1] for row in drive.wrote] == [3, 1120]
    drive = drive_of(700, 1120)
    assert ended(drive, False, [True, True]).outcome == (words.WRITTEN_EQUAL,)
    assert [row[1] for row in drive.wrote] == [3, 1120, 700, 3]
    assert drive.phases[-4:-1] == [writing.WRITES, writing.ASKS_CUT, writing.WRITES]
    drive = drive_of(700, 1120)
    work = ended(drive, False, [True, False])
    assert work.outcome == (words.WRITTEN_EQUAL,) and drive.values[700, 0][-1] == 1
    assert [row[1] for row in drive.wrote] == [3, 1120, 3]
    drive = drive_of(700)  # nothing else differs
    assert ended(drive, False, [True, True]).outcome == (words.WRITTEN_EQUAL,)
    assert [row[1] for row in drive.wrote] == [3, 700, 3]


def test_another_drive_takes_its_reference_of_what_asks_and_keeps_the_rest():
    """P2000; not the access level, nor what the bus and the sources are."""
    for address, takes, level in ((2, [1120, 700, 2000, 2009], 2), (3, [1120, 2000], 1)):
        drive = drive_of(3, 700, 1120, 2000, 2009)
        drive.address = address
        assert ended(drive, False, [True, True]).outcome == (words.WRITTEN_EQUAL,)
        assert [row[1] for row in drive.wrote] == [3] + takes + [3], address
        assert drive.wrote[-1] == (RAM, 3, 0, level)


def test_what_still_differs_is_written_once_more_and_then_counted():
    for refusals, times, outcome in (
        ([pkw.BEYOND_LIMITS], 2, (words.WRITTEN_EQUAL,)),
        ([pkw.BEYOND_LIMITS] * 9, 2, (words.STILL_DIFFER, 1)),
    ):
        drive = drive_of(1120, 1200)
        drive.bad = {1120: list(refusals)}
        work = ended(drive, False, [True])
        assert work.outcome == outcome
        assert [row[1] for row in drive.wrote].count(1120) == times
        assert [row[1] for row in drive.wrote].count(1200) == 1
        assert drive.marked == [drive.check] + [None] * (outcome[0] == words.WRITTEN_EQUAL)
        assert drive.scaled == 1


def test_what_wants_commissioning_is_written_in_it():
    """Whatever else is refused before or after it; error 17 alone says so."""
    for refused, commissioned in (
        ({1120: [17]}, True), ({1120: [17], 1200: [2]}, True), ({1120: [2], 1200: [17]}, True),
        ({1120: [2]}, False), ({1120: [18]}, False),
    ):  # fmt: skip
        drive = drive_of(1120, 1121, 1200)
        drive.values[10, 0] = (pkw.WORD, 0, 0)
        drive.bad = refused
        assert ended(drive, False, [True]).outcome == (words.WRITTEN_EQUAL,)
        modes = [row for row in drive.wrote if row[1] == 10]
        assert modes == ([(RAM, 10, 0, 1), (RAM, 10, 0, 0)] if commissioned else []), refused
        if commissioned:
            first, last = [place for place, row in enumerate(drive.wrote) if row[1] == 10]
            again = [row[1] for row in drive.wrote[first + 1 : last]]
            assert again == [number for number in (1120, 1200) if number in refused]


def test_a_drive_that_is_not_opened_or_not_commissioned_says_why():
    for number, place in ((3, 0), (10, 2)):
        drive = drive_of(1120)
        drive.bad = {number: [1], 1120: [17]}
        work = ended(drive, False, [True])
        assert work.outcome == (b"READ ONLY",) and drive.marked == [drive.check]
        assert len(drive.wrote) == place + 1


def of_mm3(**told):
    """A MICROMASTER 3 that has these parameters, P5=(width, high, low), and no others."""
    values = {(int(name[1:]), 0): told[name] for name in told}
    return Answers(values, b"", families.MM3)


def saved(drive, name=b"PUMP"):
    """The work that saves it, at its end; drive.errands counts what was written into the flash."""
    one, drive.errands = saving.Save(drive, drive, name), 0
    for now_ms in range(5_000):
        if one.outcome is not None:
            return one
        one.step(now_ms)
        one.search()
        if drive.errand is not None:
            errand, drive.errand = drive.errand, None
            errand()
            drive.errands += 1
    raise AssertionError(one.done)


def file_of(drive, name="1.set"):
    return [row[1:] for row in set_file.rows(drive.store, name) if row]


def test_what_a_drive_tells_is_saved_as_wide_as_it_tells_it():
    """P5 is a word by the catalogue, as all of them are. What it lacks is left out."""
    drive = of_mm3(
        P5=(pkw.WORD, 0, 7), P6=(pkw.DOUBLE, 1, 2), P111=(pkw.WORD, 9, 75),
        P112=(pkw.DOUBLE, 3, 4), P971=(pkw.WORD, 0, 1), P944=(pkw.WORD, 0, 1),
    )  # fmt: skip
    work = saved(drive)
    rows = file_of(drive)
    assert rows[:2] == [(5, 0, b"U16", 0, 7), (6, 0, b"U32", 1, 2)], rows
    assert not [row for row in rows if row[0] in work.never] and work.untold == 0
    assert work.outcome == (words.SAVED, len(rows)) and work.done == work.total
    head = set_file.read_head(drive.store, "1.set")
    assert (head.family, head.address, head.name) == ("mm3", 2, b"PUMP")
    assert head.ratings == {111: (0, 75), 112: (3, 4)}
    for number in work.never:
        assert (number, 0) not in drive.reads
    assert drive.errands == 2  # it begins, and the rest has room in one piece


def test_a_file_is_written_in_pieces_of_half_a_kilobyte():
    told = {"P%d" % number: (pkw.WORD, 0, number) for number in range(1, 60)}
    drive = of_mm3(**told)
    work = saved(drive)
    data = drive.store.open("1.set").read()
    assert work.outcome[0] == words.SAVED and len(data) > 512
    assert drive.errands == 2 + len(data) // 520, (drive.errands, len(data))


def test_what_is_not_told_is_counted_unless_the_drive_lacks_or_hides_it():
    for error, untold, outcome in (
        (pkw.NO_PARAMETER, 0, (words.SAVED, 1)), (pkw.NO_INDEX, 0, (words.SAVED, 1)),
        (4, 0, (words.SAVED, 1)), (5, 1, (words.SAVED_UNTOLD, 1)), (1, 1, (words.SAVED_UNTOLD, 1)),
        (None, 1, (words.SAVED_UNTOLD, 1)), (204, 0, (texts.ACCESS_TOO_LOW,)),
        (102, 0, (b"REPLY TOO LONG",)),
    ):  # fmt: skip
        drive = of_mm3(P5=(pkw.WORD, 0, 7))
        drive.errors = {6: error}
        work = saved(drive)
        assert (work.untold, work.outcome) == (untold, outcome), error
        names = drive.store.names(set_file.ENDING)
        assert "1.set" in names if len(outcome) == 2 else "1.set" not in names
        assert drive.reads.count((6, 0)) == (4 if error is None else 1)
