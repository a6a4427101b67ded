"""Settings from files and the command line, laid over a configuration by what the user calls them."""

from __future__ import annotations

from typing import Any

from kfmaps._arrays import InvalidInput
from kfmaps.config import Config, from_dict


def nested(assignments: dict[str, Any]) -> dict[str, Any]:
    """``{"a.b": 1}`` as ``{"a": {"b": 1}}``."""
    tree: dict[str, Any] = {}
    for path, value in assignments.items():
        *above, last = path.split(".")
        branch: dict[str, Any] = tree
        for name in above:
            below: Any = branch.get(name)
            if isinstance(below, str):  # a kind
                below = {"kind": below}
            branch[name] = branch = below if isinstance(below, dict) else {}
        branch[last] = value
    return tree


def blamed(base: Config, given: dict[str, tuple[str, Any]]) -> Config:
    """``base`` with what is ``given``, by what the user calls it: ``{"--alpha": ("weights.laplacian", 2.0)}``.

    All of it is applied at once, since one value may only be right beside another. A complaint begins with the
    names of those that are at fault.
    """

    def applied(labels: list[str]) -> Config:
        return from_dict(nested(dict(given[label] for label in labels)), base)

    def works(labels: list[str]) -> bool:
        try:
            applied(labels)
        except InvalidInput:
            return False
        return True

    everything = list(given)
    try:
        return applied(everything)
    except InvalidInput as error:
        guilty = [label for label in everything if works([other for other in everything if other != label])]
        guilty = guilty or [label for label in everything if not works([label])]
        # A pair that contradicts each other is named whole; of several unrelated faults, the first.
        raise InvalidInput(f"{', '.join(guilty[:2])}: {error}" if guilty else str(error)) from error
