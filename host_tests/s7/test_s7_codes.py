# SPDX-License-Identifier: MIT
"""Each status code of the S7-200's library, provoked: one function for every code that can occur.

A line on which one drive, node 3, answers what the test says, to the character.
"""

from boards.sim.clock import Clock
from line_bench import MASK, Line, of_words, words_of
from plc_bench import NEVER
from uss.families import MM4
from uss.layout import VARIABLE, Layout
from uss.s7 import (
    TYPES,
    USS_CTRL,
    USS_INIT,
    USS_RPM_D,
    USS_RPM_R,
    USS_RPM_W,
    USS_WPM_D,
    USS_WPM_R,
    USS_WPM_W,
    Port,
    codes,
)
from uss.s7.parameters import FLOAT_MAX

NODE = 3
READY, RUNNING = 0xFB31, 0xFB34


class Pump(MM4):
    """A drive that takes no parameters over the line."""

    layout = Layout(0, 2)


class Store(MM4):
    """A node of which only parameters are wanted."""

    layout = Layout(4, 0)


class Fan(MM4):
    layout = Layout(VARIABLE, 2)


class LineClock:
    """The time of a line, as a board's clock."""

    ticks_mask = MASK

    def __init__(self, line):
        self._line = line

    def ticks_us(self):
        return self._line.now & MASK

    def sleep_us(self, us):
        self._line.run(us)


class Plant:
    """A port with node 3. answer: what it sends; by default it is ready, and runs when told to.

    parameters: number -> (reply identifier, high word, low word); what is not in it is refused.
    """

    def __init__(self, answer=None, types=TYPES, active=1 << NODE):
        self.line = Line(answer or self.well)
        self.parameters = {}
        self.zsw = READY
        self.port = Port(self.open_bus, LineClock(self.line), types, polled=False)
        self.motor = USS_CTRL(self.port)
        self.inputs = {"DRIVE": NODE, "TYPE": 1, "SPEED_SP": 50.0}
        self.init = USS_INIT(self.port)
        self.init(EN=True, MODE=1, BAUD=19200, ACTIVE=active)
        assert self.init.DONE and self.init.ERROR == 0

    def open_bus(self, baud):
        return self.line.master

    def well(self, request):
        """The reply of a drive that works, as characters."""
        words = words_of(request)
        pkw = self.reply_pkw(words[:-2])
        if words[-2] & 1:
            self.zsw = RUNNING
        return of_words(pkw + [self.zsw, words[-1]], request[2])

    def reply_pkw(self, pkw):
        if not pkw or pkw[0] >> 12 == 0:
            return [0] * len(pkw)
        number = (pkw[0] & 0x7FF) + (2000 if pkw[1] & 0x8000 else 0)
        answer, high, low = self.parameters.get(number, (7, 0, 0))
        return [answer << 12 | pkw[0] & 0x7FF, pkw[1], high, low]

    def run(self, ms=300, *blocks):
        """Scans for so long; blocks: what is called in each besides the USS_CTRL."""
        until = self.line.now + ms * 1000
        while self.line.now < until:
            self.line.step()
            self.port.scan()
            self.motor(**self.inputs)
            for block in blocks:
                block()

    def until_done(self, block, ms=7_000, **inputs):
        self.run(300)
        block(XMT_REQ=False, **inputs)
        block(XMT_REQ=True, **inputs)
        until = self.line.now + ms * 1000
        while not block.DONE:
            assert self.line.now < until, "not done"
            self.run(5)
            block(XMT_REQ=True, **inputs)
        return block.ERROR


def spoilt(change):
    """An `answer` that is right, but for what `change` does to its characters."""

    def answer(request):
        reply = bytearray(of_words([0] * 4 + [READY, 0], request[2]))
        return change(reply)

    return answer


def error_with(change):
    """What USS_CTRL says of replies that `change` has spoilt."""
    plant = Plant(spoilt(change))
    plant.run()
    assert not plant.motor.RESP_R and plant.motor.STATUS == 0
    assert plant.motor.STATUS_WORD == codes.word(plant.motor.ERROR)
    return plant.motor.ERROR


