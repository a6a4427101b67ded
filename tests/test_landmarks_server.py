"""The landmark picker's server: who is refused, and what the page can do."""

import http.client
import json
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, suppress
from dataclasses import replace
from html import unescape
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit
from urllib.request import url2pathname, urlopen

import numpy as np
import pytest
from tornado.http1connection import HTTP1Connection

from collecting import CONFIG
from commandline import run
from conftest import blob
from kfmaps._arrays import InvalidInput
from kfmaps._progress import Progress
from kfmaps.datasets import sphere
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import load_map, read_landmark_names, read_landmarks, write_landmarks, write_mesh
from kfmaps.matching.result import Match
from kfmaps.viz.picker import InteractiveMatcher, PickerServer, Runs
from kfmaps.viz.server import _LOOPBACK, LocalServer, page_reply
from serving import Client, answering

SOURCE, TARGET = sphere(200, rng=0), sphere(160, rng=1)
PAIRS = [[3, 5], [199, 159]]


Serve = Callable[..., Client]


@pytest.fixture
def serve(tmp_path: Path) -> Iterator[Serve]:
    with ExitStack() as running:

        def start(**changes: Any) -> Client:
            settings = {"names": ("a", "b"), "output": tmp_path / "pairs.txt"} | changes
            return running.enter_context(answering(PickerServer(SOURCE, TARGET, **settings)))

        yield start


# Who is refused -------------------------------------------------------------------------------------------


def test_listens_on_this_machine_only_by_long_tokens_that_differ(serve: Serve) -> None:
    clients = [serve() for _ in range(3)]
    assert len({client.path for client in clients}) == 3
    assert min(len(client.path) for client in clients) >= 32
    client = clients[0]
    assert client.get().status == 200
    # Loopback is all of 127.0.0.0/8; the server listens on one address of it, so not on every interface.
    with pytest.raises(OSError), socket.create_connection(("127.0.0.2", client.port), timeout=2):
        pass


@pytest.mark.parametrize("path", ["/", "", "/progress", "/x/", "/{token}x/", "/{short}/", "//{token}x/", "/%C3%A9/"])
def test_requests_without_the_token_are_refused(serve: Serve, tmp_path: Path, path: str) -> None:
    client = serve()
    token = client.path.strip("/")
    path = path.replace("{token}", token).replace("{short}", token[:-1])
    answer = client.ask("GET", path or "/")
    assert answer.status == 403
    assert token.encode() not in answer.body
    assert b"positions" not in answer.body
    body = json.dumps({"pairs": PAIRS}).encode()
    assert client.ask("POST", f"{path}save", body, {"Content-Type": "application/json"}).status == 403
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:{port}", "127.0.0.1", "127.0.0.1:1", "127.0.0.1.evil.example:{port}"]
)
def test_other_hosts_names_are_refused(serve: Serve, host: str) -> None:
    client = serve()
    assert client.ask("GET", client.path, host=host.replace("{port}", str(client.port))).status == 403
    for name in ("localhost", _LOOPBACK):
        own = f"{name}:{client.port}"
        assert client.ask("GET", client.path, headers={"Origin": f"http://{own}"}, host=own).status == 200


@pytest.mark.parametrize("origin", ["https://evil.example", "null", "http://127.0.0.1:1", "http://localhost:{port}"])
def test_other_origins_are_refused(serve: Serve, tmp_path: Path, origin: str) -> None:
    client = serve()
    origin = origin.replace("{port}", str(client.port))
    answer = client.post("save", {"pairs": PAIRS}, Origin=origin)
    assert answer.status == 403
    assert not (tmp_path / "pairs.txt").exists()


def test_requests_of_other_sites_are_refused_but_the_page_opens_from_the_file_with_its_address(serve: Serve) -> None:
    """A window that a file leads there comes from elsewhere, as browsers see it. It gets the page and nothing more."""
    client = serve()
    for site, status in (("cross-site", 403), ("same-site", 403), ("none", 200)):
        assert client.ask("GET", client.path, headers={"Sec-Fetch-Site": site}).status == status
    window = {"Sec-Fetch-Site": "cross-site", "Sec-Fetch-Mode": "navigate", "Sec-Fetch-Dest": "document"}
    assert client.ask("GET", client.path, headers=window).status == 200
    assert client.ask("GET", client.path + "progress", headers=window).status == 403
    assert client.ask("POST", client.path, b"{}", window | {"Content-Type": "application/json"}).status == 403
    assert client.ask("GET", client.path, headers=window | {"Sec-Fetch-Dest": "iframe"}).status == 403


