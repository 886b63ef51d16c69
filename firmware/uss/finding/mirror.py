# SPDX-License-Identifier: MIT
"""A telegram outside the circulating list, and the mirror telegram (specification A-4.3, A-5.3).

`outside` has the others, and says how they are sent.
"""

from uss import telegram
from uss.pkw import DONE, NEW, TIMED_OUT
from uss.telegram import MIRROR, NET, NODE_MAX

PROBE = bytes(12)  # net data that name no task and, bit 10 of STW being 0, command nothing


class OutsideTelegram:
    """The telegram with these net data to this ADR. ValueError if there is no such telegram.

    state: what became of it. finding: the receiver's, why there was no reply. The engine uses the
    other fields as those of a drive.
    """

    outside = True  # it is outside the list

    def __init__(self, address, net):
        self.request = bytearray(len(net) + 4)
        self.request[NET : NET + len(net)] = net
        self.size = telegram.seal(self.request, address, len(net))
        self.address = address
        self.ahead = False  # it goes ahead of all other telegrams; otherwise it waits its turn
        self.sealed = True
        self.silent = 0  # times in a row without a reply
        self.state = NEW
        self.finding = telegram.GOOD

    def fits(self, net_count):
        """Whether a reply may have so many net characters."""
        return net_count == self.size - 4

    def may_reply_alike(self):
        """Whether the reply may be equal to the request."""
        return True

    # --- for the engine: allocates nothing ------------------------------------------------------

    def fill(self, now):
        """Nothing to do: the telegram does not change."""

    def foresee(self, room, answering):
        """It is made ready only when its turn has come: see `Drive.foresee`."""
        return

    def take(self, buffer, count, now):
        self.state = DONE

    def miss(self, finding, now, lost_us, mask):
        self.silent += 1
        self.finding = finding
        self.state = TIMED_OUT

    def __repr__(self):
        return "<%s to ADR %02X>" % (type(self).__name__, self.address)


class Mirror(OutsideTelegram):
    """Asks a node to send the telegram back as it is (A-5.3). The node acts on nothing in it.

    node: 0...31. net: what is sent; a drive of fixed length answers only its own length. DONE if
    it came back unchanged; otherwise `finding` tells what came instead.
    """

    def __init__(self, node, net=PROBE):
        if not 0 <= node <= NODE_MAX:
            raise ValueError("node %r is not 0...31" % (node,))
        OutsideTelegram.__init__(self, node | MIRROR, net)
        self.node = node

    def aim(self, node, net_count):
        """Use one that is over again: as many zeros as it has at the most, to this node."""
        for index in range(net_count):
            self.request[NET + index] = 0
        self.node = node
        self.address = node | MIRROR
        self.size = telegram.seal(self.request, self.address, net_count)
        self.silent = 0
        self.state = NEW
        self.finding = telegram.GOOD

    def take(self, buffer, count, now):
        for index in range(count):
            if buffer[index] != self.request[index]:
                self.miss(telegram.BAD_BCC, now, 0, 0)
                return
        self.finding = telegram.GOOD
        self.state = DONE