# --- the codes ----------------------------------------------------------------------------------


def test_code_0_all_is_well():
    plant = Plant()
    plant.run()
    assert (plant.motor.ERROR, plant.motor.STATUS_WORD) == (0, 0)
    assert plant.motor.STATUS == READY


def test_code_1_the_drive_does_not_answer():
    assert error_with(lambda reply: None) == 1


def test_code_2_the_checksum_of_the_reply_is_wrong():
    def change(reply):
        reply[13] ^= 0x10
        return reply

    assert error_with(change) == 2


def test_code_4_a_second_block_commands_the_same_drive():
    plant = Plant()
    second = USS_CTRL(plant.port)
    plant.run(300, lambda: second(RUN=True, DRIVE=NODE))
    assert second.ERROR == 4 and second.RUN_VOID and plant.motor.ERROR == 0


def test_code_5_what_the_blocks_or_the_drive_do_not_have():
    plant = Plant()
    plant.inputs["TYPE"] = 2
    plant.run()
    assert plant.motor.ERROR == 5
    for value in (-32769, 65536, 1.5, None):
        plant = Plant()
        block = USS_WPM_W(plant.port)
        assert plant.until_done(block, DRIVE=NODE, PARAM=700, VALUE=value) == 5, value
        assert block.STATUS_WORD == 0x8181
    for value in (float("nan"), float("inf"), -float("inf")):
        plant = Plant()
        assert plant.until_done(USS_WPM_R(plant.port), DRIVE=NODE, PARAM=700, VALUE=value) == 5
    plant = Plant()
    assert plant.until_done(USS_WPM_D(plant.port), DRIVE=NODE, PARAM=700, VALUE=1 << 32) == 5


def test_code_5_eeprom_with_a_micromaster_3():
    plant = Plant()
    plant.inputs["TYPE"] = 0
    write = USS_WPM_W(plant.port)
    assert plant.until_done(write, DRIVE=NODE, PARAM=2, VALUE=10, EEPROM=True) == 5


def test_code_5_parameters_of_a_drive_whose_telegrams_have_none():
    plant = Plant(types=(Pump, Pump))
    read = USS_RPM_W(plant.port)
    assert plant.until_done(read, DRIVE=NODE, PARAM=700) == 5


def test_code_5_a_drive_whose_telegrams_have_no_control_word():
    plant = Plant(types=(Store, Store))
    plant.inputs["RUN"] = False
    plant.run()
    plant.inputs["RUN"] = True
    plant.run()
    assert plant.motor.ERROR == 5 and plant.motor.RUN_VOID


def test_code_6_an_address_beyond_31():
    for address in (-1, 32, 255):
        plant = Plant()
        plant.inputs["DRIVE"] = address
        plant.run()
        assert (plant.motor.ERROR, plant.motor.STATUS_WORD) == (6, 0x8185)
        assert plant.until_done(USS_RPM_W(plant.port), DRIVE=address, PARAM=700) == 6
    init = USS_INIT(plant.port)
    for active in (1 << 32, -1):
        init(EN=False)
        init(EN=True, MODE=1, BAUD=19200, ACTIVE=active)
        assert (init.DONE, init.ERROR) == (True, 6)


def test_code_7_the_port_is_not_set_up():
    port = Port(None, Clock())
    motor = USS_CTRL(port)
    motor(RUN=True, DRIVE=NODE)
    assert (motor.ERROR, motor.STATUS_WORD, motor.RUN_VOID) == (7, 0x818E, True)