@pytest.mark.parametrize(
    "name",
    ["../../etc/passwd", "..%2f..%2fetc/passwd", "a.off", "static/viewer.js", "pairs.txt", "/etc/passwd", "save"],
)
def test_no_file_can_be_read(serve: Serve, name: str) -> None:
    assert serve().get(name).status == 404


def test_other_methods_are_refused(serve: Serve) -> None:
    client = serve()
    for method in ("PUT", "DELETE", "OPTIONS", "HEAD"):
        assert client.ask(method, client.path).status == 405


def test_answers_are_not_kept_framed_or_sniffed(serve: Serve) -> None:
    headers = serve().get().headers
    assert headers["Cache-Control"] == "no-store"
    assert "frame-ancestors 'none'" in headers["Content-Security-Policy"]
    assert headers["X-Content-Type-Options"] == "nosniff"
    assert headers["Referrer-Policy"] == "no-referrer"
    assert "Access-Control-Allow-Origin" not in headers
    assert "Python" not in headers["Server"]


# What is refused inside -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "pairs",
    [
        *(None, "3 5", [[3]], [[3, 5, 1]], [[3, 160]], [[200, 5]], [[-1, 5]], [[3.0, 5]], [[True, 5]], [["3", 5]], {}),
        *([[3, 5], [3, 6]], [[3, 5], [4, 5]]),  # a vertex twice
    ],
)
def test_pairs_that_are_none_are_refused(serve: Serve, tmp_path: Path, pairs: Any) -> None:
    answer = serve().post("save", {"pairs": pairs})
    assert answer.status == 400
    assert answer.json["error"].startswith("landmarks")
    assert ": expected" in answer.json["error"]
    assert not (tmp_path / "pairs.txt").exists()


@pytest.mark.parametrize(
    ("body", "kind"),
    [
        (b"{", "application/json"),
        (b"\xff\xfe", "application/json"),
        (b"[" * 100000, "application/json"),
        (b'{"pairs": []}', "text/plain"),
        (b'{"pairs": []}', "application/x-www-form-urlencoded"),
    ],
)
def test_requests_that_are_no_json_are_refused(serve: Serve, body: bytes, kind: str) -> None:
    client = serve()
    answer = client.ask("POST", client.path + "save", body, {"Content-Type": kind})
    assert answer.status == 400
    assert answer.json["error"].startswith("request: expected")


@pytest.mark.parametrize("length", ["9" * 5000, "1" + "0" * 18, str((1 << 20) + 1), "-1", "x", "5, 6", ""])
def test_lengths_that_are_none_are_refused(serve: Serve, tmp_path: Path, length: str) -> None:
    client = serve()
    head = f"POST {client.path}save HTTP/1.1\r\nHost: {_LOOPBACK}:{client.port}\r\nContent-Type: application/json\r\n"
    with socket.create_connection((_LOOPBACK, client.port), timeout=60) as connection:
        connection.sendall(f"{head}Content-Length: {length}\r\n\r\n".encode())
        reply = b"".join(iter(lambda: connection.recv(4096), b""))
    assert reply.startswith(b"HTTP/1.1 400 ")
    assert b"Traceback" not in reply
    assert not list(tmp_path.iterdir())
    assert client.get().status == 200


# What the page can do -------------------------------------------------------------------------------------


def test_page_holds_the_landmarks_to_begin_with(serve: Serve) -> None:
    page = serve(landmarks=np.array(PAIRS)).get()
    assert page.headers["Content-Type"].startswith("text/html")
    assert f'"pairs":{json.dumps(PAIRS, separators=(",", ":"))}'.encode() in page.body
    assert "connect-src 'self'" in unescape(page.body.decode())


def test_saved_file_is_read_back(serve: Serve, tmp_path: Path) -> None:
    client, path = serve(), tmp_path / "pairs.txt"
    answer = client.post("save", {"pairs": PAIRS})
    assert (answer.status, answer.json) == (200, {"saved": str(path), "count": 2})
    assert read_landmarks(path).tolist() == PAIRS
    # What it wrote itself it replaces without asking.
    assert client.post("save", {"pairs": PAIRS[:1]}).status == 200
    assert read_landmarks(path).tolist() == PAIRS[:1]
    assert client.post("save", {"pairs": []}).json["count"] == 0
    assert [p.name for p in tmp_path.iterdir()] == ["pairs.txt"]


