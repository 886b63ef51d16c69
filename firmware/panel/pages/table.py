# SPDX-License-Identifier: MIT
"""The pages: class, the page that PARAM shows next, and modules. The first one is the home page,
which is always loaded. The others are `on_demand`, a module in a step, from the bottom of the
house up: the last one has the class. `PARAMETER` is reached through the menu.
"""

HOME, PARAMETERS, PARAMETER = range(3)
PAGES = (
    ("Home", PARAMETERS, ()),
    (
        "Parameters", HOME,
        ("panel.pages.parameter_words", "panel.pages.writing", "panel.pages.parameters"),
    ),
    (
        "Parameter", HOME,
        (
            "catalogue", "catalogue.beside", "panel.lookup", "panel.lookup.words",
            "panel.pages.parameter_words", "panel.pages.writing", "panel.lookup.favourites",
            "panel.lookup.value", "panel.lookup.editing", "panel.lookup.sight",
            "panel.lookup.answers", "panel.lookup.inspection", "panel.lookup.parameter",
        ),
    ),
)  # fmt: skip