def test_code_8_a_parameter_block_is_at_work():
    plant = Plant()
    plant.parameters[700] = (1, 0, 5)
    first, second = USS_RPM_W(plant.port), USS_WPM_W(plant.port)
    plant.run()
    first(XMT_REQ=True, DRIVE=NODE, PARAM=700)
    second(XMT_REQ=True, DRIVE=NODE, PARAM=700, VALUE=1)
    assert second.DONE and (second.ERROR, second.STATUS_WORD) == (8, 0x818A)
    init = USS_INIT(plant.port)
    init(EN=True, MODE=1, BAUD=19200, ACTIVE=1)
    assert init.ERROR == 8 and plant.port.drives[NODE] is not None
    plant.inputs["TYPE"] = 0
    plant.motor(**plant.inputs)
    assert plant.motor.ERROR == 8


def babble(plant):
    """Another master is heard, for a second."""
    for _ in range(20):
        plant.line.hear(plant.line.now, b"\x02\x06\x01")
        plant.run(50)


def test_code_8_another_master_is_on_the_line():
    plant = Plant()
    babble(plant)
    assert plant.line.requests == [] and plant.motor.ERROR == 8
    plant.run(500)
    assert plant.motor.ERROR == 0 and plant.motor.STATUS == READY


def test_the_line_can_be_left_to_another_master_whatever_waits():
    plant = Plant()
    babble(plant)
    read = USS_RPM_W(plant.port)
    read(XMT_REQ=True, DRIVE=NODE, PARAM=700)
    init = USS_INIT(plant.port)
    init(EN=True, MODE=0)
    plant.line.hear(plant.line.now, b"\x02\x06\x01")
    plant.run(50)
    init()
    assert init.DONE and init.ERROR == 0 and plant.motor.ERROR == 7
    read()
    assert read.DONE and read.ERROR == 7


def test_code_9_a_setpoint_beyond_200_percent():
    plant = Plant()
    for percent in (200.01, -200.01, 1e9, float("nan")):
        plant.inputs["SPEED_SP"] = percent
        plant.run(50)
        assert (plant.motor.ERROR, plant.motor.STATUS_WORD) == (9, 0x8186), percent


def test_code_10_the_reply_ends_too_early():
    for count in (3, 8, 15):
        assert error_with(lambda reply: reply[:count]) == 10, count


def test_code_11_the_first_character_is_no_stx():
    def change(reply):
        reply[0] = 0x03
        return reply

    assert error_with(change) == 11


def test_code_12_the_length_character_is_not_that_of_the_layout():
    for length in (0x00, 0x0D, 0x0F, 0xFF):

        def change(reply):
            reply[1] = length
            return reply

        assert error_with(change) == 12, length


def test_code_13_another_drive_answers():
    answer = of_words([0] * 4 + [READY, 0], NODE + 1)
    assert error_with(lambda reply: answer) == 13


def test_code_15_a_parameter_that_cannot_exist():
    for number, index, code in (
        (-1, 0, 15), (128_000, 0, 15), (700, 255, 15), (700, 256, 15), (700, -1, 15),
        (0, 0, 20), (127_999, 0, 20), (700, 254, 20),  # these the drive itself refuses
    ):  # fmt: skip
        plant = Plant()
        read = USS_RPM_W(plant.port)
        assert plant.until_done(read, DRIVE=NODE, PARAM=number, INDEX=index) == code, number


def test_code_16_a_mode_that_there_is_not():
    plant = Plant()
    init = USS_INIT(plant.port)
    init(EN=True, MODE=2, BAUD=19200, ACTIVE=1)
    assert (init.DONE, init.ERROR) == (True, 16)


def test_code_17_a_change_while_the_motor_runs():
    plant = Plant()
    plant.inputs["RUN"] = False
    plant.run()
    plant.inputs["RUN"] = True
    plant.run()
    assert plant.motor.RUN_EN
    init = USS_INIT(plant.port)
    init(EN=True, MODE=1, BAUD=9600, ACTIVE=1 << NODE)
    assert (init.DONE, init.ERROR) == (True, 17)
    plant.inputs["TYPE"] = 0
    plant.run(5)
    assert plant.motor.ERROR == 17


