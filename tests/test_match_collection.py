"""``kfmaps.match_collection``: shapes in, maps that agree out."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import kfmaps
from collecting import CONFIG, registered
from kfmaps._arrays import InvalidInput
from kfmaps.shape import Shape, prepare

GUARDS = ("kfmaps.collection",)

N = 300
LOCAL = replace(CONFIG, search=kfmaps.Search(candidates=1, n_sign_functions=2), threads=1)
LOCAL = replace(LOCAL, descriptors=replace(LOCAL.descriptors, shot=True))


@pytest.fixture(scope="module")
def shapes() -> dict[str, Shape]:
    return {f"s{i}": prepare(registered(i, N), LOCAL, name=f"s{i}") for i in range(4)}


def true_maps(shapes: dict[str, Shape]) -> dict[tuple[str, str], np.ndarray]:
    names = list(shapes)
    return {(a, b): np.arange(N) for i, a in enumerate(names) for b in names[i + 1 :]}


def test_given_maps_are_kept_but_for_the_wrong_one(shapes: dict[str, Shape]) -> None:
    maps = true_maps(shapes)
    maps["s0", "s2"] = np.random.default_rng(0).permutation(N)
    calls: list[str] = []
    found = kfmaps.match_collection(shapes, maps, config=LOCAL, progress=lambda what, *_: calls.append(what))
    assert list(found.replacements) == [("s0", "s2")]
    assert found.replacements["s0", "s2"].startswith("composition through s")
    at = found.pairs.index(("s0", "s2"))
    assert (found.maps[at] == np.arange(N)).mean() > 0.9
    match = found.matches[at]
    assert match is not None
    assert match.score.initialization == found.replacements["s0", "s2"]
    assert [m is None for m in found.matches].count(False) == 1
    assert min(found.probabilities) > 0.5
    assert set(found.chirality.values()) == {1}
    assert set(calls) == {"shapes", "pairs"}
    D = found.distances()
    assert D.shape == (4, 4)
    assert D[0, 1] < D[0, 3]
    assert found.distances("conformal")[0, 3] > 0


def test_any_two_shapes_have_a_map(shapes: dict[str, Shape]) -> None:
    chain = {("s0", "s1"): np.arange(N), ("s2", "s1"): np.arange(N), ("s2", "s3"): np.arange(N)}
    found = kfmaps.match_collection(shapes, chain, config=LOCAL)
    np.testing.assert_array_equal(found.map("s3", "s0"), np.arange(N))
    np.testing.assert_array_equal(found.map("s0", "s0"), np.arange(N))
    np.testing.assert_array_equal(found.map("s1", "s2"), np.arange(N))
    apart = kfmaps.match_collection(shapes, {("s0", "s1"): np.arange(N)}, config=LOCAL)
    assert apart.limit_shape is None
    with pytest.raises(InvalidInput, match="shapes that maps connect"):
        apart.map("s0", "s3")
    with pytest.raises(InvalidInput, match="three shapes or more"):
        apart.distances()
    with pytest.raises(InvalidInput, match="Check the spelling"):
        apart.map("s0", "nobody")


def test_without_maps_pairs_are_matched(shapes: dict[str, Shape]) -> None:
    few = [shapes["s0"], shapes["s1"], shapes["s2"]]
    found = kfmaps.match_collection(few, config=LOCAL)
    assert found.names == ("0", "1", "2")
    assert set(found.pairs) == {("0", "1"), ("0", "2"), ("1", "2")}
    assert all(m is not None for m in found.matches)
    assert max(m.max() for m in found.maps) < N


def test_bad_input_to_match_collection_is_refused(shapes: dict[str, Shape]) -> None:
    two = {name: shapes[name] for name in ("s0", "s1")}
    refused: list[tuple[dict[str, Shape], dict[str, Any], str]] = [
        ({"s0": shapes["s0"]}, {}, "shapes"),
        (shapes, {"graph": "ring"}, "near, star or all"),
        (two, {"maps": {("s0", "nobody"): np.arange(N)}}, "nobody"),
        (two, {"maps": {("s0", "s1"): np.arange(N) + 1}}, "s0 → s1"),
        (two, {"maps": {}}, "at least one"),
    ]
    for some, more, output in refused:
        with pytest.raises(InvalidInput, match=output):
            kfmaps.match_collection(some, **more, config=LOCAL)


def test_maps_of_parts_stay_apart(shapes: dict[str, Shape]) -> None:
    maps = true_maps({name: shapes[name] for name in ("s0", "s1", "s2")})
    usual = kfmaps.match_collection({name: shapes[name] for name in ("s0", "s1", "s2")}, maps, config=LOCAL)
    part = np.where(np.arange(N) % 3 == 0, -1, np.arange(N))
    found = kfmaps.match_collection(shapes, {**maps, ("s0", "s3"): part}, config=LOCAL)
    assert found.parts == (("s0", "s3"),)
    assert found.pairs == (*usual.pairs, ("s0", "s3"))
    assert found.probabilities[:-1] == pytest.approx(usual.probabilities)
    assert np.isnan(found.probabilities[-1])
    np.testing.assert_array_equal(found.map("s0", "s3"), part)
    with pytest.raises(InvalidInput, match="shapes that maps connect"):
        found.map("s1", "s3")
    assert found.limit_shape is None
    np.testing.assert_allclose(found.distances()[:3, :3], usual.distances(), atol=1e-9)
    assert np.isnan(found.distances()[:3, 3]).all()
    only = kfmaps.match_collection(shapes, {("s0", "s3"): part}, config=LOCAL)
    assert only.parts == only.pairs == (("s0", "s3"),)
    assert only.replacements == {}
