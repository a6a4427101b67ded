"""A web server for one page and one user: this machine only, behind a random token.

Any site open in the same browser can send requests to a local port. So a request must name this machine as
its ``Host`` (a foreign one is a name that was rebound to it), come from this page (``Origin``), and know the
token, which is in the address that only this program prints.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import secrets
import socket
import socketserver
import threading
import time
import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

from kfmaps._arrays import InvalidInput, refuse
from kfmaps.viz.pack import plain

LOOPBACK = "127.0.0.1"
LARGEST_REQUEST = 1 << 20
SECONDS_TO_SPEAK = 30.0
"""For a whole request and, again, for a whole answer: who sends a byte now and then is not waited for either."""
SECONDS_TO_LISTEN = 2.0
"""For what is left of a request that was refused before all of it was read."""

HEADERS = {
    "Cache-Control": "no-store",
    "Content-Security-Policy": "frame-ancestors 'none'",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
}


@dataclass(frozen=True)
class Reply:
    """An answer: its status, type and bytes."""

    status: int
    kind: str
    body: bytes


def page_reply(html: str) -> Reply:
    """A web page."""
    return Reply(200, "text/html; charset=utf-8", html.encode())


def json_reply(data: Any, status: int = 200) -> Reply:
    """Data for the page's script."""
    return Reply(status, "application/json", json.dumps(plain(data), allow_nan=False).encode())


Routes = Mapping[tuple[str, str], Callable[[Any], Reply]]
"""(method, name below the token) to a function of the request's JSON (``None`` for GET)."""


class LocalServer(ThreadingHTTPServer):
    """Serves ``routes`` at ``address`` until closed.

    Parameters
    ----------
    routes : mapping
        What is answered; everything else is refused. No file is ever read on a request.
    port : int
        0 takes any free one.
    """

    daemon_threads = True
    allow_reuse_address = os.name == "posix"  # elsewhere it would let two programs share a port
    request_queue_size = 256  # the system turns away who comes when as many wait to be let in

    def __init__(self, routes: Routes, port: int = 0) -> None:
        self.routes = routes
        self.token = secrets.token_urlsafe(24)
        self.changing = threading.Lock()  # requests that change something come one after another
        try:
            super().__init__((LOOPBACK, port), _Handler)
        except (OSError, OverflowError) as error:
            reason = getattr(error, "strerror", None) or str(error)
            raise refuse("port", "a free port of this machine", f"{port} ({reason})", "give another") from error

    def server_bind(self) -> None:
        """Bind without looking up the machine's name, which may ask the network and wait."""
        socketserver.TCPServer.server_bind(self)
        self.server_name, self.server_port = LOOPBACK, self.server_address[1]

    @property
    def origin(self) -> str:
        return f"http://{LOOPBACK}:{self.server_port}"

    @property
    def address(self) -> str:
        """Where the page is; whoever knows it can use it."""
        return f"{self.origin}/{self.token}/"

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Say nothing when a browser goes away in the middle of an answer."""


class _Until(io.RawIOBase):
    """What comes from a connection until a moment, and not a byte later."""

    def __init__(self, connection: socket.socket, seconds: float) -> None:
        self.connection, self.end = connection, time.monotonic() + seconds

    def readable(self) -> bool:
        return True

    def readinto(self, buffer: Any) -> int:
        left = self.end - time.monotonic()
        if left <= 0:
            raise TimeoutError("the request took too long")
        self.connection.settimeout(left)
        return self.connection.recv_into(buffer)


class _Handler(BaseHTTPRequestHandler):
    server_version = "kfmaps"
    sys_version = ""

    def setup(self) -> None:
        super().setup()
        self.rfile.close()
        self.rfile = io.BufferedReader(_Until(self.connection, SECONDS_TO_SPEAK))
        self.unread = 0

    @property
    def site(self) -> LocalServer:
        assert isinstance(self.server, LocalServer)
        return self.server

    def do_GET(self) -> None:
        self._answer("GET")

    def do_POST(self) -> None:
        self._answer("POST")

    def log_message(self, format: str, *args: Any) -> None:
        pass

    def _answer(self, method: str) -> None:
        length = self.headers.get("Content-Length", "")
        self.unread = int(length) if length.isascii() and length.isdigit() and len(length) < 19 else 0
        reply = self._reply(method)
        self.close_connection = True  # a body that was refused may be left unread
        self.connection.settimeout(SECONDS_TO_SPEAK)
        self.send_response(reply.status)
        for name, value in HEADERS.items():
            self.send_header(name, value)
        self.send_header("Content-Type", reply.kind)
        self.send_header("Content-Length", str(len(reply.body)))
        self.send_header("Connection", "close")
        self.end_headers()
        self.wfile.write(reply.body)
        self._listen()

    def _listen(self) -> None:
        """Take what is left of the request: closed with it unread, the connection would lose the answer as well."""
        if not 0 < self.unread <= LARGEST_REQUEST:
            return
        with contextlib.suppress(OSError):
            self.connection.shutdown(socket.SHUT_WR)
            rest = _Until(self.connection, SECONDS_TO_LISTEN)
            while rest.read(1 << 16):
                pass

    def _reply(self, method: str) -> Reply:
        refusal = self._foreign()
        if refusal:
            return json_reply({"error": refusal}, 403)
        token, _, name = self.path.partition("?")[0].lstrip("/").partition("/")
        if not secrets.compare_digest(token.encode(), self.site.token.encode()):
            return json_reply({"error": "the address lacks this program's token"}, 403)
        route = self.site.routes.get((method, name))
        if route is None:
            return json_reply({"error": "there is nothing here"}, 404)
        try:
            if method != "POST":
                return route(None)
            body = self._body()
            with self.site.changing:
                return route(body)
        except TimeoutError:
            return json_reply({"error": "the request took too long"}, 408)
        except InvalidInput as error:
            return json_reply({"error": str(error)}, 400)
        except OSError as error:
            return json_reply({"error": f"{error.filename or 'file'}: {error.strerror or error}"}, 500)
        except Exception as error:  # a defect: the page hears of it, the terminal where it was
            traceback.print_exc()
            return json_reply({"error": f"{type(error).__name__}: {error}"}, 500)

    def _foreign(self) -> str | None:
        """Why the request is not this page's own, if it is not."""
        port = self.site.server_port
        if self.headers.get_all("Host", []) not in ([f"{LOOPBACK}:{port}"], [f"localhost:{port}"]):
            return "the request was sent to another host's name"
        host = self.headers["Host"]
        if any(origin != f"http://{host}" for origin in self.headers.get_all("Origin", [])):
            return "the request comes from another site"
        if self.headers.get("Sec-Fetch-Site", "none") not in ("none", "same-origin"):
            return "the request comes from another site; type or paste the address instead"
        return None

    def _body(self) -> Any:
        # A plain form of another site cannot send this type without asking first.
        if self.headers.get_content_type() != "application/json":
            raise refuse("request", "JSON", self.headers.get_content_type(), "send application/json")
        length = self.headers.get("Content-Length", "")
        if not length.isascii() or not length.isdigit() or int(length) > LARGEST_REQUEST:
            raise refuse("request", f"at most {LARGEST_REQUEST} bytes", repr(length), "send fewer landmarks")
        try:
            content = self.rfile.read(int(length))
            self.unread = 0
            return json.loads(content)
        except (ValueError, RecursionError) as error:
            raise refuse("request", "JSON", "something else", "send application/json") from error
