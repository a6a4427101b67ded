"""A local server that answers, a client that sends what it is told to send, and what stands in a page."""

from __future__ import annotations

import http.client
import json
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from html.parser import HTMLParser
from threading import Thread
from typing import Any

from kfmaps.viz.server import _LOOPBACK, LocalServer


@contextmanager
def answering(server: LocalServer) -> Iterator[Client]:
    """A client of a server, which answers from another thread."""
    with closing(server):
        thread = Thread(target=server.serve_forever)
        thread.start()
        try:
            yield Client(server)
        finally:
            server.shutdown()
            thread.join()


class Page(HTMLParser):
    """Elements of a page with their attributes, and the texts in the elements of each name."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.text: dict[str, list[str]] = {}
        self._inside = ""
        self.feed(html)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        self._inside = tag
        self.text.setdefault(tag, []).append("")

    def handle_endtag(self, tag: str) -> None:
        self._inside = self._inside if self._inside != tag else ""

    def handle_data(self, data: str) -> None:
        self.text.setdefault(self._inside, [""])[-1] += data


def page_data(html: str) -> Any:
    """What a page shows, as it is written into it."""
    return json.loads(Page(html).text["script"][0])


@dataclass
class Answer:
    status: int
    headers: dict[str, str]
    body: bytes

    @property
    def json(self) -> Any:
        return json.loads(self.body)


class Client:
    def __init__(self, server: LocalServer) -> None:
        self.port = server.port
        self.path = f"/{server.token}/"

    def ask(
        self,
        method: str,
        path: str,
        body: bytes | None = None,
        headers: dict[str, str] | None = None,
        host: str | None = None,
    ) -> Answer:
        connection = http.client.HTTPConnection(_LOOPBACK, self.port, timeout=60)
        try:
            connection.putrequest(method, path, skip_host=True)
            connection.putheader("Host", host or f"{_LOOPBACK}:{self.port}")
            for name, value in (headers or {}).items():
                connection.putheader(name, value)
            if body is not None:
                connection.putheader("Content-Length", str(len(body)))
            connection.endheaders(body)
            reply = connection.getresponse()
            return Answer(reply.status, dict(reply.getheaders()), reply.read())
        finally:
            connection.close()

    def get(self, name: str = "") -> Answer:
        return self.ask("GET", self.path + name)

    def post(self, name: str, data: Any, **headers: str) -> Answer:
        kind = {"Content-Type": "application/json"}
        return self.ask("POST", self.path + name, json.dumps(data).encode(), kind | headers)

    def settled(self) -> dict[str, Any]:
        """The status of the run once it is no longer running."""
        for _ in range(6000):
            status = self.get("progress").json
            if status["state"] != "running":
                return status
            time.sleep(0.01)
        raise AssertionError("the run does not end")
