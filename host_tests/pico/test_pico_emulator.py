# SPDX-License-Identifier: MIT
"""The emulated Pico itself, with plain MicroPython on it, where a wrong model would make us
believe something false: how long things take, what a reset leaves, what a power cut leaves."""

from boards.sim.clock import Event
from pico_bench import running
from tools.emulator.chip import EmulatorError
from tools.emulator.flash_image import FlashImage
from tools.emulator.world import PicoWorld

INTERPRETERS = "pico"

BAUD = 19200
CHARACTER_US = 11_000_000 / BAUD
BIT_US = 1_000_000 / BAUD

SET_UP = """
import time, machine, rp2
from machine import UART, Pin, Timer
driver = Pin(6, Pin.OUT, value=0)
uart = UART(1, 19200, bits=8, parity=0, stop=1, tx=Pin(4), rx=Pin(5), rxbuf=256)
flash = rp2.Flash()
"""

# A function in RAM that reads a word of each of so many lines of the flash; how long that takes.
LOOKS = """
import time, rp2
@micropython.viper
def look(lines: int) -> int:
    flash = ptr32(0x10010000)
    line = found = 0
    while line < lines:
        found ^= flash[2 * line]
        line += 1
    return found
def took_us(lines):
    began = time.ticks_us()
    look(lines)
    return time.ticks_diff(time.ticks_us(), began)
flash = rp2.Flash()
took_us(1)
"""
WAY_LINES = 1024  # of one of its two ways; the other is left to the interpreter's own code
MISS_US = 60 / 125


class Talker:
    """A station that only talks."""

    name = "talker"

    def __init__(self, world, baud=None):
        self.world = world
        world.wire.attach(self, baud)

    def hear(self, burst):
        pass

    def say(self, data):
        self.world.wire.talk(self, data, len(data))


# What is exact is measured by Python as fast as it may be; only tests of the cache have one.
UNCACHED, CACHED = {"cache_miss_cycles": 0}, {"cache_miss_cycles": 60}


def stock(code=SET_UP, model=None, **how):
    """A Pico with plain MicroPython at its prompt that has done `code`."""
    wanted = dict(UNCACHED)
    wanted.update(model or {})
    world = PicoWorld("stock", (), model=wanted, **how)
    world.repl.open()
    does(world, code)
    return world


def does(world, code, ms=5000):
    """What `code` prints on the chip."""
    printed, error = world.repl.execute(code, ms)
    assert not error, error
    return printed.strip()


def number(world, code):
    return int(does(world, code))


def close_to(measured, expected, tolerance):
    assert abs(measured - expected) <= tolerance, (measured, expected)


def test_characters_leave_with_the_timing_of_the_baud_rate():
    world = stock()
    took_us = number(
        world,
        "driver(1)\nt = time.ticks_us()\nuart.write(bytes(range(16)))\n"
        "while not uart.txdone(): pass\nprint(time.ticks_diff(time.ticks_us(), t))\ndriver(0)",
    )
    assert 16 * CHARACTER_US < took_us < 16 * CHARACTER_US + 300
    assert [text for _, _, text in world.wire.log.last(9)] == [bytes(range(16))]
    assert 0 <= world.figures.release_ns[0] < 300_000  # Python switched it
    assert not world.station.complaints  # parity and stop bits were right


def test_the_end_of_a_burst_is_reported_32_bit_times_after_its_last_character():
    world = stock()
    does(
        world,
        "def idle(uart):\n    driver(1)\n"
        "uart.irq(handler=idle, trigger=UART.IRQ_RXIDLE, hard=True)\n",
    )
    Talker(world).say(b"\x02\x00\x01\x03\xff")
    world.run(20)
    at_ns, on = world.figures.driver[-1]
    assert on
    close_to((at_ns - world.figures.heard_ns) / 1000, 32 * BIT_US, 30)
    assert does(world, "print(uart.read())") == repr(b"\x02\x00\x01\x03\xff")


def test_who_looks_at_the_receiver_gets_no_report():
    world = stock()
    does(
        world,
        "came = []\n"
        "def idle(uart):\n    came.append(1)\n"
        "uart.irq(handler=idle, trigger=UART.IRQ_RXIDLE, hard=False)\n",
    )
    world.repl.begin("for _ in range(5000): uart.any()")
    Talker(world).say(b"12345")
    world.run(100)
    world.repl.wait_for(b"\x04>")
    assert does(world, "print(came, uart.any())") == "[] 5"


