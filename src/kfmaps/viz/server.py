"""A web server for one page and one user: this machine only, behind a random token.

Any site open in the same browser can send requests to a local port. So a request must name this machine as
its ``Host`` (a foreign one is a name that was rebound to it), come from this page (``Origin``), and know the
token, which is in the address that only this program prints.
"""

from __future__ import annotations

import asyncio
import json
import secrets
import socket
import traceback
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import dataclass
from http.client import responses
from typing import cast

from tornado.http1connection import HTTP1Connection
from tornado.httpserver import HTTPServer
from tornado.web import Application, RequestHandler

from kfmaps._arrays import InvalidInput, refuse
from kfmaps._records import JsonObject
from kfmaps.viz.document import to_json

_LOOPBACK = "127.0.0.1"
_LARGEST_REQUEST = 1 << 20  # bytes of a request's body
_MAX_SECONDS = 30.0  # for the head of a request, its body and the answer each, however the bytes are spread
_WAITING_CONNECTIONS = 256  # the system turns away who comes when as many wait to be let in

_HEADERS = {
    "Cache-Control": "no-store",
    "Content-Security-Policy": "frame-ancestors 'none'",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "Server": "kfmaps",
    "X-Content-Type-Options": "nosniff",
}


@dataclass(frozen=True)
class Reply:
    """An answer: its status, type and bytes."""

    status: int
    kind: str
    body: bytes


def page_reply(html: str) -> Reply:
    """Return the answer that is a web page."""
    return Reply(200, "text/html; charset=utf-8", html.encode())


def json_reply(data: object, status: int = 200) -> Reply:
    """Return the answer that is data for the page's script."""
    return Reply(status, "application/json", json.dumps(to_json(data), allow_nan=False).encode())


_Routes = Mapping[tuple[str, str], Callable[[JsonObject], Reply]]
"""(method, name below the token) to a function of the request's JSON (``None`` for GET)."""


class LocalServer:
    """Answer ``routes`` at ``address`` until stopped, one request after another.

    ``routes``: what is answered; everything else is refused. No file is ever read on a request. ``port``: 0 takes any
    free one.
    """

    def __init__(self, routes: _Routes, port: int = 0) -> None:
        self.routes = routes
        self.token = secrets.token_urlsafe(24)
        try:
            self._socket = socket.create_server((_LOOPBACK, port), backlog=_WAITING_CONNECTIONS)
        except (OSError, OverflowError) as error:
            reason = getattr(error, "strerror", None) or str(error)
            raise refuse("port", "a free port of this machine", f"{port} ({reason})", "give another") from error
        self._socket.setblocking(False)
        self.port = self._socket.getsockname()[1]
        self._stopped: Future[None] = Future()

    @property
    def address(self) -> str:
        """Where the page is. Whoever knows it can use the page."""
        return f"http://{_LOOPBACK}:{self.port}/{self.token}/"

    def serve_forever(self) -> None:
        """Answer requests until :meth:`shutdown`, or until the user interrupts."""
        asyncio.run(self._serve())

    async def _serve(self) -> None:
        application = Application([(".*", _Handler, {"site": self})], log_function=lambda _: None)
        limits = {"idle_connection_timeout": _MAX_SECONDS, "body_timeout": _MAX_SECONDS}
        server = HTTPServer(application, no_keep_alive=True, max_body_size=_LARGEST_REQUEST, **limits)
        server.add_socket(self._socket)
        try:
            await asyncio.wrap_future(self._stopped)
        finally:
            server.stop()
            await server.close_all_connections()

    def shutdown(self) -> None:
        """End :meth:`serve_forever`, from another thread."""
        self._stopped.set_result(None)

    def close(self) -> None:
        """Give the port back. The server must not be answering any more."""
        self._socket.close()


class _Handler(RequestHandler):
    def initialize(self, site: LocalServer) -> None:
        self.site = site

    def set_default_headers(self) -> None:
        for name, value in _HEADERS.items():
            self.set_header(name, value)

    async def get(self) -> None:
        answer = self._reply()
        self.set_status(answer.status)
        self.set_header("Content-Type", answer.kind)
        _, slow = await asyncio.wait({self.finish(answer.body)}, timeout=_MAX_SECONDS)
        if slow:  # who does not read the answer is not waited for
            cast(HTTP1Connection, self.request.connection).close()

    post = get

    def write_error(self, status_code: int, **_: object) -> None:
        self.set_header("Content-Type", "application/json")
        self.finish(json.dumps({"error": responses.get(status_code, "the request cannot be answered")}))

    def _reply(self) -> Reply:
        refusal = self._foreign()
        if refusal:
            return json_reply({"error": refusal}, 403)
        token, _, name = self.request.path.lstrip("/").partition("/")
        if not secrets.compare_digest(token.encode(), self.site.token.encode()):
            return json_reply({"error": "the address lacks this program's token"}, 403)
        method = self.request.method or ""
        if self._from_other_site() and not (method == "GET" and name == "" and self._is_navigation()):
            return json_reply({"error": "the request comes from another site"}, 403)
        route = self.site.routes.get((method, name))
        if route is None:
            return json_reply({"error": "there is nothing here"}, 404)
        try:
            return route(self._json() if method == "POST" else {})
        except InvalidInput as error:
            return json_reply({"error": str(error)}, 400)
        except OSError as error:
            return json_reply({"error": f"{error.filename or 'file'}: {error.strerror or error}"}, 500)
        except Exception as error:  # a defect: the page hears of it, the terminal where it was
            traceback.print_exc()
            return json_reply({"error": f"{type(error).__name__}: {error}"}, 500)

    def _foreign(self) -> str | None:
        """Why the request does not come from this page; ``None`` when it does."""
        hosts = self.request.headers.get_list("Host")
        if hosts not in ([f"{_LOOPBACK}:{self.site.port}"], [f"localhost:{self.site.port}"]):
            return "the request was sent to another host's name"
        if any(origin != f"http://{hosts[0]}" for origin in self.request.headers.get_list("Origin")):
            return "the request comes from another site"
        return None

    def _from_other_site(self) -> bool:
        return self.request.headers.get("Sec-Fetch-Site", "none") not in ("none", "same-origin")

    def _is_navigation(self) -> bool:
        """Whether a window opens the address, as from the file that holds it (:func:`forwarding_page`)."""
        wanted = {"Sec-Fetch-Mode": "navigate", "Sec-Fetch-Dest": "document"}
        return all(self.request.headers.get(name) == value for name, value in wanted.items())

    def _json(self) -> JsonObject:
        # A plain form of another site cannot send this type without asking first.
        kind = self.request.headers.get("Content-Type", "none").partition(";")[0].strip().lower()
        if kind != "application/json":
            raise refuse("request", "JSON", kind, "send application/json")
        try:
            told = json.loads(self.request.body)
        except (ValueError, RecursionError) as error:
            raise refuse("request", "JSON", "something else", "send application/json") from error
        return told if isinstance(told, dict) else {}
