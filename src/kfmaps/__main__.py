"""The command ``kfmaps``, and ``python -m kfmaps`` where its script is not on the path."""

import signal
import sys


def main() -> int:
    """Run the command and return its exit status; Ctrl-C ends it at any time without a message."""
    # While Python imports, which takes half a second, and while it ends, nothing can catch the interrupt: the system
    # ends the process then. A parent that has the signal ignored keeps it so.
    ours = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    try:
        if ours:
            signal.signal(signal.SIGINT, signal.SIG_DFL)
        from kfmaps.cli.main import main as command

        if ours:
            signal.signal(signal.SIGINT, signal.default_int_handler)
        signal.signal(signal.SIGTERM, _ended)
        status = command()
        if ours:
            signal.signal(signal.SIGINT, signal.SIG_DFL)
    except KeyboardInterrupt:
        return 128 + signal.SIGINT
    return status


def _ended(number: int, frame: object) -> None:
    """Leave by an exception, so that what is half done is taken away."""
    del frame
    sys.exit(128 + number)


if __name__ == "__main__":
    sys.exit(main())