def test_the_receiver_is_deaf_while_the_driver_is_on():
    world = stock()
    does(world, "driver(1)")
    talker = Talker(world)
    talker.say(b"ABC")
    world.run(10)
    does(world, "driver(0)")
    talker.say(b"DEF")
    world.run(10)
    assert does(world, "print(uart.read())") == repr(b"DEF")


def test_erasing_a_sector_and_writing_a_page_take_their_time():
    world = stock()
    took = does(
        world,
        "a = time.ticks_us()\nflash.ioctl(6, 300)\n"
        "b = time.ticks_us()\nflash.writeblocks(300, bytes(256), 0)\n"
        "c = time.ticks_us()\nprint(time.ticks_diff(b, a), time.ticks_diff(c, b))",
    )
    erased_us, written_us = map(int, took.split())
    close_to(erased_us, 45_000, 1_000)
    close_to(written_us, 700, 300)
    assert [what for _, what, _ in world.flash_log] == [1, 2]
    assert does(world, "b = bytearray(256)\nflash.readblocks(300, b)\nprint(b == bytes(256))") == (
        "True"
    )


def test_nothing_is_received_beyond_the_32_characters_of_the_fifo_while_flash_is_erased():
    world = stock()
    world.repl.begin("flash.ioctl(6, 300)")
    world.run_until(lambda: world.flash_log, 100)
    Talker(world).say(bytes(range(60)))  # 34 ms
    world.run(80)
    assert does(world, "print(uart.read())") == repr(bytes(range(32)))


def test_what_fits_the_flash_cache_is_read_without_waiting_the_second_time():
    world = stock(LOOKS, model=CACHED)
    first_us, second_us = map(int, does(world, "print(took_us(1024), took_us(1024))").split())
    close_to(first_us - second_us, WAY_LINES * MISS_US, 0.1 * WAY_LINES * MISS_US)


def test_what_is_larger_than_the_flash_cache_is_waited_for_each_time():
    world = stock(LOOKS, model=CACHED)
    first_us, second_us = map(int, does(world, "print(took_us(4096), took_us(4096))").split())
    assert min(first_us, second_us) > 4 * WAY_LINES * MISS_US


def test_writing_the_flash_empties_its_cache():
    world = stock(LOOKS, model=CACHED)
    took = does(
        world,
        "took_us(1024)\nbefore = took_us(1024)\nflash.writeblocks(300, bytes(256), 0)\n"
        "print(before, took_us(1024))",
    )
    before_us, after_us = map(int, took.split())
    close_to(after_us - before_us, WAY_LINES * MISS_US, 0.1 * WAY_LINES * MISS_US)


def test_without_a_cache_the_flash_is_as_fast_as_ram():
    world = stock(LOOKS)
    first_us, second_us = map(int, does(world, "print(took_us(1024), took_us(1024))").split())
    close_to(first_us, second_us, 5)


def test_where_nobody_says_otherwise_there_is_a_cache():
    """So the tests of the panel, line, failures and settings have one."""
    world = PicoWorld("stock", ())
    world.repl.open()
    does(world, LOOKS)
    first_us, second_us = map(int, does(world, "print(took_us(1024), took_us(1024))").split())
    close_to(first_us - second_us, WAY_LINES * MISS_US, 0.1 * WAY_LINES * MISS_US)


def test_a_flash_as_slow_as_its_data_sheet_allows():
    world = stock(model={"flash_times": "maximum"})
    took_us = number(
        world,
        "t = time.ticks_us()\nflash.ioctl(6, 300)\nprint(time.ticks_diff(time.ticks_us(), t))",
    )
    close_to(took_us, 400_000, 1_000)
    assert world.flash_log[-1][1:] == (1, 400_000)


def test_a_chip_that_nobody_can_model_is_refused():
    for model in ({"receive_timeout": "twice"}, {"cache_miss_cycles": -1}, {"cash": 1}):
        try:
            PicoWorld("stock", (), model=model)
        except EmulatorError as error:
            assert str(error).startswith("no chip: there is no model with"), error
        else:
            raise AssertionError(model)


