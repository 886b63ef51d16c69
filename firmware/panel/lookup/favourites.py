# SPDX-License-Identifier: MIT
"""The favourite parameters of each family: at first what parameter mode shows. See `settings`."""

import on_demand
from panel.lookup import words


def name_of(family):
    """What a family is called in the settings."""
    return (family.com or family).__name__.lower()


def favourites(settings, family):
    """The numbers."""
    chosen = settings.favourites.get(name_of(family))
    return [row[0] for row in family.shown] if chosen is None else list(chosen)


def turn(settings, family, number):
    """Put a number among them, or take it away; the text that says so."""
    schema = on_demand.load("settings_file")
    on_demand.drop("settings_file")
    chosen = favourites(settings, family)
    text = words.IS_NO_FAVOURITE
    if number in chosen:
        chosen.remove(number)
    else:
        chosen.append(number)
        text = words.IS_FAVOURITE
    everybodys = dict(settings.favourites)
    everybodys[name_of(family)] = chosen
    if sum([len(everybodys[name]) for name in everybodys]) > schema.FAVOURITES_MAX:
        return words.FAVOURITES_FULL
    settings.change("favourites", everybodys)
    return text
