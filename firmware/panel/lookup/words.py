# SPDX-License-Identifier: MIT
"""The texts of what the catalogue knows, in memory only while it is shown. See `panel.texts`."""

# The list of groups.
BY_NUMBER = b"BY NUMBER"
FAVOURITES = b"FAVOURITES"
ALL_OF_THEM = b"ALL"

# The page of a parameter.
TYPE_NUMBER = b"NUMBER  SET=SHOW"  # row 1 while a number is typed
NEW_VALUE = b"NEW"
NO_NAME = b"NOT IN THE LIST"  # the catalogue does not know this number
NOT_AN_ARRAY = b"NOT AN ARRAY"
SET_OR_PARAM = b"NO: SET OR PARAM"
IS_FAVOURITE = b"FAVOURITE"
IS_NO_FAVOURITE = b"NO FAVOURITE NOW"
FAVOURITES_FULL = b"FAVOURITES FULL"

# Faults and warnings.
CAUSE = b"CAUSE"
REMEDY = b"REMEDY"
NO_TEXT = b"NO TEXT FOR IT"
FAULTS_OF = b"A%d FAULTS"
NO_FAULT = b"NO FAULT"
