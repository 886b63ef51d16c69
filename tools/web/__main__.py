# SPDX-License-Identifier: MIT
"""./tools/panel --web: the panel in a browser. See server.py and static.py."""

import asyncio
import subprocess
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP))

from tools.web import static  # noqa: E402
from tools.web.options import Misused, options  # noqa: E402

PANEL = [str(TOP / "tools/panel"), "--lines"]
NOT_UNDERSTOOD = 2
FAILED = 1
INTERRUPTED = 130


def main(words):
    try:
        chosen, rest = options(words)
        status = subprocess.run([*PANEL, "--check", *rest]).returncode
        if status:
            return status
        if chosen.static is not None:
            static.build(Path(chosen.static), rest)
            return 0
        from tools.web import server  # its library is not loaded where nothing is served

        return asyncio.run(server.serve(chosen, [*PANEL, *rest]))
    except Misused as error:
        return complain(error, NOT_UNDERSTOOD)
    except OSError as error:
        return complain(error, FAILED)
    except KeyboardInterrupt:
        return INTERRUPTED


def complain(error, status):
    print("panel: %s" % error, file=sys.stderr)
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