def test_code_18_a_rate_that_uss_does_not_have():
    port = Port(None, Clock())
    for baud in (0, 12_345, 14_400, -1):
        init = USS_INIT(port)
        init(EN=True, MODE=1, BAUD=baud, ACTIVE=1)
        assert (init.DONE, init.ERROR, init.STATUS_WORD) == (True, 18, 0x8189), baud


def test_code_19_a_drive_that_is_not_active():
    plant = Plant()
    plant.inputs["DRIVE"] = 5
    plant.run()
    assert (plant.motor.ERROR, plant.motor.STATUS_WORD) == (19, 0x818E)
    assert plant.until_done(USS_RPM_W(plant.port), DRIVE=5, PARAM=700) == 19


def test_code_20_the_drive_refuses():
    plant = Plant()
    plant.parameters[700] = (7, 0, 17)
    read = USS_RPM_W(plant.port)
    assert plant.until_done(read, DRIVE=NODE, PARAM=700) == 20
    assert (read.PKW_ERROR, read.STATUS_WORD) == (17, 0x818C)
    plant.parameters[700] = (8, 0, 0)
    write = USS_WPM_W(plant.port)
    assert plant.until_done(write, DRIVE=NODE, PARAM=700, VALUE=5) == 20
    assert write.STATUS_WORD == 0x818D


def test_code_20_the_drive_answers_something_else_for_good():
    plant = Plant()
    plant.reply_pkw = lambda pkw: [0, 0, 0, 0]
    read = USS_RPM_W(plant.port)
    assert plant.until_done(read, DRIVE=NODE, PARAM=700) == 20
    assert read.PKW_ERROR is None  # it has not refused
    plant, times = Plant(), []

    def answer(request):
        times.append(plant.line.now)
        return None if len(times) == 20 else plant.well(request)

    plant.reply_pkw = lambda pkw: [0, 0, 0, 0]
    plant.line.answer = answer  # that one reply is lost meanwhile is not why
    assert plant.until_done(USS_RPM_W(plant.port), DRIVE=NODE, PARAM=700) == 20
    assert len(times) > 30


def test_code_21_a_double_word_instead_of_a_word():
    plant = Plant()
    plant.parameters[1120] = (2, 0x4120, 0)
    read = USS_RPM_W(plant.port)
    assert plant.until_done(read, DRIVE=NODE, PARAM=1120) == 21
    assert read.STATUS_WORD == 0x8182 and read.VALUE == 0


def test_code_22_a_word_instead_of_a_double_word():
    for block_class in (USS_RPM_D, USS_RPM_R):
        plant = Plant()
        plant.parameters[700] = (1, 0, 5)
        read = block_class(plant.port)
        assert plant.until_done(read, DRIVE=NODE, PARAM=700) == 22
        assert read.STATUS_WORD == 0x8183 and read.VALUE == 0


def test_a_parameter_block_says_why_nothing_came():
    """What stands in the way of the replies is what it reports, not only that time is up."""

    def silence(reply):
        return None

    def bad_bcc(reply):
        reply[15] ^= 1
        return reply

    def cut(reply):
        return reply[:7]

    for change, code in ((silence, 1), (bad_bcc, 2), (cut, 10)):
        plant = Plant()
        plant.run()
        plant.line.answer = spoilt(change)
        read = USS_RPM_W(plant.port)
        assert plant.until_done(read, DRIVE=NODE, PARAM=700) == code, code
        assert read.STATUS_WORD == codes.word(code) and read.PKW_ERROR is None


def test_every_code_is_provoked_or_cannot_occur():
    names = list(globals())
    for code in range(len(codes.CODES)):
        provoked = any(name.startswith("test_code_%d_" % code) for name in names)
        assert provoked != (code in NEVER), code


