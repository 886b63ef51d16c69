# SPDX-License-Identifier: MIT
"""The serial port on which a logger listens: what the PC sends, what it reads, and its end."""

from hal.serial import END, Serial

POLLIN, POLLOUT = 1, 4
CTRL_C, NO_CHARACTER = 3, -1


class Port:
    """A chip's port, and the PC at its other end. Nothing waits for either of them."""

    def __init__(self):
        self.typed = b""
        self.sent = []
        self.has_room = self.is_idle = True
        self.interrupt = CTRL_C
        self.serial = Serial(self, self, self.set_interrupt, lambda: self.is_idle)

    def set_interrupt(self, code):
        self.interrupt = code

    def ipoll(self, timeout_ms):
        assert timeout_ms == 0
        flags = (POLLIN if self.typed else 0) | (POLLOUT if self.has_room else 0)
        return ((self, flags),) if flags else ()

    def read(self, count):
        assert count == 1 and self.typed, "it waits for the PC"
        character, self.typed = self.typed[:1], self.typed[1:]
        return character

    def write(self, buffer, at, count):
        self.sent.append(bytes(buffer[at : at + count]))

    def ends(self, characters):
        """Whether the last of these characters ends the program, and none before it."""
        for place in range(len(characters)):
            self.typed = characters[place : place + 1]
            try:
                self.serial.hear()
            except KeyboardInterrupt:
                assert place == len(characters) - 1, characters[: place + 1]
                return True
            assert not self.typed
        return False


def listening():
    port = Port()
    port.serial.listen(True)
    return port


# --- what the PC sends ---------------------------------------------------------------------------


def test_ctrl_c_is_a_character_like_any_other_while_the_panel_listens():
    port = Port()
    assert not port.serial.hears
    port.serial.listen(True)
    assert port.serial.hears and port.interrupt == NO_CHARACTER
    port.serial.listen(False)
    assert not port.serial.hears and port.interrupt == CTRL_C


def test_what_comes_is_left_to_the_prompt_while_the_panel_does_not_listen():
    port = Port()
    port.typed = b"x"
    port.serial.hear()
    assert port.typed == b"x"


def test_where_nothing_has_come_nothing_is_read():
    """Whether there is room to write or not."""
    port = listening()
    for has_room in (True, False):
        port.has_room = has_room
        port.serial.hear()  # reading would wait


def test_the_line_that_ends_the_program_ends_it_each_time():
    port = listening()
    assert port.ends(END)
    assert not port.ends(END[1:]), "the # is wanted each time"
    assert port.ends(END[:-1] + b"\n")
    assert not port.ends(b"\r\n")
    assert port.ends(END)


def test_what_only_begins_like_that_line_ends_nothing_and_what_follows_it_does():
    for before in (b"#", b"# ", b"# end panels\r", b"# end # ", b"x\r\n\x03", b"# end panel"):
        port = listening()
        assert not port.ends(before), before
        assert port.ends(END), before


def test_a_line_with_one_other_character_ends_nothing():
    for place in range(len(END)):
        for other in (END[place] - 1, END[place] + 1, 0, 255):
            if place == len(END) - 1 and other == ord("\n"):
                continue
            port = listening()
            assert not port.ends(END[:place] + bytes((other,)) + END[place + 1 :]), (place, other)
    assert not listening().ends(END[1:])


# --- what it reads -------------------------------------------------------------------------------


def test_a_line_goes_a_packet_at_a_time():
    port = Port()
    line = bytes(range(150))
    at = 0
    for following in (64, 128, 150):
        at = port.serial.send(line, at)
        assert at == following
    assert port.sent == [line[:64], line[64:128], line[128:]]
    assert port.serial.packet == 64
    port.typed = b"x"  # that something has come holds up nothing
    assert port.serial.send(line, 100) == 150 and port.sent[-1] == line[100:]


def test_nothing_is_sent_where_somebody_would_have_to_wait_for_it():
    """There is no room, or the PC has not taken the last packet. Something may have come."""
    for has_room, is_idle in ((False, True), (True, False), (False, False)):
        for typed in (b"", b"x"):
            port = Port()
            port.has_room, port.is_idle, port.typed = has_room, is_idle, typed
            assert port.serial.send(b"{}\r\n", 0) == 0 and not port.sent
