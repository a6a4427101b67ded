"""
Labels and functions carried over
=================================

A point map carries any data at vertices, by looking it up. A functional map carries smooth functions without a point
map, by a product with a small matrix.
"""

from dataclasses import replace

import numpy as np

import kfmaps
from kfmaps.kernels.landmark_selection import farthest_descriptors
from kfmaps.viz import Panel, grid_figure, match_figure

pair = kfmaps.datasets.two_poses(vertices=2000)
marked = farthest_descriptors(pair.target.vertices, 6)
landmarks = np.stack([pair.truth[marked], marked], axis=1)
config = replace(
    kfmaps.Config.single_fit(),
    basis=kfmaps.BasisConfig(n_eigenfunctions=60),
    descriptors=kfmaps.DescriptorConfig(n_eigenfunctions=100, shot=False),
    nystrom=kfmaps.NystromConfig(samples=200),
    refinement=kfmaps.ZoomOut(start=30, stop=100, step=5),
)
source, target = kfmaps.prepare(pair.source, config), kfmaps.prepare(pair.target, config)
result = kfmaps.match(source, target, config, landmarks=landmarks)

# %%
# Labels: each source vertex belongs to the landmark nearest to it along the surface.

parts = kfmaps.geodesic_distances(pair.source, landmarks[:, 0]).argmin(axis=0)
parts_on_target = kfmaps.transfer(parts, result)
print("labels:", parts.shape, "->", parts_on_target.shape)

palette = np.array([[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167], [230, 159, 0], [86, 180, 233]]) / 255
figure = match_figure(pair.source, pair.target, result.target_to_source, colors=palette[parts])

# %%
# They are right where the map's label is that of the true vertex.

agreement = float((parts_on_target == parts[pair.truth]).mean())
print(f"labels that agree with the truth: {100 * agreement:.1f} %")

# %%
# A function: the height on the source, carried by the functional map. Few coefficients make it smooth, so the result is
# judged by the share of the variance that it explains.

k_t, k_s = result.functional_map.shape
height = pair.source.vertices[:, 1:2]
coefficients = source.basis.truncate(k_s).project(height)
by_matrix = target.basis.truncate(k_t).reconstruct(result.functional_map @ coefficients)[:, 0]
true_height = height[pair.truth, 0]
explained = 1 - np.mean((by_matrix - true_height) ** 2) / np.var(true_height)
print(f"height by the functional map ({k_t} × {k_s}): {100 * explained:.2f} % of the variance")

# %%
# The colours of both, by the map and by the truth.

figure_truth = grid_figure(
    pair.source,
    [Panel("by the map", pair.target, result.target_to_source), Panel("by the truth", pair.target, pair.truth)],
    colors=palette[parts],
    columns=3,
)

# %%
assert agreement > 0.95
assert explained > 0.99
