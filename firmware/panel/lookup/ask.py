# SPDX-License-Identifier: MIT
"""What SET asks first on the page of a parameter, by risk. See `panel.texts`."""

from panel import texts
from uss.families.generic import CUTS_OFF, RESCALES

_TO_BE_WRITTEN = (b"A%d: P%04d[%d]", b"= %s")
ASK = {
    CUTS_OFF: (_TO_BE_WRITTEN + texts.ASK_CUTS_OFF[0][1:], texts.ASK_CUTS_OFF[1]),
    RESCALES: (_TO_BE_WRITTEN + texts.ASK_RESCALES[0][1:], texts.ASK_RESCALES[1]),
}
