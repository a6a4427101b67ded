"""Errors, warnings, and the form of every refusal; nothing heavy is imported here."""

from __future__ import annotations


class InvalidInput(ValueError):
    """Input cannot be used; the message says what to do."""


class NotConverged(RuntimeError):
    """A numerical method stopped before it reached the required accuracy."""


class MissingDependency(ImportError):
    """An optional package or system part is missing; the message says how to get it."""


class KfmapsWarning(UserWarning):
    """Something unusual, with which results are still correct."""


def refuse(name: str, expected: str, got: str, remedy: str) -> InvalidInput:
    """Return the error "`name`: expected …, got …. Do …."; every refusal has this form.

    ``name``: the argument, option or file; ``expected`` and ``got``: noun phrases; ``remedy``: one or more sentences
    that say what to do, whose first capital and last full stop may be left out.
    """
    problem = f"{name}: expected {expected}, got {got}"
    return InvalidInput(printable(f"{_sentence(problem, '')} {_sentence(remedy, remedy[:1].upper())}"))


def _sentence(text: str, first: str) -> str:
    """Return ``text`` with the letter ``first`` (if any) in front, and a full stop unless it ends with a mark."""
    return (first or text[:1]) + text[1:] + ("" if text.endswith((".", "?", "!")) else ".")


def printable(text: str) -> str:
    """Return ``text`` with codes in place of control characters and others that cannot be printed.

    A file may have any name, and its name must not move the cursor, change colours or break the line.
    """
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)
