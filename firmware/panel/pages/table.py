# SPDX-License-Identifier: MIT
"""The pages, in the order in which PARAM shows them; the first one is the home page, which is
always loaded. The others are `on_demand`: module of `panel.pages`, and class.
"""

PAGES = (("home", "Home"), ("parameters", "Parameters"))
