"""The command as a whole: its list, its one-line complaints, its exit statuses."""

from __future__ import annotations

import errno
import importlib
import os
import platform
import signal
import subprocess
import sys
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import typer

import kfmaps
from commandline import Ran, run, shapes, start
from kfmaps._arrays import InvalidInput, KfmapsWarning, MissingDependency, NotConverged
from kfmaps.cli import main as cli
from kfmaps.cli.main import COMMANDS
from kfmaps.cli.options import _PANEL, meets

HEAVY = ("numpy", "scipy", "matplotlib", "torch", "trimesh", "robust_laplacian", "distributed")


def stubbed(monkeypatch: pytest.MonkeyPatch, raised: BaseException) -> None:
    """Make ``kfmaps info`` raise."""

    def info() -> None:
        raise raised

    module = importlib.import_module("kfmaps.cli.commands.info")
    monkeypatch.setattr(module, "info", info)


def test_version() -> None:
    assert run("--version").stdout == f"kfmaps {kfmaps.__version__}\n"
    module = subprocess.run([sys.executable, "-m", "kfmaps", "--version"], capture_output=True, text=True, check=True)
    assert module.stdout == f"kfmaps {kfmaps.__version__}\n"


def test_all_commands_are_listed() -> None:
    """Every module in app.commands is in the list, and the list names nothing else."""
    folder = Path(cli.__file__).parent / "commands"
    assert {path.stem for path in folder.glob("*.py") if not path.stem.startswith("_")} == set(COMMANDS)
    shown = run("--help").stdout
    for name, does in COMMANDS.items():
        assert f" {name} " in shown
        assert does[:20] in shown
    assert run().stdout == shown


@pytest.mark.parametrize("name", COMMANDS)
def test_help_of_each(name: str) -> None:
    """What the list says of a command without importing it is what the command says of itself."""
    help = run(name, "--help")
    assert help.status == 0
    module = importlib.import_module(f"kfmaps.cli.commands.{name}")
    own = module.app.info.help if hasattr(module, "app") else getattr(module, name).__doc__
    assert COMMANDS[name] == own.partition("\n")[0]
    assert " ".join(COMMANDS[name].split()[:4]) in " ".join(help.stdout.split())


def test_h_is_help() -> None:
    for words in ((), ("info",), ("render", "pair")):
        assert run(*words, "-h").stdout == run(*words, "--help").stdout != ""


def test_list_imports_nothing_heavy() -> None:
    code = "import sys; from kfmaps.cli.main import main; main(['--help']); print(*sys.modules, file=sys.stderr)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = {name.partition(".")[0] for name in done.stderr.split()}
    assert "typer" in loaded
    assert not loaded & set(HEAVY)


def leaves(command: Any, name: str = "") -> Iterator[tuple[str, Any]]:
    """Every command and subcommand with its words."""
    if not hasattr(command, "commands"):
        yield name.strip(), command
        return
    for inner, one in command.commands.items():
        yield from leaves(one, f"{name} {inner}")


LEAVES = dict(leaves(typer.main.get_command(cli.application())))


@pytest.mark.parametrize("name", LEAVES)
def test_a_command_has_few_options_and_speaks_json(name: str) -> None:
    """At most ten of its own, beside those of every command and ten for settings; all else is said with --set."""
    assert any("--json" in p.opts for p in LEAVES[name].params)
    panels = [getattr(p, "rich_help_panel", None) for p in LEAVES[name].params if p.opts[0].startswith("-")]
    assert panels.count(None) <= 10 + 1  # --help
    assert panels.count("Settings") <= 10
    assert set(panels) <= {None, "Settings", _PANEL}


def test_required_verdicts() -> None:
    assert [meets(word, "likely") for word in ("sure", "likely", "ambiguous", "unlikely")] == [
        True,
        True,
        False,
        False,
    ]
    assert [meets(word, "sure") for word in ("sure", "likely", "landmarks", "unchecked", "")] == [True] + 4 * [False]
    assert meets("unlikely", None)
    assert "--require: expected sure or likely" in run("match", "a.off", "b.off", "--require", "good").error
    assert "--require: expected sure or likely" in run("batch", "a", "-o", "b", "--require", "good").error


