"""The command ``kfmaps``: run a module of ``kfmaps.cli.commands`` and report errors in one line.

Only the module of the named command is imported, so that ``kfmaps --help`` is quick.
"""

from __future__ import annotations

import contextlib
import ctypes
import errno
import importlib
import io
import os
import sys
import warnings
from collections.abc import Callable, Sequence
from typing import Annotated, Any

import typer

import kfmaps
from kfmaps._errors import InvalidInput, KfmapsWarning, MissingDependency, NotConverged, printable
from kfmaps.cli.streams import standard_streams

COMMANDS = {
    "match": "Find for each vertex of the target the corresponding vertex of the source, and write the map.",
    "demo": "Make two poses of a shape, match them, print the error beside that without a kernel, draw a picture.",
    "evaluate": "Print the geodesic error of a map, by the Princeton protocol, in per cent of √area.",
    "info": "Show what is in files: vertices, faces, components, area, genus, defects.",
    "config": "Print the settings that match would use, as TOML that --config reads.",
    "transfer": "Carry functions, labels or named points over a map.",
    "export": "Write the target with the source's texture, shape keys and skeleton, or the map in another format.",
    "view": "Show a map in the browser, or write it as one page that needs no network.",
    "landmarks": "Pick landmarks on a local page, carry those of some specimens to a folder of scans, review them.",
    "batch": "Match many pairs in parallel: a table, every map and a summary page.",
    "render": "Figures for papers (PNG, SVG, PDF), drawn without a display.",
    "learn": "Learn a kernel from pairs of shapes, and write settings for kfmaps match --config.",
}
"""Modules of ``kfmaps.cli.commands``, each with a function of its own name or a ``typer.Typer`` called ``app``, and the
first line of its documentation, so that ``--help`` imports no command."""

_USAGE_ERROR: type[Exception] = next(kind for kind in typer.BadParameter.__mro__ if kind.__name__ == "ClickException")
"""Class of Typer's errors about unknown options and missing arguments; in some versions it has no public name."""

_OUTPUT_ERRORS = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EBADF)
"""Error numbers of a standard output that cannot be written."""

_FAILURE, _INTERRUPTED, UNREAD = 2, 130, 1
"""Exit statuses: bad input, Ctrl-C, and output whose reader has closed."""


_TRIM_THRESHOLD, _MMAP_THRESHOLD = -1, -3
"""Parameters of glibc's ``mallopt``: sizes above which freed memory is returned, and arrays get pages of their own."""


def _keep_freed_memory() -> None:
    """Let the allocator of Linux keep freed memory for the next arrays; other systems are left alone.

    By default it returns large arrays at once and allocates the next ones page by page, which takes a twelfth of the
    time of a match of skulls. The peak of memory stays the same.
    """
    try:
        mallopt = ctypes.CDLL(None).mallopt
    except (AttributeError, TypeError, OSError):  # another library, or none by that name on Windows
        return
    for size in (_TRIM_THRESHOLD, _MMAP_THRESHOLD):
        mallopt(size, 2**31 - 1)


