"""Running the command in the tests, and small files to run it on."""

from __future__ import annotations

import io
import subprocess
import sys
import types
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from conftest import blob
from kfmaps.cli.main import main
from kfmaps.io import write_landmarks, write_mesh

SMALL = (
    *("--set", "basis.n_eigenfunctions=20", "--set", "descriptors.n_spectral=30", "--set", "nystrom.samples=60"),
    *("--set", "descriptors.n_eigenfunctions=40"),
    *("--set", "refinement.start=10", "--set", "refinement.stop=30", "--set", "refinement.samples=all"),
)
"""Settings that make a match of a few hundred vertices take a fraction of a second."""


@dataclass(frozen=True)
class Ran:
    """Exit status and what was written to both streams."""

    status: int
    stdout: str
    stderr: str

    @property
    def error(self) -> str:
        """The one line of complaint; anything else fails."""
        lines = self.stderr.splitlines()
        assert self.status == 2, (self.status, self.stdout, self.stderr)
        assert len(lines) == 1, self.stderr
        assert lines[0].startswith("kfmaps: error: ")
        assert self.stdout == ""
        return lines[0].removeprefix("kfmaps: error: ")


def run(*words: object) -> Ran:
    """The command in this process."""
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        status = main([str(word) for word in words])
    return Ran(status, out.getvalue(), err.getvalue())


def start(*words: object, folder: Path, **more: object) -> subprocess.Popen[str]:
    """The command in a process of its own, which Ctrl-C reaches even where a shell runs this in the background."""
    code = (
        "import signal, sys; signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "from kfmaps.cli.main import main; sys.exit(main())"
    )
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE} | more
    arguments = [sys.executable, "-c", code, *map(str, words)]
    return subprocess.Popen(arguments, cwd=folder, text=True, **pipes)  # pyright: ignore


def shapes(folder: Path, n: int = 300) -> types.SimpleNamespace:
    """A shape, the same turned and with its vertices in another order, the truth and six landmarks, in files.

    Vertex ``i`` of the target is vertex ``truth[i]`` of the source.
    """
    rng = np.random.default_rng(3)
    source = blob(n)
    truth = rng.permutation(n)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    turn = turn * np.sign(np.linalg.det(turn))
    target = type(source)(1000 * source.vertices[truth] @ turn.T + 5, np.argsort(truth)[source.faces])
    rows = np.arange(0, n, n // 6)[:6]
    found = types.SimpleNamespace(
        folder=folder,
        source=folder / "a.off",
        target=folder / "b.off",
        landmarks=folder / "pairs.txt",
        truth_source=folder / "a.vts",
        truth_target=folder / "b.vts",
        truth=truth,
        rows=rows,
        meshes=(source, target),
    )
    write_mesh(found.source, source)
    write_mesh(found.target, target)
    write_landmarks(found.landmarks, np.stack([truth[rows], rows], axis=1))
    found.truth_source.write_text("".join(f"{v + 1}\n" for v in truth))
    found.truth_target.write_text("".join(f"{v + 1}\n" for v in range(n)))
    return found