def test_an_input_that_is_not_connected_is_0():
    """DRIVE, PARAM, INDEX and VALUE, as they go out to the node 0 that is asked by that."""
    for kind, wanted in (
        (USS_RPM_W, [0x1000, 0, 0, 0]), (USS_RPM_D, [0x1000, 0, 0, 0]),
        (USS_RPM_R, [0x1000, 0, 0, 0]), (USS_WPM_W, [0x2000, 0, 0, 0]),
        (USS_WPM_D, [0x3000, 0, 0, 0]), (USS_WPM_R, [0x3000, 0, 0, 0]),
    ):  # fmt: skip
        plant = Plant(active=1)
        plant.inputs["DRIVE"] = 0
        block = kind(plant.port)
        block()
        plant.run(100, block)
        assert not block.DONE and not plant.port.is_busy()
        since = len(plant.line.requests)
        block(XMT_REQ=True)
        plant.run(200, block)
        assert (block.DONE, block.ERROR, block.PKW_ERROR) == (True, 20, 0), kind.__name__
        tasks = [words_of(request)[:-2] for request in plant.line.requests[since:]]
        assert wanted in tasks and all([task in (wanted, [0] * 4) for task in tasks]), tasks


def test_an_input_of_uss_init_that_is_not_connected_is_uss_at_9600_baud_without_drives():
    plant = Plant()
    opened = []
    port = Port(lambda baud: opened.append(baud) or plant.line.master, LineClock(plant.line))
    init = USS_INIT(port)
    init()
    assert not init.DONE and port.bus is None  # EN is one of them
    init(EN=True)
    assert (init.DONE, init.ERROR, opened) == (True, 0, [9600])
    assert port.bus is plant.line.master and port.drives == [None] * 32


def test_an_input_of_uss_ctrl_that_is_not_connected_is_0_and_en_and_type_are_1():
    plant = Plant(active=1)
    plant.inputs = {}
    plant.run()
    assert plant.port.controls[0] is plant.motor and plant.port.families[0] is MM4
    assert words_of(plant.line.requests[-1]) == [0, 0, 0, 0, 0x047E, 0]
    plant.inputs["F_ACK"] = True  # it was off until now
    since = len(plant.line.requests)
    plant.run(100)
    assert [request for request in plant.line.requests[since:] if words_of(request)[-2] & 0x80]
    plant.inputs = {"RUN": True}
    plant.run()
    assert plant.motor.RUN_EN and words_of(plant.line.requests[-1])[-2:] == [0x047F, 0]
    plant.inputs = {}
    plant.run(100)
    assert words_of(plant.line.requests[-1])[-2] == 0x047E and not plant.motor.RUN_VOID


def test_a_drive_that_no_uss_ctrl_has_named_is_of_type_1_or_of_the_only_one():
    for types, family in ((TYPES, MM4), (TYPES + (Fan,), MM4), ((Pump,), Pump)):
        assert Port(None, Clock(), types).families == [family] * 32


def test_what_was_wrong_with_one_drive_is_not_said_of_the_next():
    plant = Plant(lambda request: None, active=0b11 << NODE)
    plant.run()
    assert plant.motor.ERROR == 1
    plant.inputs["DRIVE"] = NODE + 1
    plant.motor(**plant.inputs)
    assert plant.motor.ERROR == 0  # until its next telegram
    plant.run()
    assert plant.motor.ERROR == 1


# --- what is no value of its pin ----------------------------------------------------------------

NO_INTEGERS = (None, "1", "x", b"1", 1.0, 2.5, float("nan"), [], {}, (1,), object())
NO_NUMBERS = (None, "fast", "50", b"50", [], {}, (50,), object())
ANYTHING = NO_INTEGERS + (-1, 1 << 40, 10**30, True, "")


def outcome(block, **inputs):
    """Its code after one edge of whatever it waits for."""
    for on in (False, True):
        if isinstance(block, USS_INIT):
            block(EN=on, **inputs)
        else:
            block(XMT_REQ=on, **inputs)
    return block.ERROR


def test_a_wrong_input_of_uss_init_is_a_code():
    right = {"MODE": 1, "BAUD": 19200, "ACTIVE": 1 << NODE}
    for name, code in (("MODE", 16), ("BAUD", 18), ("ACTIVE", 6)):
        for value in NO_INTEGERS + (-1, 1 << 40):
            plant = Plant()
            inputs = dict(right)
            inputs[name] = value
            assert outcome(plant.init, **inputs) == code, (name, value)
            assert plant.init.DONE and plant.port.drives[NODE] is not None


