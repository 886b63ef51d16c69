# SPDX-License-Identifier: MIT
"""Serves the page, and joins each page to the one panel that runs behind it.

    status = await serve(chosen, ["tools/panel", "--lines"])

A page has a WebSocket, on which it and the panel say what tools/live/README.md lists. What the
page says is a message each; what the panel says comes in lines, for a page takes one message with
many of them sooner than many messages. Who has not got the token of the link, or comes from
another site, is not let in. Whatever else a page does, the panel and the other pages go on:
messages are short, a page that does not read hears less, and one that talks too much is thrown
out.
"""

import asyncio
import hmac
import ipaddress
import json
import secrets
import signal
import socket
import sys
import time
from collections import OrderedDict, deque
from urllib.parse import urlsplit

from aiohttp import WSCloseCode, WSMsgType, web

from tools.live.hub import Hub
from tools.live.language import LINE_MAX
from tools.web.files import PAGE, TYPES, served

TOKEN_BYTES = 16
PAGES_MAX = 16
MESSAGES_A_SECOND = 200
TOGETHER_S = 0.02  # what the panel says within this time goes together; a key does not wait
HEARTBEAT_S = 5  # keys have a lease of their own: this finds connections that are dead
EVENTS_MAX = 256  # telegrams and answers that wait for a page that does not read
# Kinds of which only the newest counts.
PICTURES = ("hello", "state", "time", "drives", "count", "broken")

SECURITY = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; "
    "img-src 'self' data:; connect-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "Cache-Control": "no-cache",
}
ENDED = "the panel has ended"
ELSEWHERE = "192.0.2.1", 9  # an address that nobody has (RFC 5737)
TOO_MUCH = "more than %d messages a second" % MESSAGES_A_SECOND


class Outbox:
    """What a page is still to hear. If it does not keep up, the newest picture is enough."""

    def __init__(self):
        self._pictures = OrderedDict()
        self._events = deque(maxlen=EVENTS_MAX)
        self._filled = asyncio.Event()

    def put(self, message):
        kind = message["t"]
        if kind in PICTURES:
            self._pictures[kind] = message
            self._pictures.move_to_end(kind)
        else:
            self._events.append(message)
        self._filled.set()

    async def get(self):
        """All that waits, at least one message."""
        await self._filled.wait()
        self._filled.clear()
        found = [*self._pictures.values(), *self._events]
        self._pictures.clear()
        self._events.clear()
        return found


class Allowance:
    """How many messages a page may still send in this second."""

    def __init__(self):
        self._began_s = time.monotonic()
        self._count = 0

    def takes(self):
        now_s = time.monotonic()
        if now_s - self._began_s >= 1:
            self._began_s, self._count = now_s, 0
        self._count += 1
        return self._count <= MESSAGES_A_SECOND


