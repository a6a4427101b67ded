"""Matches with either orientation: which map is taken, and when the other is its rival."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from conftest import SMALL, blob, cloud_of
from kfmaps import datasets
from kfmaps.config import Search
from kfmaps.geometry.mesh import mirror_mesh
from kfmaps.matching import match as match_module
from kfmaps.matching.result import Match
from kfmaps.matching.result_groups import MatchPart, MatchScore
from kfmaps.shape import prepare

GUARDS = ("kfmaps.matching.match",)
EITHER = replace(SMALL, search=Search(candidates=2, n_sign_functions=3, orientation="either"))
SHAPE = prepare(blob(100), SMALL)


def found(fit: float, verdict: str = "sure", which: Any = "none", rejected: int = 0) -> Match:
    """A match whose score, apart from deformation, is ``fit``; its map names its fit, too."""
    points, quality = np.full(100, int(10 * abs(fit))), fit if which == "none" else None
    score = MatchScore((30.0 if which == "none" else fit, 1.0), quality, rejected_landmarks=np.arange(rejected))
    return Match(
        points,
        verdict=verdict,
        confidence={"sure": 0.95, "likely": 0.7, "unlikely": 0.2}[verdict],
        score=score,
        partial=MatchPart(which),
        alternatives=(np.zeros(100, dtype=np.int64),),
    )


@pytest.mark.parametrize(
    ("preserving", "reversing", "chosen", "verdict"),
    [
        (found(-2.0), found(-3.1), 0, "sure"),
        (found(-2.0), found(-2.9), 0, "ambiguous"),
        (found(-3.1), found(-2.0), 1, "sure"),
        (found(-2.9), found(-2.0), 1, "ambiguous"),
        (found(-2.9, rejected=1), found(-5.0), 1, "sure"),  # landmarks decide
        (found(-2.9, rejected=1), found(-2.8, rejected=2), 0, "sure"),
        (found(22.0, which="target"), found(20.9, which="target"), 0, "sure"),
        (found(22.0, which="target"), found(22.9, which="target"), 1, "ambiguous"),
        (found(22.0, "likely", which="target"), found(-2.0), 1, "ambiguous"),  # scores of other kinds
        (found(-2.0, "unlikely"), found(-2.1, "unlikely"), 0, "unlikely"),
    ],
)
def test_the_better_map_is_taken_and_the_other_is_a_rival_unless_it_fits_much_less_well(
    monkeypatch, preserving, reversing, chosen, verdict
):
    ways = {"preserving": preserving, "reversing": reversing}
    monkeypatch.setattr(match_module, "_match_as_stated", lambda task, _: ways[task.config.search.orientation])
    result, best = match_module.match(SHAPE, SHAPE, EITHER), (preserving, reversing)[chosen]
    assert np.array_equal(result.target_to_source, best.target_to_source)
    assert result.verdict == verdict
    assert result.config == EITHER
    if verdict == "ambiguous":
        other = (preserving, reversing)[1 - chosen]
        assert result.confidence == 0.5
        assert np.array_equal(result.alternatives[0], other.target_to_source)
        assert result.score.scores == (best.score.scores[0], other.score.scores[0], 1.0)
    else:
        assert (result.confidence, result.score) == (best.confidence, best.score)


def test_a_mirrored_body_without_symmetry_is_found() -> None:
    pair = datasets.two_poses(1500, rng=1)
    result = match_module.match(pair.source, mirror_mesh(pair.target), EITHER)
    assert result.orientation == "reversing"
    off = np.linalg.norm(pair.source.vertices[result.target_to_source] - pair.source.vertices[pair.truth], axis=1)
    assert np.median(off) < 0.05 * np.ptp(pair.source.vertices, axis=0).max()


def test_point_clouds_have_no_mirror_image() -> None:
    cloud = cloud_of(blob(300))
    assert match_module.match(cloud, cloud, EITHER).orientation == "preserving"