def test_existing_file_is_replaced_only_when_told(serve: Serve, tmp_path: Path) -> None:
    path = tmp_path / "pairs.txt"
    path.write_text("7 7\n")
    client = serve()
    answer = client.post("save", {"pairs": PAIRS})
    assert (answer.status, answer.json) == (409, {"exists": str(path)})
    assert path.read_text() == "7 7\n"
    assert client.post("save", {"pairs": PAIRS, "overwrite": 1}).status == 409
    assert client.post("save", {"pairs": PAIRS, "overwrite": True}).status == 200
    assert read_landmarks(path).tolist() == PAIRS
    assert serve(force=True).post("save", {"pairs": PAIRS[:1]}).status == 200
    assert read_landmarks(path).tolist() == PAIRS[:1]


def test_a_folder_that_went_away_is_told_in_words(serve: Serve, tmp_path: Path) -> None:
    answer = serve(output=tmp_path / "gone" / "pairs.txt").post("save", {"pairs": PAIRS})
    assert answer.status == 400
    assert "existing folder" in answer.json["error"]


def test_match_reports_progress_and_gives_its_map(serve: Serve) -> None:
    going, seen = threading.Event(), []

    def matcher(landmarks: np.ndarray, progress: Progress) -> Match:
        seen.append(landmarks.tolist())
        progress("solve", 0.25)
        assert going.wait(60)
        return Match(np.arange(160))

    client = serve(matcher=matcher)
    assert client.get("progress").json["state"] == "idle"
    assert client.get("map").status == 404
    assert client.post("match", {"pairs": PAIRS}).json["run"] == 1
    while client.get("progress").json["stage"] != "solve":
        time.sleep(0.01)
    status = client.get("progress").json
    assert (status["state"], status["fraction"]) == ("running", 0.25)
    again = client.post("match", {"pairs": PAIRS})
    assert again.status == 400
    assert "one run at a time" in again.json["error"]
    going.set()
    assert client.settled()["state"] == "done"
    record = client.get("map").json
    assert record["label"] == "2 landmarks"
    assert record["points"]["shape"] == record["confidence"]["shape"] == [160]
    assert seen == [PAIRS]
    assert client.post("match", {"pairs": PAIRS[:1]}).json["run"] == 2
    client.settled()
    assert client.get("map").json["label"] == "1 landmark"


def test_failure_of_a_match_is_told_in_words(serve: Serve) -> None:
    def refusing(_landmarks: np.ndarray, _progress: Progress) -> Match:
        raise InvalidInput("landmarks: expected <b>more</b>")

    def short(_landmarks: np.ndarray, _progress: Progress) -> Match:
        return Match(np.arange(3))

    for matcher, text in ((refusing, "<b>more</b>"), (short, "map: expected shape (160)")):
        client = serve(matcher=matcher)
        client.post("match", {"pairs": PAIRS})
        status = client.settled()
        assert status["state"] == "failed"
        assert text in status["error"]
        assert client.get("map").status == 404
    answer = serve().post("match", {"pairs": PAIRS})
    assert answer.status == 400
    assert "kfmaps match" in answer.json["error"]


def test_match_can_be_cancelled(serve: Serve) -> None:
    def endless(_landmarks: np.ndarray, progress: Progress) -> Match:
        while True:
            progress("solve", 0.5)
            time.sleep(0.001)

    client = serve(matcher=endless)
    client.post("match", {"pairs": PAIRS})
    client.post("cancel", {})
    assert client.settled()["state"] == "cancelled"


