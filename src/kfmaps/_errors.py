"""Errors, warnings and the form of every refusal: the ground floor, which imports nothing heavy."""

from __future__ import annotations


class InvalidInput(ValueError):
    """The caller handed in something that cannot be used; the message says what to do."""


class NotConverged(RuntimeError):
    """A numerical method stopped before it reached the accuracy that was asked for."""


class MissingDependency(ImportError):
    """An optional package or system part is missing; the message says how to get it."""


class KfmapsWarning(UserWarning):
    """Something unusual that still gives a correct answer."""


def refuse(name: str, expected: str, got: str, remedy: str) -> InvalidInput:
    """Return the error "`name`: expected …, got …. Do ….", the one form of every refusal.

    ``name``: the argument, option or file; ``expected`` and ``got``: noun phrases; ``remedy``: one or more sentences
    about what to do; the first letter and the last full stop are put right.
    """
    problem = f"{name}: expected {expected}, got {got}"
    return InvalidInput(shown(f"{_sentence(problem, '')} {_sentence(remedy, remedy[:1].upper())}"))


def _sentence(text: str, first: str) -> str:
    """Return ``text`` with a full stop, unless it ends with a mark already, and with another first letter."""
    return (first or text[:1]) + text[1:] + ("" if text.endswith((".", "?", "!")) else ".")


def shown(text: str) -> str:
    """Return ``text`` fit for a terminal: control characters, and all else that cannot be printed, by their codes.

    A file may be called anything; its name must not move the cursor, change colours or run together with the next.
    """
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)
