# SPDX-License-Identifier: MIT
"""The operator's manual on the ESP32s: the board files of the tree, on the machine of their port.

Callbacks are soft here, up to 0.9 ms late and held up by collections of 12 ms.
"""

import main
import panel.panel
from boards.sim.ports.world import PortWorld
from panel_bench import OFF1, ON, starts, telegrams, wait_until, wait_until_known
from strict_screen import StrictScreen

INTERPRETERS = "unix32|unix64"  # CPython's imports need its own `sys`

panel.panel.Screen = StrictScreen

BOARDS = ("esp32s3", "esp32")
RATES = (9_600, 19_200, 38_400, 57_600, 115_200)
DEBOUNCE_MS = 20


def switched_on(board="esp32s3", **options):
    world = PortWorld(main.start, "boards/%s/board.py" % board, **options)
    world.run(1000)
    return world


def all_running(board, baud, seed=0, addresses=(1, 2, 3)):
    world = switched_on(board, baud=baud, seed=seed, addresses=addresses)
    for _ in addresses:
        wait_until_known(world)
        world.press("START")
        world.press("ADDRESS_UP")
        world.run(200)
    world.run(4000)
    for drive in world.drives.values():
        assert drive.state == "running", drive.report()
    return world


def all_stand(world):
    """Whether they do, after a while."""
    drives = world.drives.values()
    wait_until(world, lambda: not any(drive.hz() for drive in drives), 15_000)
    return not any(drive.hz() for drive in drives)


def rate_of(world):
    """Exchanges a second."""
    begun, begun_us = world.app.bus.progress, world.clock.now_us
    world.run(5000)
    return (world.app.bus.progress - begun) * 1_000_000 / (world.clock.now_us - begun_us)


def exchange_ms(baud):
    return (2 * 16 + 3 + 2) * 11_000 / baud + 2


def press_stop(world):
    """When OFF1 for the drive shown was on the wire after STOP went down, in ms."""
    address, since_us = world.selected(), world.clock.now_us
    world.down("STOP")
    world.run(400)
    world.up("STOP")
    sent = [at_us for at_us, stw in telegrams(world, since_us, address) if stw == OFF1]
    assert sent, world.lcd()
    return (sent[0] - since_us) / 1000


def test_three_drives_start_run_and_stop_at_every_rate():
    for board in BOARDS:
        for baud in RATES:
            world = all_running(board, baud)
            if baud == 19_200:
                assert rate_of(world) >= 40, (board, rate_of(world))
            for _ in world.drives:
                assert press_stop(world) <= DEBOUNCE_MS + 2 * exchange_ms(baud) + 15, (board, baud)
                world.press("ADDRESS_UP")
            assert all_stand(world), (board, baud)
            world.check()


def test_where_the_heap_lies_in_psram_collections_may_take_100_ms():
    """Nobody has measured how long they take there. STOP comes later by as much, and a tap that is
    no longer than a collection may be lost in it.
    """
    for ms, exchanges in ((60, 39), (100, 36)):
        world = all_running("esp32", 19_200)
        world.collection_us = ms * 1000
        assert rate_of(world) >= exchanges, (ms, rate_of(world))
        for _ in world.drives:
            assert press_stop(world) <= DEBOUNCE_MS + 2 * exchange_ms(19_200) + 15 + ms, ms
            world.press("ADDRESS_UP", 100 + ms)
        assert all_stand(world), ms
        world.check()


def test_keys_that_bounce_and_drives_that_are_slow():
    for seed in (3, 4):
        for board in BOARDS:
            world = all_running(board, 19_200, seed)
            assert press_stop(world) <= DEBOUNCE_MS + 2 * (exchange_ms(19_200) + 15) + 15, seed
            world.check()


def test_what_is_written_where_for_the_driver_enable():
    """UART_RS485_CONF_REG(1), bits RS485_EN and RS485RXBY_TX_EN; GPIO_FUNC16_OUT_SEL_CFG_REG,
    U1DTR_OUT_IDX (ESP-IDF, components/soc/esp32s3/include/soc)."""
    uart_1, rs485_conf = 0x6001_0000, 0x4C
    gpio, func0_out_sel = 0x6000_4000, 0x554
    wanted = [(uart_1 + rs485_conf, 0b10001), (gpio + func0_out_sel + 4 * 16, 17)]
    world = switched_on("esp32s3")
    assert world.port.mem32.written == wanted
    world.reset()  # and again with each life of the chip
    world.run(500)
    assert world.port.mem32.written == wanted
    world.board.make_link(9_600)  # and after each `init` of the UART, which clears the first
    assert world.port.mem32.written == 2 * wanted
    assert world.port.mem32.levels[wanted[0][0]] == wanted[0][1]
    assert switched_on("esp32").port.mem32.written == []