FULL = """
import machine, time
from machine import UART, Pin
driver = Pin(6, Pin.OUT, value=0)
led = Pin(25, Pin.OUT)
uart = UART(1, 19200, bits=8, parity=0, stop=1, tx=Pin(4), rx=Pin(5), rxbuf=32)
machine.WDT(timeout=1000)
"""


def test_a_receive_time_out_that_comes_once_leaves_a_full_receiver_alone():
    """64 characters fill the ring of 32 and the FIFO of 32; nothing can be drained then."""
    world = stock(FULL + "machine.mem32[0x4005B000] = 1 << 30", model={"receive_timeout": "once"})
    Talker(world).say(bytes(70))
    world.run(500)
    assert does(world, "print(uart.any())") == "32"


def test_a_receive_time_out_that_comes_again_never_leaves_a_full_receiver():
    """The interrupt is there again whenever its handler returns: the chip does nothing else."""
    world = stock(FULL, model={"receive_timeout": "again"})
    world.repl.begin("while True:\n    led.toggle()\n    time.sleep_ms(1)")
    world.run(100)
    Talker(world).say(bytes(70))
    world.run(1_500)
    assert world.reset_causes == ["watchdog"]
    bitten_us = world.restarts[0][0]
    last_us = max(at_us for at_us, _ in world.led if at_us < bitten_us)
    close_to(last_us, world.figures.heard_ns / 1000 + 32 * BIT_US, 1_100)


def test_power_that_is_cut_while_a_sector_is_being_erased_leaves_garbage_in_it():
    world = stock()
    does(world, "for page in range(16): flash.writeblocks(300, b'U' * 256, 256 * page)")
    world.repl.begin("flash.ioctl(6, 300)")
    world.run(20)
    assert world.flash_log[-1][1] == 1
    world.cut_power()
    world.repl.open()
    assert world.reset_causes == ["power"]
    found = "import rp2\nb = bytearray(4096)\nrp2.Flash().readblocks(300, b)\nprint(%s)"
    assert does(world, found % "b != b'U' * 4096 and b != b'\\xff' * 4096") == "True"


def test_the_watchdog_bites_when_it_should_and_leaves_its_cause():
    world = stock()
    world.repl.begin("w = machine.WDT(timeout=1000)\ndriver(1)\nwhile True: pass")
    world.run(1500)
    (bitten_us, cause), (fed_ns, _) = world.restarts[0], world.figures.driver[0]
    assert cause == "watchdog" and len(world.restarts) == 1
    close_to(bitten_us - fed_ns / 1000, 1_000_000, 5_000)
    world.repl.open()
    wanted = "import machine\nprint(machine.reset_cause() == machine.WDT_RESET, %s)"
    started = "hex(machine.mem32[0x4005801C])"
    assert does(world, wanted % started) == "True 0x6ab73121"
    world.repl.begin("machine.reset()")
    world.run(300)
    assert world.reset_causes == ["watchdog", "reset"]
    world.repl.open()
    assert does(world, wanted % started) == "True 0x0"  # the SDK's watchdog_reboot


def test_a_watchdog_whose_enable_bit_was_cleared_does_not_bite():
    world = stock()
    does(world, "w = machine.WDT(timeout=500)\nmachine.mem32[0x4005B000] = 1 << 30")
    world.run(2_000)
    assert not world.restarts


def test_a_power_on_is_no_watchdog():
    world = stock()
    assert does(world, "print(machine.reset_cause() == machine.PWRON_RESET)") == "True"


def test_a_timer_fires_when_it_should():
    world = stock()
    does(
        world,
        "timer = Timer()\ndriver(1)\n"
        "timer.init(mode=Timer.ONE_SHOT, period=10_000, tick_hz=1_000_000,"
        " callback=lambda timer: driver(0))\ntime.sleep_ms(20)",
    )
    (rose_ns, _), (fell_ns, _) = world.figures.driver
    close_to((fell_ns - rose_ns) / 1000, 10_000, 250)


