# SPDX-License-Identifier: MIT
"""The serial port on which a logger listens: what the PC sends, what it reads, and its end."""

from boards.sim.chip.usb import HOLDS, Usb
from hal.serial import END


def hears(serial, usb, characters):
    """Whether the last of these characters ends the program, and none before it."""
    for place in range(len(characters)):
        usb.type(characters[place : place + 1])
        try:
            serial.hear()
        except KeyboardInterrupt:
            assert place == len(characters) - 1, characters[: place + 1]
            return True
    return False


def listening():
    usb = Usb()
    serial = usb.serial()
    serial.listen(True)
    return serial, usb


def test_the_line_that_ends_the_program_ends_it_each_time():
    serial, usb = listening()
    assert hears(serial, usb, END)
    assert not hears(serial, usb, b"\r")
    assert hears(serial, usb, END.replace(b"\r", b"\n"))
    assert hears(serial, usb, END)


def test_what_only_begins_like_that_line_ends_nothing_and_what_follows_it_does():
    for before in (b"#", b"# ", b"# end panels\r", b"# end # ", b"x\r\n\x03", b"# end panel"):
        serial, usb = listening()
        assert not hears(serial, usb, before), before
        assert hears(serial, usb, END), before


def test_a_port_that_has_no_room_and_nothing_to_read_is_left_alone():
    serial, usb = listening()
    usb.is_read = False
    usb.write(bytes(HOLDS), 0, HOLDS)
    serial.hear()
    assert serial.send(b"{}\r\n", 0) == 0 and usb.waits == 0
    usb.is_read = True
    assert serial.send(b"{}\r\n", 0) == 4 and usb.heard[-4:] == b"{}\r\n"


def test_a_port_whose_poll_tells_of_no_room_is_not_written_to():
    """Although the PC has taken all packets."""
    usb = Usb()
    usb.ipoll = lambda timeout_ms: ()
    serial = usb.serial()
    assert serial.send(b"{}\r\n", 0) == 0 and not usb.heard