def test_without_these_registers_the_driver_stays_off():
    """So the one before this would notice."""
    world = switched_on("esp32s3")
    world.port.mem32.levels.clear()
    world.run(200)
    assert any("its driver disabled" in one for one in world.complaints())


def test_a_loop_that_hangs_in_python_stops_the_motor():
    for board in BOARDS:
        for baud in RATES:
            hangs(board, baud, 400_000, addresses=(1,))


def test_nor_do_several_run_on():
    # The last of three drives: at 9600 three exchanges take 140 ms.
    for board in BOARDS:
        for baud, within_us in ((9_600, 450_000), (19_200, 400_000), (115_200, 330_000)):
            hangs(board, baud, within_us, addresses=(1, 2, 3))


def hangs(board, baud, within_us, addresses):
    for phase_ms in (0, 130, 350):  # a collection may be near
        world = all_running(board, baud, addresses=addresses)
        world.run(phase_ms)
        since_us = world.clock.now_us
        world.hang(1_500)
        for address in world.drives:
            sent = telegrams(world, since_us, address)
            off = [at_us for at_us, stw in sent if stw == OFF1]
            assert off and off[0] - since_us <= within_us, (board, baud, address)
            assert not [at_us for at_us, stw in sent if stw == ON and at_us > off[0]]


def test_one_that_hangs_in_c_leaves_it_to_p2014_and_the_watchdog():
    for board in BOARDS:
        world = all_running(board, 19_200)
        since_us = world.clock.now_us
        world.freeze(8_000)
        assert world.resets == 1
        assert not [stw for _, stw in telegrams(world, since_us + 50_000) if stw == ON]
        world.run(3_000)
        assert not any(drive.hz() for drive in world.drives.values())
        assert "WATCHDOG" in world.board.reset_cause


def test_a_drive_that_would_run_on_does_not_start():
    for parameters in ({2014: 0}, {2014: 65_000}):
        world = switched_on(parameters=parameters, settings={"unsupervised": [1]})
        wait_until_known(world)
        world.press("START")
        world.run(2_500)
        assert world.lcd()[1] == "SET=FIX STOP=NO ", world.lcd()
        world.press("START")
        world.run(150)  # behind a backpack a picture takes its time
        assert world.reads("NO: SET P2014"), world.lcd()
        world.run(3_000)
        assert starts(world) == 0
        world.check()


def test_set_puts_it_right():
    world = switched_on(parameters={2014: 0})
    wait_until_known(world)
    world.press("START")
    world.run(2_500)
    world.press("SET")
    world.run(3_000)
    world.press("START")
    world.run(4_000)
    assert starts(world) == 1, world.lcd()


def test_ctrl_c_leaves_a_day_before_the_watchdog_bites():
    world = switched_on()
    assert world.watchdog_ms() == 2_000
    world.close()
    assert world.board.watchdog.stop()
    assert world.watchdog_ms() == 24 * 3_600_000
    world.board.watchdog.feed()
    assert world.watchdog_ms() == 2_000


def test_a_driver_that_a_timer_switches_is_refused_above_9600_baud():
    from boards.sim.ports.loading import load

    world = switched_on("esp32", baud=9_600)
    with open("boards/esp32/board.py") as source:
        text = source.read().replace("DRIVER_ENABLE = None", "DRIVER_ENABLE = 17")
    assert text.count("DRIVER_ENABLE = 17") == 1
    path = "build/board_with_driver.py"
    with open(path, "w") as file:
        file.write(text)
    board = load(path, world.port)
    try:
        board.make_link(19_200)
    except ValueError as refusal:
        assert "finds its direction by itself" in str(refusal)
    else:
        raise AssertionError("not refused")
    timed = PortWorld(main.start, path, baud=9_600, keys="matrix")
    timed.run(4_000)
    assert timed.lcd()[1].startswith("READY"), timed.lcd()
