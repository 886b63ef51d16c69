# SPDX-License-Identifier: MIT
"""Drivers that fulfil the contract `link`: half-duplex RS-485 on a UART.

bursts          receives: the characters of a burst, and when the last one ended
rs485           sends through the UART, with a pin for the driver; on any chip
self_directed   sends through the UART, and nobody has to switch the driver
rp2_rs485       sends through a PIO state machine of an RP2040 or RP2350, fed by DMA
rp2_going_on    does that too, and sends the next telegram by itself when a reply says nothing new
"""
