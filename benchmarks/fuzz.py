"""Damage files at random and read them: ``python benchmarks/fuzz.py [--seconds 600] [--seed 0] [--server]``.

Each reader gets files that kfmaps wrote with bytes changed, repeated, cut out, exchanged with those of another file,
or numbers replaced by unlikely ones. A reader may return something or raise InvalidInput with one line; anything else
is printed with the seed of the file, and the exit status is 1. With ``--server`` the landmark page's server gets
requests to all its routes that are damaged likewise or whose JSON is unlikely, and must go on to answer a good one.
"""

from __future__ import annotations

import argparse
import json
import resource
import socket
import sys
import tempfile
import threading
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from kfmaps._arrays import InvalidInput
from kfmaps.datasets import sphere
from kfmaps.io import (
    Values,
    grid_picture,
    load_map,
    read_landmark_names,
    read_landmarks,
    read_mesh_file,
    read_values,
    save_map,
    write_landmarks,
    write_mesh,
    write_textured,
    write_values,
)
from kfmaps.io.bake import encode_png
from kfmaps.io.named_points import read_named_points
from kfmaps.io.record import MeshFile
from kfmaps.matching.result import Match
from kfmaps.viz.picker import PickerServer
from kfmaps.viz.server import _LOOPBACK

MOST_MEMORY = 3 << 30
"""Bytes that the process may take; a file that wants more is an error."""
UNLIKELY = [b"-1", b"0", b"1e999", b"nan", b"4294967295", b"9" * 30, b"\x00", b"\xff" * 8, b'"', b"{}", b"[", b"#", b""]


