# SPDX-License-Identifier: MIT
"""./tools/panel --join LINK: one more front end at a panel that `--web` serves.

It says on standard output what the panel says, and to the panel what comes on standard input: the
language of tools/live/README.md, a line each. In a terminal tools/panel puts the live panel before
it. The panel goes on when this ends. Exit status: 0; 1 if the panel is not there, lets nobody in
or ends; 2 for a wrong command line; 130 after Ctrl-C.
"""

import asyncio
import json
import os
import sys
from pathlib import Path
from urllib.parse import urlsplit

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP))

import aiohttp  # noqa: E402

from tools.web.options import Misused, Parser  # noqa: E402

NOT_UNDERSTOOD, FAILED, INTERRUPTED = 2, 1, 130
FORBIDDEN = 403
HEARTBEAT_S = 5  # as the server
SAID_MAX = 1 << 20  # of what the panel says at a time
NO_LINK = "--join %s: the link that --web prints, such as http://127.0.0.1:8080/#TOKEN"
OTHER_LINK = "take the link that it has printed"


class NotLetIn(Exception):
    """There is no panel, or it does not want us; the text says so."""


def link(words):
    """The address of its socket and its Origin. Misused: it is no link."""
    parser = Parser(add_help=False, allow_abbrev=False)
    parser.add_argument("--join", metavar="LINK", required=True)
    parser.add_argument("--lines", action="store_true")
    parser.add_argument("--check", action="store_true")
    chosen = parser.parse_args(words)
    parts = urlsplit(chosen.join)
    if parts.scheme != "http" or not parts.netloc or not parts.fragment:
        raise Misused(NO_LINK % chosen.join)
    address = "ws://%s/panel?token=%s" % (parts.netloc, parts.fragment)
    return address, "http://%s" % parts.netloc, chosen.check


async def join(address, origin):
    """Until either side has no more to say. Answers the exit status."""
    async with aiohttp.ClientSession() as session:
        try:
            connection = await session.ws_connect(
                address,
                headers={"Origin": origin},
                heartbeat=HEARTBEAT_S,
                max_msg_size=SAID_MAX,
            )
        except aiohttp.WSServerHandshakeError as refused:
            why = OTHER_LINK if refused.status == FORBIDDEN else refused.message
            raise NotLetIn("%s: the panel does not let you in: %s" % (origin, why)) from None
        except (aiohttp.ClientError, OSError):
            raise NotLetIn("%s: no panel is there" % origin) from None
        async with connection:
            speaks = asyncio.create_task(speak(connection))
            hears = asyncio.create_task(hear(connection))
            await asyncio.wait((speaks, hears), return_when=asyncio.FIRST_COMPLETED)
            if hears.done():
                speaks.cancel()
                hears.result()  # BrokenPipeError: nobody reads what the panel says
            if speaks.done():
                hears.cancel()
                return 0
            raise NotLetIn("%s: the panel has ended, or is out of reach" % origin)


async def speak(connection):
    """Standard input to the panel."""
    reader = asyncio.StreamReader(limit=SAID_MAX)
    loop = asyncio.get_running_loop()
    await loop.connect_read_pipe(lambda: asyncio.StreamReaderProtocol(reader), sys.stdin)
    while line := await reader.readline():
        await connection.send_str(line.decode("utf-8", "replace"))


async def hear(connection):
    """The panel to standard output. `joined`: it is not ours, and goes on without us."""
    async for message in connection:
        if message.type is not aiohttp.WSMsgType.TEXT:
            return
        for line in message.data.split("\n"):
            told = json.loads(line)
            if told["t"] == "hello":
                told["joined"] = 1
            sys.stdout.write(json.dumps(told) + "\n")
        sys.stdout.flush()


def main(words):
    try:
        address, origin, checks = link(words)
        return 0 if checks else asyncio.run(join(address, origin))
    except Misused as error:
        return complain(error, NOT_UNDERSTOOD)
    except NotLetIn as error:
        return complain(error, FAILED)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # for the flush at the end
        return FAILED
    except KeyboardInterrupt:
        return INTERRUPTED


def complain(error, status):
    print("panel: %s" % error, file=sys.stderr)
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
