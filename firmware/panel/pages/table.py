# SPDX-License-Identifier: MIT
"""The pages, in the order in which PARAM shows them; the first one is the home page."""

from panel.pages.home import Home
from panel.pages.parameters import Parameters

PAGES = (Home, Parameters)
