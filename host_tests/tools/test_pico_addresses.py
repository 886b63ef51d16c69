# SPDX-License-Identifier: MIT
"""What the firmware says of RP2040 and RP2350, against the headers of Raspberry Pi's own SDK; and
the firmware file for a Pico 2, as its boot ROM will look at it."""

import ast
import re
import struct

import pytest

from conftest import strict
from tiers import TOP

INTERPRETERS = "host"

SDK = TOP / "build/pico_sources/sdk/usr/src/pico-sdk/src"
CHIPS = {"RP2040": "rp2040", "RP2350": "rp2350"}
FLASH, FLASH_END = 0x1000_0000, 0x1040_0000
ON_LINE = TOP / "tools/bringing_up/on_line.py"
PICO2 = TOP / "build/pico/pico2.uf2"

# Counters of the flash's cache, of tools/bringing_up/on_line.py; the reads stand behind the hits.
CACHE_HITS = {"RP2040": 0x1400_000C, "RP2350": 0x400C_800C}

# Of boards/chips/rp2.py, `ADDRESSES` in turn.
BASES = ("WATCHDOG_BASE", "UART1_BASE", "I2C0_BASE")

# What else the firmware takes for the same on both chips: file, header, names of it, value.
ALIKE = (
    ("watchdog.h", "WATCHDOG_CTRL_OFFSET", 0x00),
    ("watchdog.h", "WATCHDOG_REASON_OFFSET", 0x08),
    ("watchdog.h", "WATCHDOG_SCRATCH4_OFFSET", 0x1C),
    ("watchdog.h", "WATCHDOG_CTRL_ENABLE_BITS", 1 << 30),
    ("uart.h", "UART_UARTDR_OFFSET", 0x00),
    ("uart.h", "UART_UARTFR_OFFSET", 6 * 4),  # `registers[6]` in hal.link.rp2_rs485
    ("uart.h", "UART_UARTFR_RXFE_BITS", 0x10),
    ("uart.h", "UART_UARTIBRD_OFFSET", 0x24),  # and so on: hal.link.rp2_check
    ("uart.h", "UART_UARTFBRD_OFFSET", 0x28),
    ("uart.h", "UART_UARTLCR_H_OFFSET", 0x2C),
    ("uart.h", "UART_UARTCR_OFFSET", 0x30),
    ("uart.h", "UART_UARTIMSC_OFFSET", 0x38),
    ("uart.h", "UART_UARTRIS_OFFSET", 0x3C),
    ("uart.h", "UART_UARTICR_OFFSET", 0x44),
    ("uart.h", "UART_UARTCR_LBE_BITS", 0x80),
    ("uart.h", "UART_UARTRIS_RTRIS_BITS", 0x40),
    ("uart.h", "UART_UARTFR_BUSY_BITS", 0x08),
    ("watchdog.h", "WATCHDOG_SCRATCH0_OFFSET", 0x0C),  # tools/bringing_up/on_chip.py
    ("i2c.h", "I2C_IC_DATA_CMD_OFFSET", 0x10),
    ("i2c.h", "I2C_IC_RAW_INTR_STAT_OFFSET", 0x34),
    ("i2c.h", "I2C_IC_TXFLR_OFFSET", 0x74),
    ("dma.h", "DMA_CH0_AL3_TRANS_COUNT_OFFSET", 14 * 4),  # `channel[14]`
    ("dma.h", "DMA_CH0_AL3_READ_ADDR_TRIG_OFFSET", 15 * 4),
    ("dreq.h", "DREQ_PIO0_TX0", 0),
    ("dreq.h", "DREQ_PIO1_TX0", 8),
    ("addressmap.h", "SIO_BASE", 0xD000_0000),
    ("sio.h", "SIO_GPIO_IN_OFFSET", 0x04),
)


def defined(chip, header, name):
    path = SDK / CHIPS[chip] / "hardware_regs/include/hardware/regs" / header
    if not path.exists() and not strict():
        pytest.skip("the SDK is not here: tools/uf2 fetches it")
    found = re.search(rf"#define {name}\s+(?:_u\()?(0x[0-9a-f]+|\d+)", path.read_text(), re.I)
    assert found, (header, name)
    return int(found[1], 0)


