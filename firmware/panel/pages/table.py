# SPDX-License-Identifier: MIT
"""The pages: module, class, and the page that PARAM shows next. The first one is the home page,
which is always loaded; the others are `on_demand`. The last one is reached through the menu.
"""

HOME, PARAMETERS, PARAMETER = range(3)
PAGES = (
    ("panel.pages.home", "Home", PARAMETERS),
    ("panel.pages.parameters", "Parameters", HOME),
    ("panel.lookup.parameter", "Parameter", HOME),
)
