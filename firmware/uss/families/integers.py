# SPDX-License-Identifier: MIT
"""Which 32-bit parameters are integers: connectors, serial numbers, voltages, fault values.

The others of these families are floating-point numbers. They are those of the catalogue, and one
table is for all families that are like a MICROMASTER 420. Loaded when somebody asks.
"""

TABLES = {  # by `integer_doubles` of a family
    "MM4": (
        95, 200, 204, 208, 731, 732, 733, 771, 800, 801, 810, 811, 820, 821, 840, 842, 844,
        845, 848, 849, 852, 949, 1020, 1021, 1022, 1023, 1026, 1028, 1035, 1036, 1041,
        1043, 1044, 1055, 1056, 1070, 1071, 1074, 1075, 1076, 1110, 1113, 1124, 1140, 1141,
        1142, 1175, 1230, 1330, 1501, 1503, 1511, 2016, 2019, 2051, 2103, 2104, 2106, 2151,
        2152, 2200, 2253, 2254, 2264, 2810, 2812, 2814, 2816, 2818, 2820, 2828, 2830, 2849,
        2869, 3351, 3852,
    ),
    "G120": (
        15, 18, 46, 722, 730, 731, 840, 844, 848, 852, 948, 949, 1070, 1110, 1230, 2029,
        2051, 2103, 2106, 2124, 2200, 2253, 2264,
    ),
}  # fmt: skip
