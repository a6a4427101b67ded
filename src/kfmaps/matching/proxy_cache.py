"""The copies of two shapes that are bent onto each other as many maps say: what depends on no map is made once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from kfmaps.geometry.coarsen import CoarseProxy
from kfmaps.matching.sample_pair import SamplePair
from kfmaps.registration.deformation_energy import MORE, FacingPair, coarse_copy, facing_pair
from kfmaps.registration.registered_shot import ShotPair, shot_pair
from kfmaps.shape import Shape, mirror_image


@dataclass(frozen=True, eq=False)
class ProxyCache:
    """Of two shapes, each made when it is first asked for; ``None`` where a shape has no faces to bend.

    Attributes
    ----------
    source, target : Shape
    coarse : pair of Copy or None
        Of few points, as the probes have them.
    mirrored : bool
        Whether they are of the target's mirror image.
    """

    source: Shape
    target: Shape
    copies: tuple[CoarseProxy | None, CoarseProxy | None]
    mirrored: bool = False

    @classmethod
    def of(cls, source: Shape, target: Shape, on: SamplePair) -> ProxyCache:
        """Of the shapes as they are ``on`` a ground."""
        return cls(source, target, (on.source.copy, on.target.copy), on.target.mirrored)

    @cached_property
    def image(self) -> Shape:
        """The target, or its mirror image where that is meant."""
        return mirror_image(self.target) if self.mirrored else self.target

    @cached_property
    def coarse(self) -> FacingPair | None:
        """The coarse ones."""
        a, b = self.copies
        return None if a is None or b is None else facing_pair(a, b)

    @cached_property
    def fine(self) -> ShotPair | None:
        """With :data:`~kfmaps.registration.deformation_energy.MORE` points, and how they look."""
        a, b = coarse_copy(self.source, MORE), coarse_copy(self.target, MORE)
        return None if a is None or b is None else shot_pair(facing_pair(a, b.mirrored() if self.mirrored else b))