def samples(folder: Path) -> dict[Path, Callable[[Path], Any]]:
    """Files of every kind that is read, with their readers."""
    mesh = sphere(100, rng=0)
    n = len(mesh.vertices)
    rng = np.random.default_rng(0)
    found: dict[Path, Callable[[Path], Any]] = {}
    for suffix in (".off", ".obj", ".ply", ".glb"):
        write_mesh(folder / f"a{suffix}", mesh, colors=rng.random((n, 3)))
        found[folder / f"a{suffix}"] = read_mesh_file
    picture = encode_png(grid_picture(16))
    shape = MeshFile(mesh, None, rng.random((n, 2)), mesh.faces, picture)
    for name in ("b.glb", "b.obj"):
        write_textured(folder / name, shape, mesh, np.arange(n))
        found[folder / name] = read_mesh_file
    triangles = np.zeros(len(mesh.faces), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attributes", "<u2")])
    triangles["corners"] = mesh.vertices[mesh.faces]
    (folder / "a.stl").write_bytes(bytes(80) + len(triangles).to_bytes(4, "little") + triangles.tobytes())
    rows = (" ".join(map(repr, row)) for row in mesh.vertices.tolist())
    (folder / "a.xyz").write_text("\n".join(rows))
    found |= {folder / "a.stl": read_mesh_file, folder / "a.xyz": read_mesh_file}
    write_landmarks(folder / "pairs.txt", np.arange(20).reshape(-1, 2), names=[f"point {i}" for i in range(10)])
    found[folder / "pairs.txt"] = lambda path: (read_landmarks(path), read_landmark_names(path))
    match = Match(np.arange(n), functional_map=rng.random((4, 4)), confidence=0.5, seconds={"solve": 1.0})
    for suffix in (".npz", ".mat", ".txt", ".vts"):
        save_map(folder / f"map{suffix}", match)
        found[folder / f"map{suffix}"] = load_map
    for suffix in (".npy", ".csv", ".txt"):
        for name, array in (("numbers", rng.random((n, 2))), ("labels", np.array([f"l{i}" for i in range(n)]))):
            write_values(folder / f"{name}{suffix}", Values(array))
            found[folder / f"{name}{suffix}"] = read_values
    (folder / "points.csv").write_text("name,vertex\n" + "".join(f"p{i},{i}\n" for i in range(20)))
    found[folder / "points.csv"] = lambda path: read_named_points(path, mesh)
    return found


def damaged(content: bytes, others: list[bytes], rng: np.random.Generator) -> bytes:
    """``content`` with one to eight changes."""
    data = bytearray(content)
    for _ in range(int(rng.integers(1, 9))):
        at, length = int(rng.integers(len(data) + 1)), int(rng.integers(1, 40))
        match int(rng.integers(7)):
            case 0 if at < len(data):
                data[at] = int(rng.integers(256))
            case 1:
                del data[at : at + length]
            case 2:
                data[at:at] = data[at : at + length] * int(rng.integers(1, 50))
            case 3:
                other = others[int(rng.integers(len(others)))]
                start = int(rng.integers(len(other)))
                data[at : at + length] = other[start : start + length]
            case 4:
                words = bytes(data).split(b" ")
                words[int(rng.integers(len(words)))] = UNLIKELY[int(rng.integers(len(UNLIKELY)))]
                data = bytearray(b" ".join(words))
            case 5:
                data[at : at + 4] = int(rng.choice([0, 1, 2**31 - 1, 2**31, 2**32 - 1])).to_bytes(4, "little")
            case _:
                data = data[:at] if rng.random() < 0.3 else data
    return bytes(data)


def fuzz_files(seconds: float, seed: int) -> int:
    """Damage and read files for so long; the number of errors that are none of a reader's own."""
    errors, counts = 0, Counter[str]()
    end = time.monotonic() + seconds
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        readers = samples(folder)
        contents = {path: path.read_bytes() for path in readers}
        while time.monotonic() < end:
            seed += 1
            rng = np.random.default_rng(seed)
            path = list(readers)[seed % len(readers)]
            path.write_bytes(damaged(contents[path], list(contents.values()), rng))
            try:
                readers[path](path)
                counts["read"] += 1
            except InvalidInput as error:
                counts["refused"] += 1
                if "\n" in str(error):
                    errors += 1
                    print(f"seed {seed}, {path.name}: a message of several lines")
            except (Exception, RecursionError):
                errors += 1
                print(f"seed {seed}, {path.name}:")
                traceback.print_exc(file=sys.stdout)
            path.write_bytes(contents[path])
    print(f"{sum(counts.values()) + errors:,} files: {dict(counts)}, {errors} errors; next seed {seed}")
    return errors


def unlikely_json(rng: np.random.Generator, depth: int = 0) -> Any:
    """A value that the page's script would not send, of lists and objects up to three deep."""
    leaves = [
        None,
        True,
        -1,
        0,
        3,
        10**30,
        0.5,
        1e308,
        "",
        "1",
        "\ud800",
        "a\tb",
        "x" * 5000,
        [],
        {},
        [[1, 2]],
        [[1, 1, 1]],
    ]
    kind = rng.integers(4) if depth < 3 else 0
    if kind < 2:
        return leaves[rng.integers(len(leaves))]
    some = [unlikely_json(rng, depth + 1) for _ in range(rng.integers(4))]
    keys = ["pairs", "names", "run", "overwrite", "else"]
    return some if kind == 2 else {keys[rng.integers(len(keys))]: value for value in some}


def fuzz_server(seconds: float, seed: int) -> int:
    """Send damaged requests for so long; the number of times that the server did not go on."""
    mesh = sphere(100, rng=0)
    errors, answers = 0, Counter[str]()
    same = Match(np.arange(len(mesh.vertices)), verdict="sure", confidence=0.99)
    routes = [
        "POST /{}/save",
        "POST /{}/match",
        "POST /{}/save-map",
        "POST /{}/cancel",
        "GET /{}/progress",
        "GET /{}/map",
    ]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        serving = PickerServer(
            mesh,
            mesh,
            ("a", "b"),
            folder / "p.txt",
            matcher=lambda _pairs, _progress: same,
            map_output=folder / "m.npz",
        )
        thread = threading.Thread(target=serving.serve_forever)
        thread.start()
        where, token = f"{_LOOPBACK}:{serving.port}", serving.token

        def request_to(route: str, data: Any) -> bytes:
            body = json.dumps(data)
            head = f"{route.format(token)} HTTP/1.1\r\nHost: {where}\r\nContent-Type: application/json\r\n"
            return f"{head}Content-Length: {len(body)}\r\n\r\n{body}".encode()

        good = request_to(routes[0], {"pairs": [[1, 2], [3, 4]]})
        head, _, body = good.partition(b"\r\n\r\n")
        head = head[: head.rindex(b"\r\n")]
        chunked = head + f"\r\nTransfer-Encoding: chunked\r\n\r\n{len(body):x}\r\n".encode() + body + b"\r\n0\r\n\r\n"
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            seed += 1
            rng = np.random.default_rng(seed)
            odd = request_to(routes[rng.integers(len(routes))], unlikely_json(rng))
            odd = odd if seed % 2 else damaged([good, chunked, odd][seed % 3], [good, chunked], rng)
            for request in (odd, good):
                with socket.create_connection((_LOOPBACK, serving.port), timeout=10) as connection:
                    connection.sendall(request)
                    connection.shutdown(socket.SHUT_WR)
                    try:
                        reply = connection.recv(4096)
                    except OSError as error:
                        reply = repr(error).encode()
                answers[reply[9:12].decode("latin-1")] += request is not good
                if (request is good and b" 200 " not in reply[:20]) or b" 500 " in reply[:20]:
                    errors += 1
                    print(f"seed {seed}: {request!r:.300} was answered {reply!r:.200}")
        serving.shutdown()
        thread.join()
        serving.close()
    print(f"{sum(answers.values()):,} requests, answered {dict(answers)}; {errors} errors; next seed {seed}")
    return errors


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=600)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--server", action="store_true")
    arguments = parser.parse_args()
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))
    warnings.simplefilter("ignore")
    fuzz = fuzz_server if arguments.server else fuzz_files
    return int(fuzz(arguments.seconds, arguments.seed) > 0)


if __name__ == "__main__":
    sys.exit(main())
