# SPDX-License-Identifier: MIT
"""Going on at once: the next telegram is made ready while the one before is on the line.

With a link that `goes_on` the next telegram leaves as soon as the reply is complete and says
nothing new; what the reply says is worked through meanwhile. Any other reply, and any command,
takes the usual way: the reply is taken first, then it is decided who is next.

The engine for it is loaded only where there is such a link: it takes memory of a chip on which the
firmware is not frozen.
"""


def master_of(link, *arguments):
    """The master for this link. arguments: those of `uss.master.Master` after the link."""
    if getattr(link, "goes_on", False):
        from uss.going_on.master import GoingOnMaster as make
    else:
        from uss.master import Master as make
    return make(link, *arguments)
