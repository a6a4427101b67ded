"""A client of the local servers, which sends what it is told to send."""

from __future__ import annotations

import http.client
import json
import time
from dataclasses import dataclass
from typing import Any

from kfmaps.viz.server import _LOOPBACK, LocalServer


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
