"""
A first map, with landmarks
===========================

Two meshes of one creature in two poses were made independently, and someone has marked six vertices on both. The
result is a vertex of the source for each vertex of the target.
"""

from dataclasses import replace

import kfmaps
from kfmaps.kernels.landmark_selection import farthest_descriptors
from kfmaps.viz import match_figure

pair = kfmaps.datasets.two_poses(vertices=2000)
print(f"source: {len(pair.source.vertices)} vertices, target: {len(pair.target.vertices)} vertices")

# %%
# Landmarks are rows "source vertex, target vertex", counted from 0. Here the known truth replaces a person who clicks
# on six places far from each other (``kfmaps landmarks A B`` opens a page for that).

marked = farthest_descriptors(pair.target.vertices, 6)
landmarks = [(int(pair.truth[v]), int(v)) for v in marked]
print(landmarks)

# %%
# These meshes are small, so the settings below are smaller than the recommended ones. With meshes of 5,000 vertices
# and more, leave ``config`` out.

config = replace(
    kfmaps.Config.single_fit(),
    basis=kfmaps.BasisConfig(n_eigenfunctions=60),
    descriptors=kfmaps.DescriptorConfig(n_eigenfunctions=100, shot=False),
    nystrom=kfmaps.NystromConfig(samples=200),
    refinement=kfmaps.ZoomOut(start=30, stop=100, step=5),
)
result = kfmaps.match(pair.source, pair.target, config, landmarks=landmarks)

assert result.fit.status is not None  # a search may do without one; with landmarks there is
assert result.fit.raw_target_to_source is not None
print(f"{result.fit.kernel}: {result.fit.rank} features, {result.fit.n_operators} operators after compression")
print(f"solver {result.fit.status} after {result.fit.steps} steps")
print({stage: round(seconds, 2) for stage, seconds in result.seconds.items()})

# %%
# The truth is known, so the error of each target vertex can be measured: the distance along the source between where
# the map sends it and where it belongs, divided by the square root of the source's area.

errors = kfmaps.geodesic_errors(pair.source, result.target_to_source, pair.truth)
raw_errors = kfmaps.geodesic_errors(pair.source, result.fit.raw_target_to_source, pair.truth)
figure = match_figure(pair.source, pair.target, result.target_to_source, errors=errors)

# %%
# The refinement (ZoomOut) has improved the map. A typical edge of the source is 0.025 long in the same unit, so the
# remaining error is half an edge.

mean, raw_mean = errors.mean(), raw_errors.mean()
print(f"mean error: {100 * raw_mean:.2f} before refinement, {100 * mean:.2f} after (times 100)")
assert mean < raw_mean < 0.03
