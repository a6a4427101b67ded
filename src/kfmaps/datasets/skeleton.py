"""Organic bodies: a smooth union of curved limbs, and the bending of a body along its limbs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator
from scipy.spatial.transform import Rotation

from kfmaps._arrays import blocks

_FILLET = 0.022  # width of the fillet between limbs, in units of the body (about two high)
_SOFTNESS = 0.045  # distance over which the motions of two limbs blend, in the same units
_REACH = 12 * _FILLET  # a limb further away than this adds less than 1e-5 of FILLET to the field and is left out
_BLOCK = 50_000  # number of points computed together, which bounds the memory
_MAX_POINTS = 250_000  # largest number of points whose field is computed at once


@dataclass(frozen=True)
class Limb:
    """A tube along a smooth curve through the centres of balls."""

    name: str
    parent: str | None  # the limb that carries it; None for the trunk, which comes first
    balls: tuple[tuple[float, float, float, float], ...]  # x, y, z and radius of each, from the root to the tip


@dataclass(frozen=True)
class Bend:
    """A pose or a change of proportions of one limb."""

    # A rotation vector in degrees at each of the limb's points, in the axes of the unbent body; each is spread over the
    # curve between the two points beside it.
    turns: tuple[tuple[float, float, float], ...] = ()
    longer: float = 1.0  # factors along and across the limb
    thicker: float = 1.0


def _with_level_ends(along: np.ndarray, radii: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mirror the samples at both ends, so that the radius is level there and the caps join smoothly."""
    before, after = 2 * along[0] - along[1], 2 * along[-1] - along[-2]
    return np.concatenate([[before], along, [after]]), np.concatenate([radii[1:2], radii, radii[-2:-1]])