def table():
    """`ADDRESSES` of boards/chips/rp2.py."""
    tree = ast.parse((TOP / "boards/chips/rp2.py").read_text())
    for node in tree.body:
        if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "ADDRESSES":
            return ast.literal_eval(node.value)
    raise AssertionError("no ADDRESSES")


@pytest.mark.parametrize("chip", CHIPS)
def test_the_addresses_are_those_of_the_sdk(chip):
    assert table()[chip] == tuple(defined(chip, "addressmap.h", base) for base in BASES)


@pytest.mark.parametrize("chip", CHIPS)
@pytest.mark.parametrize("row", ALIKE, ids=[row[1] for row in ALIKE])
def test_what_is_the_same_on_both_chips(chip, row):
    header, name, value = row
    assert defined(chip, header, name) == value


@pytest.mark.parametrize("chip", CHIPS)
def test_the_counters_of_the_cache_are_those_of_the_sdk(chip):
    base = defined(chip, "addressmap.h", "XIP_CTRL_BASE")
    assert base + defined(chip, "xip.h", "XIP_CTR_HIT_OFFSET") == CACHE_HITS[chip]
    assert base + defined(chip, "xip.h", "XIP_CTR_ACC_OFFSET") == CACHE_HITS[chip] + 4
    assert "0x%04X_%04X" % divmod(CACHE_HITS[chip], 1 << 16) in ON_LINE.read_text()


def test_writing_to_an_address_3000h_higher_clears_bits():
    for chip in CHIPS.values():
        path = SDK / chip / "hardware_regs/include/hardware/regs/addressmap.h"
        if not path.exists() and not strict():
            pytest.skip("the SDK is not here: tools/uf2 fetches it")
        words = re.search(r"#define REG_ALIAS_CLR_BITS (.*)", path.read_text())[1]
        assert words.replace(" ", "") == "(_u(0x3)<<_u(12))"


def blocks_of(file):
    if not file.exists() and not strict():
        pytest.skip("no firmware is here: tools/uf2 --board pico2 builds it")
    data = file.read_bytes()
    return [data[at : at + 512] for at in range(0, len(data), 512)]


def image_of(file):
    image = bytearray()
    for block in blocks_of(file):
        address, size = struct.unpack_from("<2I", block, 12)
        assert address == FLASH + len(image)
        image += block[32 : 32 + size]
    return bytes(image)


def test_the_file_for_a_pico_2_is_for_its_family_alone():
    text = (SDK / "common/boot_uf2_headers/include/boot/uf2.h").read_text()
    family = int(re.search(r"RP2350_ARM_S_FAMILY_ID\s+(0x[0-9a-f]+)", text)[1], 0)
    for block in blocks_of(PICO2):
        assert struct.unpack_from("<3I", block) == (0x0A324655, 0x9E5D5157, 0x2000)
        assert struct.unpack_from("<I", block, 28)[0] == family


def test_the_boot_rom_of_an_rp2350_starts_it():
    """RP2350 data sheet 5.9: an IMAGE_DEF for ARM within the first 4 KB, a vector table."""
    image = image_of(PICO2)
    text = (SDK / "common/boot_picobin_headers/include/boot/picobin.h").read_text()
    marker = int(re.search(r"PICOBIN_BLOCK_MARKER_START\s+_u\((0x[0-9a-f]+)\)", text)[1], 0)
    at = image.index(struct.pack("<I", marker), 0, 4096)
    kind, flags = image[at + 4], struct.unpack_from("<H", image, at + 6)[0]
    assert kind == 0x42  # an image type, one word
    assert flags & 0xF == 1 and flags >> 8 & 7 == 0 and flags >> 12 & 7 == 1  # EXE, ARM, RP2350
    stack, reset = struct.unpack_from("<2I", image)
    assert 0x2000_0000 < stack <= 0x2008_2000  # 520 KB
    assert reset & 1 and FLASH < reset < FLASH + len(image)


def test_everything_is_frozen_into_the_file_for_a_pico_2():
    image = image_of(PICO2)
    firmware = TOP / "firmware"
    ours = {str(path.relative_to(firmware)) for path in firmware.rglob("*.py")} - {"main.py"}
    for name in ours | {"board.py", "chips/rp2.py"}:
        frozen = b"\0" + name.encode() + b"\0" in image
        assert frozen != name.startswith(("uss/br/", "uss/s7/", "uss/tasks/")), name
    assert b"RASPBERRY PICO 2" in image and b"\0chips/esp32.py\0" not in image
