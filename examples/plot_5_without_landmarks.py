"""
Without landmarks
=================

Only two meshes are given. The creature is mirror-symmetric, so a map that swaps left and right preserves all lengths as
well as the right one. Many candidates are refined and scored without the truth. The result has the best map, distinct
alternatives, and the probability that the map is right.
"""

from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np

import kfmaps
from kfmaps.viz import draw_surface, position_colors, true_views

pair = kfmaps.datasets.symmetric_creature(vertices=2000)

# %%
# ``Config()`` is the default of :func:`kfmaps.match`. Only its sizes are reduced here.

recommended = kfmaps.Config()
config = replace(
    recommended,
    basis=kfmaps.BasisConfig(n_eigenfunctions=60),
    descriptors=replace(recommended.descriptors, n_eigenfunctions=100),
    search=kfmaps.Search(candidates=3),
    refinement=kfmaps.ZoomOut(start=50, stop=100, step=5, descriptor_weight=36.0),
)
result = kfmaps.match(pair.source, pair.target, config)

print(f"verdict: {result.verdict}, confidence {result.confidence:.2f}")
print("scores of the map and of the alternatives:", [round(float(score), 2) for score in result.score.scores])


# %%
# Two truths are known: the direct one, and the one that swaps the sides.


def mean_error(points, truth):
    return kfmaps.geodesic_errors(pair.source, points, truth).mean()


direct, swapped = (mean_error(result.target_to_source, truth) for truth in (pair.truth, pair.mirrored))
print(f"the map: mean error x 100: {100 * direct:.2f} against the truth, {100 * swapped:.2f} against the mirrored one")
for i, points in enumerate(result.alternatives):
    errors = [100 * mean_error(points, truth) for truth in (pair.truth, pair.mirrored)]
    print(f"alternative {i + 1}: {errors[0]:.2f} and {errors[1]:.2f}")

# %%
# All shapes are drawn from the same side, in the source's colours. A map that swaps the sides gives each arm the
# colours of the other.

view_s, view_t = true_views(pair.source, pair.target, pair.truth, np.arange(len(pair.truth)))
colors = position_colors(pair.source)
shown = {"source": (pair.source, colors, view_s), "the answer": (pair.target, colors[result.target_to_source], view_t)}
for i, points in enumerate(result.alternatives):
    shown[f"alternative {i + 1}"] = (pair.target, colors[points], view_t)

figure, axes = plt.subplots(1, len(shown), figsize=(2.2 * len(shown), 3.2), layout="constrained")
for ax, (label, (mesh, painted, view)) in zip(axes, shown.items(), strict=True):
    draw_surface(ax, mesh, painted, view)
    ax.set_title(label, fontsize=10)

# %%
assert direct < 0.05 < swapped
