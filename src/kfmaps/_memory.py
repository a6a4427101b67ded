"""Memory is looked at before it is asked for, so that a wrong number costs a line and not the machine."""

from __future__ import annotations

import os
from functools import cache

from kfmaps._arrays import refuse

_UNKNOWN = 64 << 30  # what a machine is taken to have that does not tell


@cache
def _installed_memory() -> int:
    """Bytes of memory that this machine has, in use or not."""
    try:
        size = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):  # no such function on Windows, no such name elsewhere
        return _UNKNOWN
    return size if size > 0 else _UNKNOWN


def check_memory(need: float, name: str, what: str, remedy: str) -> None:
    """Refuse what needs more memory than there is in the machine.

    ``need``: bytes; ``name`` and ``what``: what is at fault, and what the memory would be for.
    """
    have = _installed_memory()
    if need > have:
        raise refuse(name, f"at most {format_bytes(have)} of memory", f"{format_bytes(need)} for {what}", remedy)


def format_bytes(size: float) -> str:
    """Return a number of bytes in words: 12 MB, 3.5 GB, 1,000 GB."""
    for unit, scale in (("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if size >= scale:
            return f"{size / scale:.3g} {unit}" if size < 1000 * scale else f"{size / scale:,.0f} {unit}"
    return f"{size:.0f} bytes"
