"""Compare needed with installed memory, so that a wrong number costs a message and not the machine."""

from __future__ import annotations

import os
from functools import cache

from kfmaps._arrays import refuse

_ASSUMED = 64 << 30  # bytes of memory of a machine that does not say how much it has


@cache
def _installed_memory() -> int:
    """Return the bytes of memory that this machine has, used or not."""
    try:
        size = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):  # no such function on Windows, no such name elsewhere
        return _ASSUMED
    return size if size > 0 else _ASSUMED


def check_memory(need: float, name: str, what: str, remedy: str) -> None:
    """Raise :class:`InvalidInput` where ``need`` bytes are more than the machine has.

    ``name``: the argument, option or file at fault; ``what``: what the memory is for, in words.
    """
    installed = _installed_memory()
    if need > installed:
        raise refuse(name, f"at most {format_bytes(installed)} of memory", f"{format_bytes(need)} for {what}", remedy)


def format_bytes(size: float) -> str:
    """Return a number of bytes as text: 12 MB, 3.5 GB, 1,000 GB."""
    for unit, scale in (("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if size >= scale:
            return f"{size / scale:.3g} {unit}" if size < 1000 * scale else f"{size / scale:,.0f} {unit}"
    return f"{size:.0f} bytes"