@pytest.mark.parametrize(
    ("words", "output"),
    [
        (["matsch"], "No such command 'matsch'"),
        (["info"], "Missing argument 'MESH'; see kfmaps info --help"),
        (["info", "--yaml", "x"], "--yaml"),
        (["info", "a", "--rank", "3"], "No such option"),
        (["match", "a.off", "b.off", "--threads", "many"], "--threads"),
        (["view", "a.npz", "b.npz"], "unexpected extra argument"),
        (["match", "a.ply", "b.ply", "--set"], "Option '--set' requires"),
        (["evaluate", "m", "--truth", "a"], "Option '--truth' requires"),
    ],
)
def test_usage_is_one_line(words: list[str], output: str) -> None:
    assert output in run(*words).error


@pytest.mark.parametrize(
    ("raised", "output"),
    [
        (InvalidInput("expected\nthis"), "expected this"),
        (MissingDependency("no PyTorch"), "no PyTorch"),
        (NotConverged("not there yet"), "not there yet"),
        (MemoryError(), "not enough memory"),
        (OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), "out.npz"), "out.npz: No space left on device"),
        (OSError("odd"), "odd"),
    ],
)
def test_failures_are_one_line(raised: Exception, output: str, monkeypatch: pytest.MonkeyPatch) -> None:
    stubbed(monkeypatch, raised)
    assert output in run("info").error


def test_a_defect_keeps_its_traceback(monkeypatch: pytest.MonkeyPatch) -> None:
    """Only what a user can do something about is told in one line."""
    stubbed(monkeypatch, ZeroDivisionError())
    with pytest.raises(ZeroDivisionError):
        run("info")


@pytest.mark.parametrize(("raised", "status"), [(KeyboardInterrupt(), 130), (typer.Abort(), 130), (typer.Exit(7), 7)])
def test_how_a_command_ends_quietly(raised: BaseException, status: int, monkeypatch: pytest.MonkeyPatch) -> None:
    stubbed(monkeypatch, raised)
    assert run("info") == Ran(status, "", "")


def test_warnings_are_one_line_each_and_not_repeated(monkeypatch: pytest.MonkeyPatch) -> None:
    def info() -> None:
        for text in ("odd\nthing", "odd\nthing", "another"):
            warnings.warn(text, KfmapsWarning, stacklevel=1)

    monkeypatch.setattr(importlib.import_module("kfmaps.cli.commands.info"), "info", info)
    before = list(warnings.filters), warnings.showwarning
    assert run("info") == Ran(0, "", "kfmaps: warning: odd thing\nkfmaps: warning: another\n")
    assert (list(warnings.filters), warnings.showwarning) == before


def test_closed_pipe_is_silent(tmp_path: Path) -> None:
    """``kfmaps config | head -0``: the reader goes away before anything is written."""
    process = start("config", folder=tmp_path)
    assert process.stdout is not None
    assert process.stderr is not None
    process.stdout.close()
    output = process.stderr.read()
    process.stderr.close()
    assert process.wait(60) == cli.UNREAD
    assert output == ""


def test_interrupted_match_leaves_nothing(tmp_path: Path) -> None:
    made = shapes(tmp_path, 3000)
    before = sorted(tmp_path.iterdir())
    process = start("match", made.source, made.target, "--landmarks", made.landmarks, folder=tmp_path)
    assert process.stderr is not None
    first = process.stderr.readline()
    assert first.startswith("eigenfunctions of ")
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "Traceback" not in err
    assert "error" not in err
    assert out == ""
    assert sorted(tmp_path.iterdir()) == before


def test_names_that_are_no_text(tmp_path: Path) -> None:
    if sys.platform != "linux":
        pytest.skip("file names are text here")
    process = start("info", os.fsdecode(b"\xff.off"), folder=tmp_path)
    out, err = process.communicate(timeout=60)
    assert (process.returncode, out) == (2, "")
    assert err.startswith("kfmaps: error: \\udcff.off: ")
    assert len(err.splitlines()) == 1


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="only the allocator of Linux is told")
def test_the_command_keeps_freed_memory():
    """Arrays of 40 MB have their pages once, not each time."""
    output = subprocess.run([sys.executable, "-c", _PAGES], capture_output=True, text=True, check=True).stdout.split()
    before, after = map(int, output)
    assert after < 0.2 * before


_PAGES = """
import resource
import numpy as np
from kfmaps.cli.main import _keep_freed_memory

def faults():
    start = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    for _ in range(20):
        np.empty(5_000_000)[::256] = 1.0
    return resource.getrusage(resource.RUSAGE_SELF).ru_minflt - start

print(faults())
_keep_freed_memory()
faults()
print(faults())
"""
