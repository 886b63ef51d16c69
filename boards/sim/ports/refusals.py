# SPDX-License-Identifier: MIT
"""What each port of MicroPython refuses, and what each chip cannot do: rows with their source.

`machine.py` beside this raises them, and a test meets each of them. Some the port takes without a
word although the chip cannot do it, or boots no more: they say `port=False`. Files are those of
MicroPython 1.28, ports/<port>; data sheets by their names.
"""


class Refusal:
    """error: the exception. text: its message, with the places of a `%`. port: whether the port
    says it itself."""

    def __init__(self, error, text, source, port=True):
        self.error = error
        self.text = text
        self.source = source
        self.port = port


ANY = {
    "watchdog time": Refusal(ValueError, "WDT timeout %d is not possible", "machine_wdt.c"),
    "watchdog stop": Refusal(AttributeError, "a watchdog has no %s", "extmod/machine_wdt.c"),
    "uart handler": Refusal(
        ValueError, "handler must be None or callable", "machine_uart.c, mp_machine_uart_irq"
    ),
    "uart trigger": Refusal(
        ValueError, "trigger 0x%04x unsupported", "machine_uart.c, mp_machine_uart_irq"
    ),
    "i2c absent": Refusal(OSError, "nobody acknowledges 0x%02x", "machine_i2c.c"),
}

ESP32 = {
    "pin": Refusal(ValueError, "invalid pin: GPIO%d", "machine_pin.c, machine_pin_find"),
    "output": Refusal(
        ValueError, "GPIO%d can only be input", "machine_pin.c, GPIO_FIRST_NON_OUTPUT"
    ),
    "pull": Refusal(
        ValueError, "GPIO%d has no pull-up", "ESP32 data sheet, 2.2 and appendix A.1", False
    ),
    "flash": Refusal(
        ValueError,
        "GPIO%d belongs to the flash",
        "ESP32 data sheet, 3.1.2; ESP32-S3 data sheet, table 2-4; DevKitC user guides",
        False,
    ),
    "psram": Refusal(
        ValueError,
        "GPIO%d belongs to the octal PSRAM of many modules",
        "ESP32-S3-DevKitC-1 user guide, J3, note 4",
        False,
    ),
    "strapping": Refusal(
        ValueError,
        "GPIO%d decides how the chip boots",
        "ESP32 data sheet, 2.4; ESP32-S3 data sheet, 2.6",
        False,
    ),
    "prompt": Refusal(
        ValueError,
        "GPIO%d belongs to MicroPython's prompt",
        "DevKitC user guides: UART 0, and the native USB of the ESP32-S3",
        False,
    ),
    "led": Refusal(
        ValueError, "GPIO%d has the board's RGB LED", "ESP32-S3-DevKitC-1 user guide", False
    ),
    "timer": Refusal(ValueError, "Timer(%d) doesn't exist", "machine_timer.c"),
    "timer of the uart": Refusal(
        ValueError, "Timer(%d) is what IRQ_RXIDLE uses", "machine_uart.c, RXIDLE_TIMER_IDX", False
    ),
    "timer hard": Refusal(
        ValueError, "hard Timers are not implemented", "machine_timer.c, machine_timer_init_helper"
    ),
    "timer period": Refusal(
        ValueError,
        "Timer period is too short for this timer",
        "machine_timer.c, machine_timer_configure",
    ),
    "uart": Refusal(ValueError, "UART(%d) does not exist", "machine_uart.c, make_new"),
    "uart of the prompt": Refusal(
        ValueError, "UART(%d) has the prompt, and no IRQs", "machine_uart.c, uart_is_repl"
    ),
    "uart hard": Refusal(ValueError, "hard IRQ is not supported", "machine_uart.c"),
    "uart buffer": Refusal(
        OSError,
        "a receive buffer of %d is not longer than the FIFO",
        "ESP-IDF, uart.c, uart_driver_install",
    ),
    "i2c": Refusal(ValueError, "I2C(%d) doesn't exist", "machine_i2c.c"),
}

RP2 = {
    "pin": Refusal(ValueError, "invalid pin: GP%d", "machine_pin.c"),
    "board": Refusal(
        ValueError,
        "GP%d is not led out on a Pico: supply, VBUS, LED or radio",
        "Raspberry Pi Pico data sheet, 2.1; Pico W data sheet, 2.1",
        False,
    ),
    "e5": Refusal(
        ValueError,
        "GP%d loses its pull-up while USB starts",
        "erratum RP2040-E5; pico-sdk, rp2040_usb_device_enumeration.c",
        False,
    ),
    "timer": Refusal(ValueError, "Timer(%d) doesn't exist", "machine_timer.c, make_new"),
    "timer hard": Refusal(
        TypeError, "extra keyword arguments given", "1.25, machine_timer.c: 1.26 takes it"
    ),
    "uart": Refusal(ValueError, "UART(%d) doesn't exist", "machine_uart.c, make_new"),
    "uart pin": Refusal(ValueError, "bad pin GP%d for the UART", "machine_uart.c, IS_VALID_RX"),
    "i2c": Refusal(ValueError, "I2C(%d) doesn't exist", "machine_i2c.c"),
    "i2c pin": Refusal(ValueError, "bad pin GP%d for the I2C", "machine_i2c.c, IS_VALID_SDA"),
    "state machine": Refusal(
        ValueError, "StateMachine(%d) claimed by external resource", "rp2_pio.c"
    ),
}
