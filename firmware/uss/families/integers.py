# SPDX-License-Identifier: MIT
"""Which 32-bit parameters are integers: connectors, serial numbers, voltages, fault values.

The others of these families are floating-point numbers. A table has pairs: the first number of
some, and the one behind the last. Between the two the catalogue has no double word of another
kind. One table is for all families that are like a MICROMASTER 420. Loaded when somebody asks.
"""

TABLES = {  # by `integer_doubles` of a family
    "MM4": (
        95, 96,  200, 205,  208, 209,  731, 734,  771, 772,  800, 950,  1020, 1024,
        1026, 1037,  1041, 1045,  1055, 1057,  1070, 1077,  1110, 1114,  1124, 1125,
        1140, 1143,  1175, 1176,  1230, 1231,  1330, 1331,  1501, 1504,  1511, 1512,
        2016, 2107,  2151, 2153,  2200, 2201,  2253, 2255,  2264, 2265,  2810, 2850,
        2869, 2870,  3351, 3352,  3852, 3853,
    ),
    "G120": (
        15, 19,  46, 47,  722, 732,  840, 950,  1070, 1071,  1110, 1111,  1230, 1231,
        2029, 2125,  2200, 2265,
    ),
}  # fmt: skip
