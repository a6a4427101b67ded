"""How long work tells of its progress."""

from collections.abc import Callable

Progress = Callable[[str, float], None]
"""Called with a stage's name and how much of it is done, from 0 to 1."""

Done = Callable[[float], None]
"""Called with how much of one stage is done, from 0 to 1."""

CountProgress = Callable[[str, int, int], None]
"""Called with what is done, how many are done, and how many there are."""
