# SPDX-License-Identifier: MIT
"""What SET asks first on the page of a parameter, by risk. See `panel.texts`."""

from panel.pages import writing
from uss.families.generic import CUTS_OFF, RESCALES

_TO_BE_WRITTEN = (b"A%d: P%04d[%d]", b"= %s")
ASK = {
    CUTS_OFF: (_TO_BE_WRITTEN + writing.ASK[CUTS_OFF][0][1:], writing.ASK[CUTS_OFF][1]),
    RESCALES: (_TO_BE_WRITTEN + writing.ASK[RESCALES][0][1:], writing.ASK[RESCALES][1]),
}
