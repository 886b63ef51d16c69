# SPDX-License-Identifier: MIT
"""Parameter jobs of more than one value, and what else few programs need of the channel.

    arrays           one element of an array, all elements, their number
    descriptions     limits, name, unit of a parameter
    texts            what a text parameter says
    long_jobs        what these three share
    change_reports   parameters that somebody else has changed

Each loads by itself: `from uss.tasks import arrays`.
"""