class Body:
    """The straight pieces of all limbs as arrays; ``body(points)`` is the field that is zero on the skin.

    ``limbs``: parents before their children; ``segments``: straight pieces per limb.
    """

    def __init__(self, limbs: tuple[Limb, ...], segments: int = 12) -> None:
        self.limbs = limbs
        self.segments = segments
        nodes, radii, places = [], [], []
        for limb in limbs:
            points, thickness = np.array(limb.balls)[:, :3], np.array(limb.balls)[:, 3]
            along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
            fine = np.linspace(0, along[-1], self.segments + 1)
            nodes.append(CubicSpline(along, points)(fine))
            radii.append(PchipInterpolator(*_with_level_ends(along, thickness))(fine))
            places.append(np.interp(fine, along, np.arange(len(points))))
        self.nodes, self.radii, self.places = np.array(nodes), np.array(radii), np.array(places)
        """(limbs, segments + 1, ...): along each limb the position, radius and place among its points."""

    def box(self) -> np.ndarray:
        """Return the lowest and highest corner of a box around the skin, (2, 3)."""
        room = self.radii[:, :, None] + 2 * _FILLET
        return np.array([(self.nodes - room).min(axis=(0, 1)), (self.nodes + room).max(axis=(0, 1))])

    def _distances(self, points: np.ndarray, limb: int) -> tuple[np.ndarray, np.ndarray]:
        """Return the signed distance (n, segments) to each piece of a limb, and the foot on it from 0 to 1."""
        starts, steps = self.nodes[limb, :-1], np.diff(self.nodes[limb], axis=0)
        squares = (steps**2).sum(axis=1)
        along = points @ steps.T - (starts * steps).sum(axis=1)
        place = np.clip(along / squares, 0, 1)
        length = (points**2).sum(axis=1)[:, None] - 2 * points @ starts.T + (starts**2).sum(axis=1)
        length -= place * (2 * along - place * squares)
        length = np.sqrt(np.maximum(length, 1e-16))
        radius = self.radii[limb, :-1] + place * np.diff(self.radii[limb])
        return length - radius, place

    def __call__(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return value (n,), negative inside, and gradient (n, 3) of the smooth union of all limbs.

        Far from every limb the value is REACH and the gradient zero.
        """
        if len(points) > _MAX_POINTS:
            parts = [self(points[part]) for part in blocks(len(points), _BLOCK)]
            return np.concatenate([v for v, _ in parts]), np.concatenate([g for _, g in parts])
        values = np.full((len(self.limbs), len(points)), _REACH)
        gradients = np.zeros((len(self.limbs), len(points), 3))
        for limb in range(len(self.limbs)):
            room = self.radii[limb, :, None] + _REACH
            low, high = (self.nodes[limb] - room).min(axis=0), (self.nodes[limb] + room).max(axis=0)
            near = np.flatnonzero(((points > low) & (points < high)).all(axis=1))
            distances, place = self._distances(points[near], limb)
            best = distances.argmin(axis=1)
            rows = np.arange(len(near))
            start, stop = self.nodes[limb, best], self.nodes[limb, best + 1]
            t, step = place[rows, best][:, None], stop - start
            away = points[near] - start - t * step
            values[limb, near] = distances[rows, best]
            slope = (self.radii[limb, best + 1] - self.radii[limb, best]) / (step**2).sum(axis=1)
            along = np.where((t > 0) & (t < 1), slope[:, None] * step, 0)
            away /= np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 1e-12)
            gradients[limb, near] = away - along
        least = values.min(axis=0)
        weights = np.exp((least - values) / _FILLET)
        total = weights.sum(axis=0)
        return least - _FILLET * np.log(total), np.einsum("ln,lni->ni", weights / total, gradients)

    def _motions(self, bends: dict[str, Bend]) -> tuple[np.ndarray, np.ndarray]:
        """Return the affine motion ``x -> A x + b`` of every piece: A (pieces, 3, 3) and b (pieces, 3).

        Each piece starts where the one before it ends, the first of a limb where its parent moves it.
        """
        index = {limb.name: i for i, limb in enumerate(self.limbs)}
        linear = np.zeros((len(self.limbs), self.segments, 3, 3))
        offset = np.zeros((len(self.limbs), self.segments, 3))
        turned = np.zeros((len(self.limbs), self.segments, 3, 3))
        for i, limb in enumerate(self.limbs):
            bend = bends.get(limb.name, Bend())
            nodes = self.nodes[i]
            frame, at = np.eye(3), nodes[0]
            if limb.parent is not None:
                p = index[limb.parent]
                middles = 0.5 * (self.nodes[p, :-1] + self.nodes[p, 1:])
                s = int(np.linalg.norm(middles - nodes[0], axis=1).argmin())
                frame, at = turned[p, s], linear[p, s] @ nodes[0] + offset[p, s]
            turns = np.zeros((len(limb.balls), 3))
            turns[: len(bend.turns)] = np.deg2rad(np.array(bend.turns).reshape(-1, 3))
            middle = 0.5 * (self.places[i, :-1] + self.places[i, 1:])
            share = np.maximum(1 - np.abs(middle[:, None] - np.arange(len(turns))), 0)
            steps = Rotation.from_rotvec((share / share.sum(axis=0)) @ turns).as_matrix()
            for s in range(self.segments):
                frame = frame @ steps[s]
                along = nodes[s + 1] - nodes[s]
                axis = along / np.linalg.norm(along)
                stretch = bend.thicker * np.eye(3) + (bend.longer - bend.thicker) * np.outer(axis, axis)
                turned[i, s], linear[i, s] = frame, frame @ stretch
                offset[i, s] = at - linear[i, s] @ nodes[s]
                at = linear[i, s] @ nodes[s + 1] + offset[i, s]
        return linear.reshape(-1, 3, 3), offset.reshape(-1, 3)

    def bend(self, points: np.ndarray, bends: dict[str, Bend]) -> np.ndarray:
        """Return ``points (n, 3)`` of the skin moved by the limbs (linear blend skinning), (n, 3)."""
        if len(points) > _BLOCK:
            return np.concatenate([self.bend(points[part], bends) for part in blocks(len(points), _BLOCK)])
        linear, offset = self._motions(bends)
        pieces = [self._distances(points, limb)[0] for limb in range(len(self.limbs))]
        distances = np.concatenate(pieces, axis=1)
        weights = np.exp((distances.min(axis=1, keepdims=True) - distances) / _SOFTNESS)
        weights *= np.linalg.norm(np.diff(self.nodes, axis=1), axis=2).ravel()
        weights /= weights.sum(axis=1, keepdims=True)
        moved = (weights @ linear.reshape(-1, 9)).reshape(-1, 3, 3)
        return np.einsum("nij,nj->ni", moved, points) + weights @ offset
