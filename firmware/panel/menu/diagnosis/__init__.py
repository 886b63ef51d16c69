# SPDX-License-Identifier: MIT
"""What goes on on the line, for whoever looks for a fault: `overview` leads to the other lists.

`words` has their texts. What is gathered only while somebody looks, `uss.finding.witness` gathers.
"""