# A state machine with the LED, in steps of 10 ms, and where it is when somebody looks.
STEPS = """
import machine, rp2, time
@rp2.asm_pio(set_init=rp2.PIO.OUT_LOW, out_shiftdir=rp2.PIO.SHIFT_RIGHT)
def steps():
    set(pins, 1)
    set(x, 2)[19]
    label("turn")
    out(y, 1)[19]
    jmp(x_dec, "turn")[19]
    set(pins, 0)
    label("end")
    jmp("end")
stepper = rp2.StateMachine(4, steps, freq=2_000, set_base=machine.Pin(25))
ADDRESS = 0x5030_00D4
first = machine.mem32[ADDRESS]
def look(ms):
    found = []
    stepper.active(0)
    stepper.restart()
    for prepare in ("set(y, 5)", "mov(osr, y)"):
        stepper.exec(prepare)
    stepper.active(1)
    began = time.ticks_us()
    while time.ticks_diff(time.ticks_us(), began) < ms * 1000:
        found.append((time.ticks_us() - began, machine.mem32[ADDRESS] - first))
    return found
def is_good(looked):  # the next instruction
    for us, place in looked:
        step, rest = divmod(us, 10_000)
        if 1_500 < rest < 9_500 and place != (2, 3, 2, 3, 2, 3, 4, 5, 5)[step]:
            return us, place
    return len(looked) > 100
def encoded(*instructions):  # to put them together takes the chip some milliseconds
    return [rp2.asm_pio_encode(one, 0) for one in instructions]
TELL_X, TELL_Y = encoded("mov(isr, x)", "push()"), encoded("mov(isr, y)", "push()")
def told(how):
    for instruction in how:
        stepper.exec(instruction)
    return stepper.get()
"""


def test_a_state_machine_is_where_it_should_be_whenever_somebody_looks():
    """What only the machine notices is executed before its time, and taken back."""
    world = stock(STEPS)
    for looks in ("look(90)", "look(0), time.sleep_ms(90)"):
        world.led.clear()
        does(world, looks)
        (on_us, on), (off_us, off) = world.led
        assert on and not off
        close_to(off_us - on_us, 70_500, 2)
    assert does(world, "print(is_good(look(90)))") == "True"
    for ms, x, y in ((2, 2, 5), (12, 2, 1), (22, 1, 1), (32, 1, 0), (42, 0, 0), (52, 0, 1)):
        found = does(world, "look(%d)\nprint(told(TELL_X), told(TELL_Y))" % ms)
        assert found == "%d %d" % (x, y), (ms, found)


def test_the_keys_are_wires_to_ground_and_stop_is_closed():
    world = stock()
    levels = "print([Pin(gpio, Pin.IN, Pin.PULL_UP)() for gpio in (13, 14)])"
    assert does(world, levels) == "[1, 0]"
    world.down("START")
    world.down("STOP")
    assert does(world, levels) == "[0, 1]"
    world.up("START")
    world.keypad.cut("STOP")
    assert does(world, levels) == "[1, 1]"


def test_a_byte_to_the_backpack_takes_nine_clocks():
    world = stock("import time\nfrom machine import I2C, Pin\n", display="backpack")
    does(world, "i2c = I2C(0, sda=Pin(0), scl=Pin(1), freq=100_000)")
    assert does(world, "print(i2c.scan())") == "[39]"
    taken = world.backpack.bytes_taken
    took_us = number(
        world,
        "t = time.ticks_us()\ni2c.writeto(0x27, bytes(20))\n"
        "print(time.ticks_diff(time.ticks_us(), t))",
    )
    close_to(took_us, 21 * 90, 150)
    assert world.backpack.bytes_taken - taken == 20


def test_files_put_on_the_flash_are_there_and_files_written_come_back():
    world = PicoWorld("stock", (), files={"lib/seven.py": b"VALUE = 7\n"})
    world.repl.open()
    assert does(world, "import seven\nprint(seven.VALUE)") == "7"
    does(world, "with open('told.txt', 'w') as file: file.write('hello')")
    assert world.read_file("told.txt") == b"hello"
    assert world.read_file("nothing.txt") is None
    assert world.settings()["baud"] == BAUD


def test_the_same_files_make_the_same_flash_whenever_it_is_made():
    def image():
        image = FlashImage()
        image.write("settings.json", b"{}")
        return image.blocks()

    first, again = image(), image()
    assert first == again and bytes(first).find(b"settings.json") > 0


def test_the_same_again_is_the_same_to_the_nanosecond():
    def run():
        world = stock()
        does(world, "driver(1)\nuart.write(b'12345')\ntime.sleep_ms(5)\ndriver(0)")
        return world.figures.driver

    assert run() == run()