class Server:
    """hub: a `Hub` that runs. bind: the address that is served."""

    def __init__(self, hub, bind):
        self.token = secrets.token_urlsafe(TOKEN_BYTES)
        self.app = web.Application()
        self.app.router.add_get("/panel", self._panel)
        self.app.router.add_get("/{name:.*}", self._file)
        self.app.on_shutdown.append(self._close)
        self._hub = hub
        self._names = {"localhost", bind, socket.gethostname().lower()}
        self._sockets = set()

    # --- the page -------------------------------------------------------------------------------

    async def _file(self, request):
        if not self._is_ours(request.host):
            raise web.HTTPForbidden(text="this is not the address of the panel\n")
        path = served(request.match_info["name"] or PAGE)
        if path is None:
            raise web.HTTPNotFound()
        headers = dict(SECURITY)
        headers["Content-Type"] = TYPES[path.suffix]
        return web.Response(body=path.read_bytes(), headers=headers)

    # --- its connection -------------------------------------------------------------------------

    async def _panel(self, request):
        self._admit(request)
        connection = web.WebSocketResponse(
            max_msg_size=LINE_MAX, heartbeat=HEARTBEAT_S, compress=False
        )
        await connection.prepare(request)
        self._sockets.add(connection)
        outbox = Outbox()
        seat = self._hub.join(outbox.put)
        sender = asyncio.create_task(self._send(connection, outbox))
        try:
            await self._listen(connection, seat)
        finally:
            seat.leave()
            sender.cancel()
            self._sockets.discard(connection)
        return connection

    def _admit(self, request):
        """HTTPForbidden: not this one."""
        origin = urlsplit(request.headers.get("Origin", ""))
        # Whoever shows a page from elsewhere cannot change these headers of a browser.
        if not self._is_ours(request.host) or origin.netloc != request.host:
            raise web.HTTPForbidden(text="from another site\n")
        token = request.query.get("token", "")
        if not hmac.compare_digest(token.encode(), self.token.encode()):
            raise web.HTTPForbidden(text="a wrong token\n")
        if len(self._sockets) >= PAGES_MAX:
            raise web.HTTPServiceUnavailable(text="%d pages are enough\n" % PAGES_MAX)

    def _is_ours(self, host):
        """Whether a Host is an address or a name of this machine, not one that somebody else has
        pointed here."""
        name = urlsplit("//" + host).hostname or ""
        try:
            ipaddress.ip_address(name)
        except ValueError:
            return name in self._names
        return True

    async def _listen(self, connection, seat):
        allowance = Allowance()
        async for message in connection:
            if message.type is not WSMsgType.TEXT:
                return
            if not allowance.takes():
                await connection.close(
                    code=WSCloseCode.POLICY_VIOLATION, message=TOO_MUCH.encode()
                )
                return
            try:
                said = json.loads(message.data)
            except (ValueError, RecursionError):
                said = None
            # What is no object is the panel's to refuse as well, with the seat's id on it.
            seat.say(said if isinstance(said, dict) else {})

    async def _send(self, connection, outbox):
        try:
            while True:
                await connection.send_str("\n".join(map(json.dumps, await outbox.get())))
                await asyncio.sleep(TOGETHER_S)
        except (ConnectionError, RuntimeError):
            pass  # it is gone

    async def _close(self, _app):
        for connection in list(self._sockets):
            await connection.close(code=WSCloseCode.GOING_AWAY, message=ENDED.encode())


async def serve(chosen, command):
    """Until the panel ends, or somebody ends this. Answers the panel's exit status."""
    loop = asyncio.get_running_loop()
    asked = asyncio.Event()
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        loop.add_signal_handler(number, asked.set)
    hub = Hub(command)
    await hub.start()
    server = Server(hub, chosen.bind)
    runner = web.AppRunner(server.app, handle_signals=False, access_log=None)
    try:
        await runner.setup()
        site = web.TCPSite(runner, chosen.bind, chosen.web_port, shutdown_timeout=1)
        await site.start()
        say(link(runner.addresses[0], server.token))
        await asyncio.wait(
            [asyncio.ensure_future(asked.wait()), asyncio.shield(hub.ended)],
            return_when=asyncio.FIRST_COMPLETED,
        )
    finally:
        status = await hub.end()
        await runner.cleanup()
    return status


def link(address, token):
    """What a browser is to open. The part behind # is never sent anywhere: the page reads it."""
    host, port = address[:2]
    if ipaddress.ip_address(host).is_unspecified:
        host = own_address() or socket.gethostname()
    host = "[%s]" % host if ":" in host else host
    return "http://%s:%d/#%s" % (host, port, token)


def own_address():
    """The address of this machine in its network: a telephone there knows no name of it. "": none.
    Nothing is sent: a datagram's socket only looks up the way."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as asked:
        try:
            asked.connect(ELSEWHERE)
        except OSError:
            return ""
        return asked.getsockname()[0]


def say(line):
    print("USS panel: %s" % line, flush=True)
    print("panel: Ctrl-C ends it; it stops every drive first", file=sys.stderr, flush=True)
