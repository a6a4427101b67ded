"""The command ``kfmaps``, and ``python -m kfmaps`` where its script is not on the path."""

import signal
import sys


def main() -> int:
    """Run the command and return its exit status; Ctrl-C ends it without a message."""
    # Nothing can catch an interrupt while Python imports, which takes half a second, or while it ends. So the system's
    # own handler ends the process then. Where the parent process ignores the signal, it stays ignored.
    is_default = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    try:
        if is_default:
            signal.signal(signal.SIGINT, signal.SIG_DFL)
        from kfmaps.cli.main import main as command

        if is_default:
            signal.signal(signal.SIGINT, signal.default_int_handler)
        signal.signal(signal.SIGTERM, _exit_on_signal)
        status = command()
        if is_default:
            signal.signal(signal.SIGINT, signal.SIG_DFL)
    except KeyboardInterrupt:
        return 128 + signal.SIGINT
    return status


def _exit_on_signal(number: int, frame: object) -> None:
    """Leave by an exception, so that half-written files are removed."""
    del frame
    sys.exit(128 + number)


if __name__ == "__main__":
    sys.exit(main())
