"""A web server for one page and one user, on this machine only, behind a random token.

Any site open in the same browser can send requests to a local port. So a request must name this machine as its
``Host`` (another name was rebound to it), come from this page (``Origin``), and know the token. Only the address that
this program prints has the token.
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
_MAX_REQUEST = 1 << 20  # bytes of a request's body
_MAX_SECONDS = 30.0  # for the head of a request, for its body, and for the reply
_MAX_WAITING = 256  # connections that wait to be accepted; the system refuses more

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
    """A reply: its status, media type and bytes."""

    status: int
    kind: str
    body: bytes


def page_reply(html: str) -> Reply:
    """Return a web page as a reply."""
    return Reply(200, "text/html; charset=utf-8", html.encode())


def json_reply(data: object, status: int = 200) -> Reply:
    """Return data for the page's script as a reply."""
    return Reply(status, "application/json", json.dumps(to_json(data), allow_nan=False).encode())


_Routes = Mapping[tuple[str, str], Callable[[JsonObject], Reply]]
"""By (method, name below the token): a function of the request's JSON, which is empty for GET."""


class LocalServer:
    """A server that answers ``routes`` at ``address``, one request after another, and refuses all else.

    ``port``: 0 takes any free one. Nothing is answered before :meth:`serve_forever`.
    """

    def __init__(self, routes: _Routes, port: int = 0) -> None:
        self.routes = routes
        self.token = secrets.token_urlsafe(24)
        try:
            self._socket = socket.create_server((_LOOPBACK, port), backlog=_MAX_WAITING)
        except (OSError, OverflowError) as error:
            reason = getattr(error, "strerror", None) or str(error)
            raise refuse("port", "a free port of this machine", f"{port} ({reason})", "give another") from error
        self._socket.setblocking(False)
        self.port = self._socket.getsockname()[1]
        self._stopped: Future[None] = Future()

    @property
    def address(self) -> str:
        """The address of the page. Whoever knows it can use the page."""
        return f"http://{_LOOPBACK}:{self.port}/{self.token}/"

    def serve_forever(self) -> None:
        """Answer requests until :meth:`shutdown`, or until the user interrupts."""
        asyncio.run(self._serve())

    async def _serve(self) -> None:
        application = Application([(".*", _Handler, {"site": self})], log_function=lambda _: None)
        limits = {"idle_connection_timeout": _MAX_SECONDS, "body_timeout": _MAX_SECONDS}
        server = HTTPServer(application, no_keep_alive=True, max_body_size=_MAX_REQUEST, **limits)
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
        """Release the port. The server must have stopped."""
        self._socket.close()


class _Handler(RequestHandler):
    def initialize(self, site: LocalServer) -> None:
        self.site = site

    def set_default_headers(self) -> None:
        for name, value in _HEADERS.items():
            self.set_header(name, value)

    async def get(self) -> None:
        reply = self._reply()
        self.set_status(reply.status)
        self.set_header("Content-Type", reply.kind)
        _, pending = await asyncio.wait({self.finish(reply.body)}, timeout=_MAX_SECONDS)
        if pending:  # the client does not read the reply
            cast(HTTP1Connection, self.request.connection).close()

    post = get

    def write_error(self, status_code: int, **_: object) -> None:
        self.set_header("Content-Type", "application/json")
        self.finish(json.dumps({"error": responses.get(status_code, "the request cannot be answered")}))

    def _reply(self) -> Reply:
        refusal = self._refusal()
        if refusal:
            return json_reply({"error": refusal}, 403)
        token, _, name = self.request.path.lstrip("/").partition("/")
        if not secrets.compare_digest(token.encode(), self.site.token.encode()):
            return json_reply({"error": "the address lacks this program's token"}, 403)
        method = self.request.method or ""
        if self._is_cross_site() and not (method == "GET" and name == "" and self._is_navigation()):
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
        except Exception as error:  # a defect: the page shows the error, the terminal its traceback
            traceback.print_exc()
            return json_reply({"error": f"{type(error).__name__}: {error}"}, 500)

    def _refusal(self) -> str | None:
        """Return why the request cannot come from this page; ``None`` when it can."""
        hosts = self.request.headers.get_list("Host")
        if hosts not in ([f"{_LOOPBACK}:{self.site.port}"], [f"localhost:{self.site.port}"]):
            return "the request was sent to another host's name"
        if any(origin != f"http://{hosts[0]}" for origin in self.request.headers.get_list("Origin")):
            return "the request comes from another site"
        return None

    def _is_cross_site(self) -> bool:
        return self.request.headers.get("Sec-Fetch-Site", "none") not in ("none", "same-origin")

    def _is_navigation(self) -> bool:
        """Return whether a window opens the address, as from the file of :func:`forwarding_page`."""
        expected = {"Sec-Fetch-Mode": "navigate", "Sec-Fetch-Dest": "document"}
        return all(self.request.headers.get(name) == value for name, value in expected.items())

    def _json(self) -> JsonObject:
        # A plain form of another site cannot send this type without asking first.
        kind = self.request.headers.get("Content-Type", "none").partition(";")[0].strip().lower()
        if kind != "application/json":
            raise refuse("request", "JSON", kind, "send application/json")
        try:
            content = json.loads(self.request.body)
        except (ValueError, RecursionError) as error:
            raise refuse("request", "JSON", "something else", "send application/json") from error
        return content if isinstance(content, dict) else {}