def test_a_wrong_input_of_uss_ctrl_is_a_code_and_stops_the_motor():
    for name, code in (("DRIVE", 6), ("TYPE", 5)):
        for value in NO_INTEGERS + (-1, 1 << 40):
            plant = started()
            plant.inputs[name] = value
            plant.run(50)
            assert plant.motor.ERROR == code and plant.motor.RUN_VOID, (name, value)
            assert words_of(plant.line.requests[-1])[-2] == 0x047E, (name, value)


def started():
    """A plant whose motor runs."""
    plant = Plant()
    plant.inputs["RUN"] = False
    plant.run()
    plant.inputs["RUN"] = True
    plant.run()
    assert plant.motor.RUN_EN and not plant.motor.RUN_VOID
    return plant


def test_a_setpoint_that_is_no_number_is_code_9_and_the_motor_keeps_its_speed():
    for value in NO_NUMBERS + (float("nan"), float("inf"), 10**30, -(10**30)):
        plant = started()
        plant.inputs["SPEED_SP"] = value
        plant.run(50)
        assert plant.motor.ERROR == 9, value
        assert words_of(plant.line.requests[-1])[-2:] == [0x047F, 0x2000], value
        plant.inputs["RUN"] = False
        plant.run(50)
        assert words_of(plant.line.requests[-1])[-2] == 0x047E, value


def test_a_wrong_address_or_number_of_a_parameter_is_a_code():
    plant = Plant()
    plant.run()
    for kind in (USS_RPM_W, USS_RPM_D, USS_RPM_R, USS_WPM_W, USS_WPM_D, USS_WPM_R):
        for name, code in (("DRIVE", 6), ("PARAM", 15), ("INDEX", 15)):
            for value in NO_INTEGERS + (-1, 1 << 40):
                inputs = {"DRIVE": NODE, "PARAM": 700, "INDEX": 0}
                inputs[name] = value
                block = kind(plant.port)
                assert outcome(block, **inputs) == code and block.DONE, (kind, name, value)


def test_a_value_that_is_none_is_code_5():
    for kind, values in (
        (USS_WPM_W, NO_NUMBERS + (2.5, 1 << 16, 10**30)),
        (USS_WPM_D, NO_NUMBERS + (2.5, 1 << 32, 10**30)),
        (USS_WPM_R, NO_NUMBERS + (float("nan"), 1e39, 10**400)),
    ):  # fmt: skip
        plant = Plant()
        plant.run()
        for value in values:
            block = kind(plant.port)
            assert outcome(block, DRIVE=NODE, PARAM=700, VALUE=value) == 5, (kind, value)
            assert block.DONE and block.STATUS_WORD == 0x8181, (kind, value)


def test_the_largest_values_are_written():
    for kind, value, words in (
        (USS_WPM_W, 65535, (1, 0, 65535)), (USS_WPM_W, -32768, (1, 0, 0x8000)),
        (USS_WPM_D, 0xFFFFFFFF, (2, 0xFFFF, 0xFFFF)), (USS_WPM_D, -(1 << 31), (2, 0x8000, 0)),
        (USS_WPM_R, FLOAT_MAX, (2, 0x7F7F, 0xFFFF)), (USS_WPM_R, -FLOAT_MAX, (2, 0xFF7F, 0xFFFF)),
    ):  # fmt: skip
        plant = Plant()
        plant.parameters[700] = words
        write = kind(plant.port)
        assert plant.until_done(write, DRIVE=NODE, PARAM=700, VALUE=value) == 0, (kind, value)
        asked = [words_of(request)[:4] for request in plant.line.requests]
        assert list(words[1:]) in [pkw[2:] for pkw in asked if pkw[0]], (kind, value)