def application(only: str | None = None) -> typer.Typer:
    """Return the whole command; with ``only`` all other commands have a name and help, and no code."""
    app = typer.Typer(
        name="kfmaps",
        add_completion=True,
        pretty_exceptions_enable=False,
        rich_markup_mode="rich",
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback()(_root)
    for name in COMMANDS:
        if only is not None and name != only:
            app.command(name)(_placeholder(name))
            continue
        module = importlib.import_module(f"kfmaps.cli.commands.{name}")
        if hasattr(module, "app"):
            app.add_typer(module.app, name=name)
        else:
            app.command(name)(getattr(module, name))
    return app


def _version(requested: bool) -> None:
    if requested:
        typer.echo(f"kfmaps {kfmaps.__version__}")
        raise typer.Exit


def _root(
    version: Annotated[
        bool, typer.Option("--version", help="Print the version and exit.", is_eager=True, callback=_version)
    ] = False,
) -> None:
    """Which point of one 3D surface corresponds to which point of another, by kernel functional maps."""


def _placeholder(name: str) -> Callable[[], None]:
    """Return a stand-in with the help of a command and not its code."""

    def command() -> None:
        raise AssertionError(f"{name} was not loaded")

    command.__doc__ = COMMANDS[name]
    return command


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command and return its exit status.

    0: done, 2: bad input, 3: a required verdict was not met, 130: interrupted, 1: the reader went away.
    """
    words = list(sys.argv[1:] if arguments is None else arguments) or ["--help"]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # NumPy's; what matters is checked by kfmaps itself
        warnings.simplefilter("default", KfmapsWarning)
        warnings.showwarning = _warning_printer(warnings.showwarning)
        try:
            _open_streams()
            _keep_freed_memory()
            status = _run(words)
            sys.stdout.flush()
            return status
        except KeyboardInterrupt:
            return _INTERRUPTED
        except BrokenPipeError:
            _discard_output()
            return UNREAD
        except (InvalidInput, MissingDependency, NotConverged) as error:
            return _report_error(str(error))
        except MemoryError as error:
            return _report_error(f"not enough memory; use smaller meshes or fewer samples ({error or 'no details'})")
        except OSError as error:
            if error.filename is None and error.errno in _OUTPUT_ERRORS:
                return _report_output_error(error)
            place = f"{error.filename}: " if error.filename else ""
            return _report_error(f"{place}{error.strerror or error}; check the path, its rights and the space left")


def _open_streams() -> None:
    """Open standard streams that the caller has closed, on the null device.

    Otherwise the next file that is opened would get the number of a standard stream, and be overwritten by messages.
    """
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            try:
                os.fstat(number)  # another file has the number already
            except OSError:
                null_device = os.open(os.devnull, os.O_RDWR)
                if null_device != number:
                    os.dup2(null_device, number)
                    os.close(null_device)
            setattr(sys, name, open(os.devnull, "r+" if name == "stdin" else "w", encoding="utf-8"))  # noqa: SIM115


def _report_output_error(error: OSError) -> int:
    """Report that standard output cannot be written; errors of files name the file instead."""
    _discard_output()
    return _report_error(f"standard output: {error.strerror or error}; check the space left where it goes")


def _discard_output() -> None:
    """Redirect the buffered output to the null device, or it would raise again when Python flushes it at exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _run(words: Sequence[str]) -> int:
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")  # file names may have bytes that are no text
    completing = "_KFMAPS_COMPLETE" in os.environ
    name = next((word for word in words if not word.startswith("-")), "")
    command = typer.main.get_command(application(None if completing else name))
    try:
        with standard_streams(words, name) as words:
            status = command.main(args=words, prog_name="kfmaps", standalone_mode=False)
    except _USAGE_ERROR as error:
        context = getattr(error, "ctx", None)
        message = _suggest_settings(error, context) or error.format_message()  # pyright: ignore[reportAttributeAccessIssue]
        path = getattr(context, "command_path", "kfmaps")
        # There is no message where a group got no command; its help has been printed.
        return _report_error(f"{message.rstrip('.')}; see {path} --help") if message else _FAILURE
    except typer.Abort:
        return _INTERRUPTED
    except SystemExit as exit:
        return exit.code if isinstance(exit.code, int) else 0
    return status if isinstance(status, int) else 0


def _suggest_settings(error: Exception, context: Any) -> str:
    """Return a hint at the settings that an unknown option may mean, where the command takes ``--set``."""
    option = getattr(error, "option_name", None)
    parameters = () if context is None else context.command.params
    if option is None or all(parameter.name != "assign" for parameter in parameters):
        return ""
    from kfmaps.settings import similar_settings

    suggestions = " or ".join(f"--set {path}=VALUE" for path in similar_settings(option))
    return f"there is no option {option}; use {suggestions}" if suggestions else ""


def _warning_printer(show_others: Callable[..., None]) -> Callable[..., None]:
    """Return a ``warnings.showwarning`` that prints the package's own warnings in one line each, and none twice."""
    printed: set[str] = set()

    def show(message: object, category: type[Warning], *where: object, **more: object) -> None:
        if not issubclass(category, KfmapsWarning):
            show_others(message, category, *where, **more)
        elif str(message) not in printed:
            printed.add(str(message))
            _say(f"warning: {message}")

    return show


def _report_error(text: str) -> int:
    _say(f"error: {text}")
    return _FAILURE


def _say(text: str) -> None:
    """Print one line on standard error, if the stream is still open."""
    with contextlib.suppress(OSError):
        print("kfmaps:", printable(" ".join(text.split())), file=sys.stderr)


if __name__ == "__main__":
    sys.exit(main())
