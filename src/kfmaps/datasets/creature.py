"""The creature: its limbs, two poses, different proportions, and a relative that is the same on both sides.

It faces +z, its left is +x and up is +y; standing, it is about two high.
"""

from __future__ import annotations

from kfmaps.datasets.skeleton import Bend, Limb

_TRUNK = (
    Limb("trunk", None, ((0, 0.62, 0, 0.19), (0, 0.8, 0.03, 0.26), (0, 1.02, 0, 0.2), (0, 1.16, -0.01, 0.13))),
    Limb("head", "trunk", ((0, 1.14, 0, 0.11), (0, 1.28, 0.02, 0.12), (0, 1.42, 0.03, 0.195), (0, 1.49, 0.03, 0.205))),
    Limb("snout", "head", ((0, 1.44, 0.12, 0.12), (0, 1.41, 0.22, 0.1), (0, 1.39, 0.32, 0.065))),
)
_LEFT = (
    Limb("left ear", "head", ((0.1, 1.6, 0.03, 0.075), (0.18, 1.78, 0, 0.065), (0.3, 1.96, -0.02, 0.035))),
    Limb(
        "left arm",
        "trunk",
        ((0.16, 1.1, 0, 0.085), (0.4, 1.06, -0.01, 0.065), (0.64, 1.02, 0, 0.055), (0.84, 1, 0.03, 0.09)),
    ),
    Limb("left leg", "trunk", ((0.12, 0.58, 0, 0.125), (0.17, 0.36, 0.02, 0.1), (0.19, 0.12, 0, 0.08))),
    Limb("left foot", "left leg", ((0.19, 0.09, 0.02, 0.08), (0.205, 0.07, 0.1, 0.08), (0.22, 0.06, 0.19, 0.06))),
)
_RIGHT = (
    Limb("right ear", "head", ((-0.11, 1.6, 0.02, 0.075), (-0.16, 1.7, 0, 0.055), (-0.2, 1.78, 0, 0.03))),
    Limb(
        "right arm",
        "trunk",
        ((-0.15, 1.08, 0, 0.09), (-0.32, 1.02, -0.01, 0.075), (-0.46, 0.97, 0, 0.065), (-0.58, 0.93, 0.02, 0.08)),
    ),
    Limb("right leg", "trunk", ((-0.13, 0.58, 0, 0.12), (-0.19, 0.29, 0.02, 0.085), (-0.22, -0.03, 0, 0.07))),
    Limb(
        "right foot",
        "right leg",
        ((-0.22, -0.06, 0.02, 0.075), (-0.24, -0.08, 0.12, 0.075), (-0.26, -0.09, 0.24, 0.06)),
    ),
)
_TAIL = Limb(
    "tail",
    "trunk",
    (
        (0, 0.6, -0.14, 0.11),
        (0.05, 0.46, -0.4, 0.09),
        (0.22, 0.36, -0.6, 0.07),
        (0.46, 0.38, -0.68, 0.055),
        (0.66, 0.52, -0.66, 0.035),
    ),
)
_STRAIGHT_TAIL = Limb(
    "tail",
    "trunk",
    (
        (0, 0.6, -0.14, 0.11),
        (0, 0.46, -0.4, 0.09),
        (0, 0.36, -0.64, 0.07),
        (0, 0.36, -0.86, 0.055),
        (0, 0.48, -1.04, 0.035),
    ),
)


def _mirror(limb: Limb) -> Limb:
    """Return a left limb's exact mirror image, named for the right."""
    parent = limb.parent and limb.parent.replace("left", "right")
    return Limb(limb.name.replace("left", "right"), parent, tuple((-x, y, z, radius) for x, y, z, radius in limb.balls))


CREATURE = (*_TRUNK, *_LEFT, *_RIGHT, _TAIL)
"""No side like the other: every ear, arm, leg and foot has its own length and thickness."""

SYMMETRIC = (*_TRUNK, *_LEFT, *(_mirror(limb) for limb in _LEFT), _STRAIGHT_TAIL)
"""Its right side is the mirror image of its left."""

WAVE = {
    "trunk": Bend(((0, 0, 0), (0, 0, 4), (4, 0, 4), (0, 0, 0))),
    "head": Bend(((0, 0, -6), (0, 8, -5), (0, 6, -3), (0, 6, 0))),
    "left ear": Bend(((0, 0, 0), (0, 0, -15), (0, 0, -15))),
    "left arm": Bend(((0, -10, 18), (0, -10, 48), (0, -10, 32), (0, 0, 0))),
    "right arm": Bend(((0, 10, 10), (0, 15, 18), (0, 25, 10), (0, 0, 0))),
    "left leg": Bend(((-14, 0, 4), (10, 0, 0), (0, 0, 0))),
    "right leg": Bend(((12, 0, -6), (14, 0, 0), (0, 0, 0))),
    "tail": Bend(((0, 10, 0), (0, 10, 0), (0, 10, 0), (0, 10, 10), (0, 0, 0))),
}
"""Standing, the left arm raised."""

DANCE = {
    "trunk": Bend(((0, 0, 0), (-4, 0, -7), (-4, 10, -7), (0, 0, 0))),
    "head": Bend(((0, 0, 8), (8, -6, 6), (0, -6, 4), (0, -6, 0))),
    "left ear": Bend(((0, 0, -10), (0, 0, -20), (0, 0, -30))),
    "left arm": Bend(((0, -10, -20), (0, -25, -25), (0, -45, 0), (0, -20, 0))),
    "right arm": Bend(((0, 0, -20), (0, 10, -40), (0, 5, -30), (0, 0, 0))),
    "left leg": Bend(((-40, 0, 12), (50, 0, 0), (20, 0, 0))),
    "left foot": Bend(((-15, 0, 0), (0, 0, 0), (0, 0, 0))),
    "right leg": Bend(((0, 0, -4), (4, 0, 0), (0, 0, 0))),
    "tail": Bend(((0, -16, 0), (0, -22, 0), (0, -26, 0), (0, -26, 20), (0, -10, 20))),
}
"""On the right leg, the left one lifted, the right arm raised, the tail swung round."""

_PROPORTIONS = {
    "trunk": (1.05, 1.35),
    "head": (0.95, 1.0),
    "snout": (1.3, 1.0),
    "left ear": (0.7, 1.1),
    "right ear": (1.3, 1.1),
    "left arm": (1.2, 1.15),
    "right arm": (1.3, 1.1),
    "left leg": (1.35, 1.1),
    "right leg": (1.35, 1.1),
    "left foot": (1.3, 1.2),
    "right foot": (1.3, 1.2),
    "tail": (0.75, 1.2),
}
"""(longer, thicker): a fat belly on long legs, large feet, a short tail."""


def with_proportions(pose: dict[str, Bend]) -> dict[str, Bend]:
    """Return the ``pose`` of the creature with different proportions."""
    return {name: Bend(pose.get(name, Bend()).turns, *factors) for name, factors in _PROPORTIONS.items()}