def test_a_bit_may_be_anything():
    for value in ANYTHING:
        plant = Plant()
        for name in ("EN", "RUN", "OFF2", "OFF3", "F_ACK", "DIR"):
            plant.inputs[name] = value
            plant.run(20)
        for kind in (USS_RPM_W, USS_WPM_W):
            kind(plant.port)(EN=value, XMT_REQ=value, DRIVE=NODE, PARAM=700)
        USS_WPM_W(plant.port)(XMT_REQ=True, EEPROM=value, DRIVE=NODE, PARAM=700)
        plant.init(EN=False)
        plant.init(EN=value, MODE=1, BAUD=19200, ACTIVE=1 << NODE)


# --- what TYPE means on the line ----------------------------------------------------------------


def test_the_words_of_both_types():
    for type_number, reverse, words in (
        (1, False, (0x047F, 0x2000)), (1, True, (0x0C7F, 0x2000)),
        (0, False, (0x0C7F, 0x2000)), (0, True, (0x147F, 0x2000)),
    ):  # fmt: skip
        plant = Plant()
        plant.inputs.update({"TYPE": type_number, "RUN": False, "DIR": reverse})
        plant.run()
        assert words_of(plant.line.requests[-1])[-2:] == [0x047E, 0]
        plant.inputs["RUN"] = True
        plant.run()
        request = words_of(plant.line.requests[-1])
        assert tuple(request[-2:]) == words, (type_number, reverse)
        assert len(request) == (6 if type_number else 5)


def test_no_on_is_sent_to_a_drive_that_cannot_run():
    # Fault, inhibit, OFF2 and OFF3 in force, and one that has not answered yet.
    for zsw in (0xFB39, 0xFB71, 0xFB21, 0xFB11, None):
        plant = Plant()
        plant.zsw = zsw
        if zsw is None:
            plant.line.answer = None
        plant.inputs["RUN"] = False
        plant.run()
        plant.inputs["RUN"] = True
        plant.run(5)
        assert plant.motor.RUN_VOID, zsw
        plant.run(1_500)
        plant.line.answer = plant.well
        plant.zsw = READY
        plant.run(1_500)
        assert plant.motor.RUN_VOID and plant.motor.ERROR == 0
        for request in plant.line.requests:
            assert not words_of(request)[-2] & 1, zsw


def test_no_on_is_sent_to_a_drive_that_is_lost():
    plant = Plant()
    plant.inputs["RUN"] = False
    plant.run()
    plant.line.answer = None
    plant.run(2_000)
    plant.inputs["RUN"] = True
    plant.run(5)
    assert plant.motor.RUN_VOID and plant.motor.ERROR == 1
    assert plant.motor.STATUS == READY  # as it was last
    plant.line.answer = plant.well
    plant.run(2_000)
    assert plant.motor.RUN_VOID and not plant.motor.RUN_EN


def test_a_micromaster_3_that_tells_its_speed_without_a_sign():
    plant = Plant()
    plant.inputs["TYPE"] = 0
    plant.zsw = 0xBB34  # bit 14 is 0: it turns left
    plant.line.answer = lambda request: of_words([0, 0, 0, plant.zsw, 0x2000], request[2])
    plant.run()
    assert plant.motor.SPEED == -50.0 and not plant.motor.D_DIR
    plant.zsw = 0xFB34
    plant.run()
    assert plant.motor.SPEED == 50.0 and plant.motor.D_DIR


def test_other_families_and_layouts_are_types_of_their_own():
    plant = Plant(types=TYPES + (Fan,))
    plant.parameters[700] = (1, 5, 0)
    plant.inputs["TYPE"] = 2
    plant.reply_pkw = lambda pkw: [0x12BC, 0, 5] if pkw[0] else [0, 0, 0]
    read = USS_RPM_W(plant.port)
    assert plant.until_done(read, DRIVE=NODE, PARAM=700) == 0 and read.VALUE == 5
    assert len(words_of(plant.line.requests[-1])) == 5
