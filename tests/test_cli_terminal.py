"""What reaches the terminal, and what becomes of the command when its streams, its time or its disk end."""

from __future__ import annotations

import io
import resource
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from rich.text import Text

from commandline import SMALL, Ran, run, shapes
from conftest import blob
from kfmaps._arrays import printable, refuse
from kfmaps.cli.terminal import Terminal
from kfmaps.io import Values, atomic_output, save_map, write_mesh, write_values
from kfmaps.matching.result import Match

EVIL = "\x1b[31m\x1b]0;title\x07\r\x08\x9b2J\u202egnp\n\x7f"
"""Colours, a window's title, a bell, back over the line, a screen cleared, right to left, a line, delete."""


def check_plain(ran: Ran) -> None:
    for text in (ran.stdout, ran.stderr):
        assert all(line.isprintable() for line in text.split("\n")), text


def test_shown() -> None:
    assert printable("a 1 × 2 √ü") == "a 1 × 2 √ü"
    assert printable(EVIL).isprintable()
    assert printable("a\x1bb\n\u202e\udcff") == "a\\x1bb\\n\\u202e\\udcff"
    assert str(refuse(EVIL, EVIL, EVIL, EVIL)).isprintable()


def test_styles_stay_and_controls_do_not() -> None:
    stream = io.StringIO()
    console = Terminal(file=stream, force_terminal=True, color_system="standard", width=200)
    line = EVIL.replace("\n", "")
    console.print(Text(f"one {line}", style="red"), f"two {line}", markup=False, highlight=False)
    ours, reset, message = stream.getvalue().rstrip("\n").partition("\x1b[0m")
    assert (ours[:9], reset) == ("\x1b[31mone ", "\x1b[0m")
    assert (ours[9:] + message).isprintable()
    assert "\\x1b]0;title" in ours


def test_names_of_files(tmp_path: Path) -> None:
    made = shapes(tmp_path, 300)
    named = [tmp_path / f"{EVIL}{side}.off" for side in "ab"]
    for path, old in zip(named, (made.source, made.target), strict=True):
        path.write_bytes(old.read_bytes())
    odd = tmp_path / f"{EVIL}.obj"
    odd.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    output = tmp_path / f"{EVIL}m.npz"
    for words in (
        ("info", f"none{EVIL}.off"),
        ("info", named[0]),
        ("info", odd, EVIL),
        (EVIL,),
        *2 * [("match", *named, "--landmarks", made.landmarks, "--preset", "single-fit", *SMALL, "-o", output)],
        ("match", odd, odd, *SMALL, "-o", tmp_path / "m.npz"),
        ("match", *named, "--set", f"{EVIL}=1"),
        ("evaluate", output, "--identity", "--curve", f"{EVIL}.{EVIL}"),
        ("view", output, "--source", EVIL),
        ("batch", EVIL, "-o", EVIL),
    ):
        ran = run(*words)
        check_plain(ran)
        assert "x1b" in ran.stdout + ran.stderr or words[0] == "evaluate", words
    assert output.exists()


def test_words_inside_files(tmp_path: Path) -> None:
    (tmp_path / "a.ply").write_text(f"ply\nformat ascii 1.0\n{EVIL}\nend_header\n")
    np.savez(tmp_path / "m.npz", **{"\x1b[31m": np.arange(3)})  # pyright: ignore[reportArgumentType]
    (tmp_path / "l.txt").write_text("1 \x1b[31m\n")
    for words in (("info", tmp_path / "a.ply"), ("transfer", tmp_path / "m.npz", "x.txt", "-o", tmp_path / "o.txt")):
        check_plain(run(*words))
        assert run(*words).status == 2