def test_a_chip_that_stops_seldom_does_the_same_as_one_that_stops_at_each_character():
    """Somebody talks into telegrams and replies, replies are cut, and the power fails."""
    seldom, often = (disturbed(is_often) for is_often in (False, True))
    assert seldom == often


def test_a_chip_that_stops_seldom_hears_the_same_while_it_talks_into_what_others_say():
    seldom, often = (talks_into_others(is_often) for is_often in (False, True))
    assert seldom == often


def test_a_character_that_would_begin_when_its_talker_is_cut_is_not_heard():
    for is_often in (False, True):
        for ahead_us in (1_000, 1):  # before the others that come at that instant, and after them
            world = stock()
            stops(world, is_often)
            talker = Talker(world)
            talker.say(b"0123456789")
            end_us = world.clock.now_us + 5 * 11_000_000 // BAUD
            cut = Event(lambda talker=talker: talker.world.wire.silence(talker))
            at_us = end_us - ahead_us
            sets = Event(lambda w=world, cut=cut, at=end_us: w.clock.schedule(cut, at))
            world.clock.schedule(sets, at_us)
            world.run(20)
            assert does(world, "print(uart.read())") == "b'01234'", (is_often, ahead_us)


def test_characters_of_another_rate_are_garbage_with_framing_errors():
    world = stock(SET_UP + "machine.mem32[0x40038038] = 0\n")  # no interrupt empties the FIFO
    sent = b"\x02\x0a\x01"
    heard = {}
    for baud in (9600, BAUD, 38400):
        Talker(world, baud).say(sent)
        world.run(50)
        told = does(world, "for _ in range(3): print(machine.mem32[0x40038000])")
        heard[baud] = [int(character) for character in told.split()]
    assert heard[BAUD] == list(sent)
    for baud in (9600, 38400):
        for character, was in zip(heard[baud], sent):
            assert character & 0x100 and character & 0xFF != was, heard
    world.check()


def test_a_chip_that_changes_its_rate_talks_at_the_new_one():
    world = stock()
    heard = []

    class Listener(Talker):
        def hear(self, burst):
            heard.append((burst.baud, bytes(burst.data[: burst.count])))

    Listener(world)
    for baud in (9600, 38400):
        does(
            world,
            "uart.init(%d, bits=8, parity=0, stop=1)\n"
            "driver(1)\nuart.write(b'\\x02\\x0a')\nuart.flush()\ndriver(0)" % baud,
        )
        world.run(10)
    assert heard == [(9600, b"\x02\x0a"), (38400, b"\x02\x0a")]
    assert world.station.baud == 38400 and not world.station.complaints


def disturbed(is_often):
    """What a panel on a bad line did, as those on the line and on its board saw it."""
    world = running(baud=115200, addresses=(1, 2))
    stops(world, is_often)
    talker, drive = Talker(world), world.drives[1]
    again(world, 41_170, lambda: talker.say(b"\x02\x0e\x41"))
    again(world, 17_730, lambda: world.wire.silence(drive))
    world.run(150)
    world.press("UP")
    world.cut_power(world.clock.now_us + 1_234)
    world.run(300)
    figures = world.figures
    measured = [list(each) for each in (figures.lead_ns, figures.release_ns, figures.idle_ns)]
    log = world.wire.log
    assert log.count > 200 and len(world.complaints()) > 5
    return log.last(1000), measured, figures.driver, world.complaints(), drive.report()


TALKS = """
heard = b""
for turn in range(30):
    time.sleep_us(1000 + 137 * turn)
    driver(1)
    if turn % 3:
        uart.write(b"ab")
        while not uart.txdone(): pass
    driver(0)
    heard += uart.read() or b""
print(heard)
"""


def talks_into_others(is_often):
    """What came in at a chip that talks, or only enables its driver, whenever it likes."""
    world = stock()
    stops(world, is_often)
    talker = Talker(world)
    again(world, 23_000, lambda: talker.say(bytes(range(32))))
    heard = does(world, TALKS)
    assert len(heard) > 100
    return heard, world.wire.log.last(1000), world.complaints()


def stops(world, is_often):
    if is_often:
        world.station.goes_on_percent, world.station.tells_ahead = 0, False


def again(world, every_us, happens):
    """Now, and ever again."""

    def happen():
        world.clock.schedule(event, world.clock.now_us + every_us)
        happens()

    event = Event(happen)
    happen()
