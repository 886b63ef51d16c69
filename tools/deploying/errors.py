# SPDX-License-Identifier: MIT
"""The one error of tools/deploy: says in a line, or several, what is wrong and what helps."""


class DeployError(Exception):
    pass
