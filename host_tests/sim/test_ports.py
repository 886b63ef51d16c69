# SPDX-License-Identifier: MIT
"""The machine of each port: it refuses what the port refuses, and each refusal is met here."""

from boards.sim.chip.machine import Chip
from boards.sim.clock import Clock
from boards.sim.line.wire import Wire
from boards.sim.ports.chips import CHIPS
from boards.sim.ports.machine import Port

INTERPRETERS = "unix64 unix32 cpython"


def port_of(chip):
    clock = Clock()
    return Port(CHIPS[chip], Chip(clock, Wire(clock, 19_200)))


def uart(port, number=1, send=17, receive=18, rxbuf=512):
    return port.UART(
        number, 19_200, bits=8, parity=0, stop=1, tx=send, rx=receive, rxbuf=rxbuf, txbuf=512
    )


def pulled(port, number):
    return port.Pin(number, port.Pin.IN, port.Pin.PULL_UP)


def irq(port, **options):
    options.setdefault("handler", print)
    one = uart(port) if port.model.port == "esp32" else uart(port, 1, 4, 5)
    options.setdefault("trigger", one.IRQ_RXIDLE)
    one.irq(**options)


def prompt_irq(port):
    # The pins of UART 0 belong to the prompt; it is asked at others.
    one = uart(port, 0, 17, 16)
    one.irq(handler=print, trigger=one.IRQ_RXIDLE)


def backpack(port):
    pins = (8, 9) if port.model.port == "esp32" else (0, 1)
    if port.model.count == 40:
        pins = (21, 22)
    port.I2C(0, sda=pins[0], scl=pins[1]).writeto(0x27, b"\x08")


def claimed(port):
    from boards.sim.ports import rp2

    port.claimed = (4,)
    rp2.module(port).StateMachine(4)


# Which refusal, on which chip, by what.
REFUSED = (
    ("pin", "ESP32", lambda port: port.Pin(24)),
    ("pin", "ESP32S3", lambda port: port.Pin(49)),
    ("pin", "RP2040", lambda port: port.Pin(30)),
    ("output", "ESP32", lambda port: port.Pin(34, port.Pin.OUT)),
    ("pull", "ESP32", lambda port: pulled(port, 36)),
    ("flash", "ESP32", lambda port: pulled(port, 6)),
    ("flash", "ESP32S3", lambda port: pulled(port, 30)),
    ("psram", "ESP32S3", lambda port: pulled(port, 35)),
    ("strapping", "ESP32", lambda port: pulled(port, 12)),
    ("strapping", "ESP32S3", lambda port: pulled(port, 46)),
    ("prompt", "ESP32", lambda port: pulled(port, 3)),
    ("prompt", "ESP32S3", lambda port: pulled(port, 19)),
    ("led", "ESP32S3", lambda port: pulled(port, 48)),
    ("timer", "ESP32S3", lambda port: port.Timer(4)),
    ("timer", "RP2040", lambda port: port.Timer(0)),
    ("timer of the uart", "ESP32", lambda port: port.Timer(0)),
    ("timer hard", "ESP32S3", lambda port: port.Timer(1).init(period=5, hard=True)),
    ("timer hard", "RP2040", lambda port: port.Timer().init(period=5, hard=True)),
    ("timer period", "ESP32", lambda port: port.Timer(1).init(period=0)),
    ("uart", "ESP32", lambda port: uart(port, 3, 17, 16)),
    ("uart", "RP2350", lambda port: uart(port, 2, 4, 5)),
    ("uart pin", "RP2040", lambda port: uart(port, 1, 4, 6)),
    ("uart of the prompt", "ESP32", prompt_irq),
    ("uart hard", "ESP32S3", lambda port: irq(port, hard=True)),
    ("uart buffer", "ESP32S3", lambda port: uart(port, rxbuf=128)),
    ("uart handler", "ESP32S3", lambda port: irq(port, handler=5)),
    ("uart handler", "RP2040", lambda port: irq(port, handler=5)),
    ("uart trigger", "ESP32S3", lambda port: irq(port, trigger=0x4000)),
    ("uart trigger", "RP2040", lambda port: irq(port, trigger=1)),
    ("watchdog time", "ESP32S3", lambda port: port.WDT(timeout=0)),
    ("watchdog time", "RP2040", lambda port: port.WDT(timeout=8_389)),
    ("watchdog stop", "ESP32", lambda port: port.WDT(timeout=2_000).deinit()),
    ("watchdog stop", "RP2040", lambda port: port.WDT(timeout=2_000).stop()),
    ("i2c", "ESP32S3", lambda port: port.I2C(2, sda=8, scl=9)),
    ("i2c", "RP2040", lambda port: port.I2C(2, sda=0, scl=1)),
    ("i2c pin", "RP2040", lambda port: port.I2C(0, sda=2, scl=3)),
    ("i2c absent", "ESP32", backpack),
    ("i2c absent", "RP2040", backpack),
    ("board", "RP2040", lambda port: pulled(port, 25)),
    ("e5", "RP2040", lambda port: pulled(port, 15)),
    ("state machine", "RP2040", claimed),
)

TAKEN = (
    ("ESP32", lambda port: pulled(port, 13)),
    ("ESP32S3", lambda port: pulled(port, 41)),
    ("RP2350", lambda port: pulled(port, 15)),  # the erratum is the RP2040's
    ("RP2350", lambda port: port.WDT(timeout=8_389)),
    ("ESP32S3", lambda port: port.WDT(timeout=24 * 3_600_000)),
    ("ESP32S3", lambda port: port.Timer(3).init(period=5)),
    ("ESP32S3", irq),
    ("RP2040", irq),
)


def test_each_refusal_is_what_the_port_says():
    for name, chip, act in REFUSED:
        port = port_of(chip)
        refusal = port.model.refusals[name]
        try:
            act(port)
        except refusal.error:
            assert port.met[-1][0] == name, (name, chip, port.met)
        else:
            raise AssertionError("%s: %s is not refused" % (chip, name))


def test_every_row_is_met_and_has_its_source():
    met = {(CHIPS[chip].port, name) for name, chip, _ in REFUSED}
    for chip in CHIPS.values():
        for name, refusal in chip.refusals.items():
            assert (chip.port, name) in met, (chip.port, name)
            assert refusal.source and refusal.text, name


def test_what_the_port_takes_is_taken():
    for chip, act in TAKEN:
        port = port_of(chip)
        act(port)
        assert not port.met, (chip, port.met)


def test_a_lenient_port_notes_what_it_would_refuse():
    port = port_of("ESP32S3")
    port.lenient = ("flash",)
    pulled(port, 30)
    assert [name for name, _ in port.met] == ["flash"]