def test_defect_ends_the_run_and_is_shown(capsys: pytest.CaptureFixture[str]) -> None:
    runs = Runs(lambda _, __: 1 // 0)
    runs.start(None)
    while runs.status().state == "running":
        time.sleep(0.001)
    assert runs.status().error.startswith("ZeroDivisionError")
    assert "Traceback" in capsys.readouterr().err


def test_defect_in_an_answer_is_told_and_the_server_goes_on(capsys: pytest.CaptureFixture[str]) -> None:
    routes = {("GET", ""): lambda _: page_reply(""), ("GET", "bad"): lambda _: page_reply(None)}  # type: ignore[arg-type]
    with answering(LocalServer(routes)) as client:
        answer = client.get("bad")
        assert (answer.status, answer.json["error"][:14]) == (500, "AttributeError")
        assert client.get().status == 200
    assert "Traceback" in capsys.readouterr().err


def test_port_that_is_taken_is_refused_in_words(serve: Serve, tmp_path: Path) -> None:
    port = serve().port
    with pytest.raises(InvalidInput, match=f"^port: expected a free port of this machine, got {port}"):
        PickerServer(SOURCE, Mesh(TARGET.vertices, TARGET.faces), ("a", "b"), tmp_path / "p.txt", port=port)


@pytest.mark.usefixtures("interruptible")
@pytest.mark.skipif(os.name != "posix", reason="sends the signal that Ctrl-C is")
def test_command_serves_until_it_is_interrupted(tmp_path: Path) -> None:
    write_mesh(tmp_path / "a.off", SOURCE)
    write_mesh(tmp_path / "b.off", TARGET)
    write_landmarks(tmp_path / "old.txt", np.array(PAIRS))
    script = """
from kfmaps.cli.main import main
main(["landmarks", "a.off", "b.off", "--landmarks", "old.txt", "--no-browser"])
"""
    with subprocess.Popen(
        [sys.executable, "-c", script], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as running:
        try:
            assert running.stdout is not None
            address = running.stdout.readline().strip()
            assert address.startswith(f"http://{_LOOPBACK}:"), running.communicate()
            with urlopen(address, timeout=60) as page:
                assert f'"pairs":{json.dumps(PAIRS, separators=(",", ":"))}' in page.read().decode()
            running.send_signal(signal.SIGINT)
            said, complaints = running.communicate(timeout=60)
        finally:
            running.kill()
    assert (running.returncode, complaints) == (0, "")
    assert said.endswith("Ended.\n")
    with pytest.raises(OSError):
        urlopen(address, timeout=60)
    assert read_landmarks(tmp_path / "old.txt").tolist() == PAIRS


def test_the_browsers_command_line_does_not_have_the_address(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """All users of a machine see the list of its processes; the address is in a file that only one may read."""
    write_mesh(tmp_path / "a.off", SOURCE)
    opened: list[str] = []

    def browse(address: str) -> bool:
        path = Path(url2pathname(urlsplit(address).path))
        opened.extend([address, path.read_text(encoding="utf-8"), oct(path.parent.stat().st_mode & 0o777), str(path)])
        return True

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("webbrowser.open", browse)
    monkeypatch.setattr(LocalServer, "serve_forever", lambda _: None)
    done = run("landmarks", "a.off", "a.off")
    address = done.stdout.splitlines()[0]
    assert address.startswith(f"http://{_LOOPBACK}:")
    assert urlsplit(address).path.strip("/") not in opened[0]
    assert opened[0].startswith("file:")
    assert f"url={address}" in opened[1]
    assert opened[2] == "0o700" or os.name != "posix"
    assert not Path(opened[3]).exists()  # once the page is served no more


def test_names_are_saved_with_the_pairs_and_read_back(serve: Serve, tmp_path: Path) -> None:
    client = serve(output=tmp_path / "pairs.txt")
    names = ["left # hand\n\x1b[1m", "głowa"]
    assert client.post("save", {"pairs": PAIRS, "names": names}).status == 200
    assert read_landmarks(tmp_path / "pairs.txt").tolist() == PAIRS
    assert read_landmark_names(tmp_path / "pairs.txt") == ["left # hand [1m", "głowa"]
    for wrong in (0, {"a": 1}, ["one"], "no list", [1, 2], ["x" * 61, ""]):
        assert client.post("save", {"pairs": PAIRS, "names": wrong}).status == 400


def test_the_map_of_a_run_is_saved(serve: Serve, tmp_path: Path) -> None:
    """That of the run that is asked for; a file that was there before only after asking."""
    path = tmp_path / "m.npz"
    runs = iter((np.arange(160), np.arange(160)[::-1].copy()))
    client = serve(matcher=lambda *_: Match(next(runs)), map_output=path)
    assert client.post("save-map", {"run": 0}).status == 400
    for _ in range(2):
        client.post("match", {"pairs": PAIRS})
        client.settled()
    path.write_text("mine")
    assert client.post("save-map", {"run": 1}).status == 409
    assert path.read_text() == "mine"
    assert client.post("save-map", {"run": 1, "overwrite": True}).json["saved"] == str(path)
    assert load_map(path).target_to_source[0] == 159
    assert client.post("save-map", {"run": 0}).status == 200
    assert load_map(path).target_to_source[0] == 0
    for wrong in (2, -1, True, "0", None):
        assert client.post("save-map", {"run": wrong}).status == 400


# Who is slow, and who comes in crowds ---------------------------------------------------------------------


@pytest.mark.parametrize("opening", [b"", b"GET /", b"POST {path}save HTTP/1.1\r\nContent-Length: 900\r\n"])
def test_a_slow_sender_is_disconnected(serve: Serve, opening: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    """A request has so many seconds in all, however the bytes of it are spread."""
    monkeypatch.setattr("kfmaps.viz.server._MAX_SECONDS", 0.5)
    client = serve()
    with socket.create_connection((_LOOPBACK, client.port), timeout=60) as connection, suppress(ConnectionError):
        connection.sendall(opening.replace(b"{path}", client.path.encode()))
        connection.settimeout(0.05)
        while True:  # without an end where the server waits on
            connection.sendall(b"x")
            with suppress(TimeoutError):
                if connection.recv(4096) == b"":
                    break


def test_a_client_that_never_reads_is_disconnected(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("kfmaps.viz.server._MAX_SECONDS", 0.2)
    closed, close = threading.Event(), HTTP1Connection.close
    monkeypatch.setattr(HTTP1Connection, "close", lambda self: (close(self), closed.set()))
    server = LocalServer({("GET", ""): lambda _: page_reply("x" * (1 << 26))})
    with answering(server), socket.create_connection((_LOOPBACK, server.port), timeout=60) as connection:
        connection.sendall(f"GET /{server.token}/ HTTP/1.1\r\nHost: {_LOOPBACK}:{server.port}\r\n\r\n".encode())
        assert closed.wait(60)


def test_a_hundred_saves_at_once_are_all_answered(serve: Serve, tmp_path: Path) -> None:
    client = serve()
    ready = threading.Barrier(100)
    answers: list[int | str] = []

    def save(i: int) -> None:
        ready.wait()
        try:
            answers.append(client.post("save", {"pairs": [[i, i], [150, 150]]}).status)
        except OSError as error:
            answers.append(repr(error))

    threads = [threading.Thread(target=save, args=(i,)) for i in range(100)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert answers == [200] * 100
    assert len(read_landmarks(tmp_path / "pairs.txt")) == 2
    assert [path.name for path in tmp_path.iterdir()] == ["pairs.txt"]


def test_a_chunked_save_is_answered(serve: Serve) -> None:
    """A client that does not know the length before it sends says so, and is understood."""
    client, body = serve(), json.dumps({"pairs": PAIRS}).encode()
    headers = {"Content-Type": "application/json", "Transfer-Encoding": "chunked"}
    connection = http.client.HTTPConnection(_LOOPBACK, client.port, timeout=60)
    connection.request("POST", f"{client.path}save", iter([body]), headers, encode_chunked=True)
    assert connection.getresponse().status == 200
    connection.close()


def test_a_refusal_is_heard(serve: Serve) -> None:
    client = serve()
    answer = client.ask("POST", "/elsewhere/save", b"x" * 500000)
    assert (answer.status, "token" in answer.json["error"]) == (403, True)


# Matches that are run from the page -----------------------------------------------------------------------


def test_shapes_are_prepared_once_and_the_settings_are_used() -> None:
    landmark_vertices = np.array([[3, 3], [50, 50], [120, 120], [9, 9]])
    mesh = blob(300)
    config = replace(CONFIG, refinement=None)
    matcher = InteractiveMatcher((mesh, mesh), ("a", "b"), (Path("a.off"), Path("b.off")), config)
    stages: list[str] = []
    for some in (landmark_vertices, landmark_vertices[:3]):
        found = matcher(some, lambda stage, done: stages.append(stage) if done == 1 else None)
        np.testing.assert_array_equal(found.target_to_source, np.arange(300))
        np.testing.assert_array_equal(found.landmarks, some)
        assert (found.n_source, found.source_file.path) == (300, str(Path("a.off").absolute()))
    assert [stages.count(f"eigenfunctions of {name}") for name in "ab"] == [1, 1]
    assert stages.count("descriptors") == 2
    assert "refinement" not in stages


def test_bad_settings_are_told_before_the_page(tmp_path: Path) -> None:
    write_mesh(tmp_path / "a.off", SOURCE)
    words = [tmp_path / "a.off", tmp_path / "a.off", "-o", tmp_path / "p.txt", "--no-browser"]
    assert "cubic" in run("landmarks", *words, "--kernel", "cubic").error
