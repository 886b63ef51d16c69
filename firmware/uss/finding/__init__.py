# SPDX-License-Identifier: MIT
"""Who is on the line, and how the telegrams to it are divided, without moving anything.

mirror    a telegram that a node sends back as it came, and does nothing else with
finder    the layout of drives of the list that do not answer, found by trying
scan      which nodes are there, at which baud rate
enquiry   what a node that was found is: layout, family, telegram-off time
"""
