# SPDX-License-Identifier: MIT
"""Drivers that fulfil the contract `link`: half-duplex RS-485 on a UART.

bursts      receives: the characters of a burst, and when the last one ended
rs485       sends through the UART, with a pin for the driver; on any chip
rp2_rs485   sends through a PIO state machine of the RP2040, fed by DMA
"""
