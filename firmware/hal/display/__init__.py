# SPDX-License-Identifier: MIT
"""Drivers that fulfil the contract `display`: one for each way to reach an HD44780.

character_display  what is written when; the others begin with it
hd44780            four data lines on pins, on any chip
backpack           four data lines behind a PCF8574 on I2C
rp2_hd44780        four data lines of the RP2040, moved by a PIO state machine
rp2_i2c            I2C of the RP2040 that does not wait, for a backpack
probe              whether a backpack is there
"""