@pytest.mark.parametrize("module", ["numpy", "kfmaps.cli.commands.info"])
def test_interrupted_while_importing(module: str, tmp_path: Path) -> None:
    """Ctrl-C comes in the middle of the import of ``module``."""
    code = (
        "import os, signal, sys\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "class Finder:\n"
        "    def find_spec(name, path=None, target=None):\n"
        f"        if name == {module!r}: os.kill(os.getpid(), signal.SIGINT)\n"
        "sys.meta_path.insert(0, Finder)\n"
        "sys.argv = ['kfmaps', 'info', 'a.off']\n"
        "from kfmaps.__main__ import main; sys.exit(main())"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.returncode in (-signal.SIGINT, 128 + signal.SIGINT)
    assert (done.stdout, done.stderr) == ("", "")


def in_shell(redirection: str, *words: object) -> subprocess.CompletedProcess[str]:
    code = f'exec "$0" -m kfmaps "$@" {redirection}'
    arguments = ["sh", "-c", code, sys.executable, *map(str, words)]
    return subprocess.run(arguments, capture_output=True, text=True, timeout=120)


def test_ended_from_outside_leaves_nothing(tmp_path: Path) -> None:
    code = (
        "import os, signal, sys, typer\n"
        "import kfmaps.cli.main\n"
        "from kfmaps.io import atomic_output\n"
        "def main():\n"
        "    with atomic_output('a.txt') as temporary:\n"
        "        os.kill(os.getpid(), signal.SIGTERM)\n"
        "kfmaps.cli.main.main = main\n"
        "from kfmaps.__main__ import main; sys.exit(main())"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stderr) == (128 + signal.SIGTERM, "")
    assert not list(tmp_path.iterdir())


def test_closed_streams(tmp_path: Path) -> None:
    write_mesh(tmp_path / "a.off", blob(30))
    done = in_shell(">&-", "info", tmp_path / "a.off")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    done = in_shell(">&- 2>&- <&-", "config", "-o", tmp_path / "a.toml")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert (tmp_path / "a.toml").read_text().startswith("# Settings")  # and nothing else was written into it


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full")
def test_output_that_is_full() -> None:
    done = in_shell(">/dev/full", "config")
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert "standard output: No space left on device" in done.stderr


@contextmanager
def largest_file(size: int) -> Iterator[None]:
    """As on a full disk: what is written beyond ``size`` fails."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


NUMBERS = np.random.default_rng(0).random(5000)
WRITERS: dict[str, Callable[[Path], object]] = {
    "a.npz": lambda path: save_map(path, Match(np.arange(5000), local_confidence=NUMBERS)),
    "a.mat": lambda path: save_map(path, Match(np.arange(5000), local_confidence=NUMBERS)),
    "a.txt": lambda path: save_map(path, Match(np.arange(5000))),
    "a.npy": lambda path: write_values(path, Values(NUMBERS)),
    "a.csv": lambda path: write_values(path, Values(NUMBERS)),
    "a.ply": lambda path: write_mesh(path, blob(500)),
    "a.off": lambda path: write_mesh(path, blob(500)),
}


@pytest.mark.parametrize("name", WRITERS)
def test_a_full_disk_is_told_with_the_file(tmp_path: Path, name: str) -> None:
    with largest_file(2000), pytest.raises(OSError) as caught:
        WRITERS[name](tmp_path / name)
    assert caught.value.filename == str(tmp_path / name)
    assert not list(tmp_path.iterdir())


def test_other_errors_keep_their_file(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError) as caught, atomic_output(tmp_path / "a.txt"):
        (tmp_path / "other").read_text()
    assert caught.value.filename == str(tmp_path / "other")


@pytest.mark.parametrize(
    "words",
    [
        ("match", "a.off", "a.off", "-o"),
        ("config", "-o"),
        ("transfer", "m.txt", "m.txt", "-o"),
        ("export", "m.txt", "-o"),
        ("view", "m.txt", "-o"),
        ("evaluate", "m.txt", "--identity", "--source", "a.off", "--curve"),
        ("landmarks", "a.off", "a.off", "--no-browser", "-o"),
        ("render", "pair", "m.txt", "-o"),
        ("demo", "-o"),
        ("batch", ".", "--pairs", "x", "-o"),
    ],
)
def test_no_command_writes_to_a_device(words: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write_mesh("a.off", blob(30))
    write_mesh("b.off", blob(30))
    Path("m.txt").write_text("".join(f"{i}\n" for i in range(30)))
    suffix = {"match": ".npz", "transfer": ".txt", "export": ".txt", "evaluate": ".csv", "render": ".png"}
    link = Path(f"link{suffix.get(words[0], '.png' if words[0] == 'demo' else '')}")
    link.symlink_to("/dev/null")
    force = () if words[0] == "batch" else ("--force",)
    assert run(*words, link, *force).error
    assert link.is_symlink()
    assert Path("/dev/null").is_char_device()


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="no devices here")
def test_settings_from_a_device_that_never_ends() -> None:
    assert "a device" in run("config", "--config", "/dev/zero").error
