"""
Without landmarks
=================

Nothing is given but two meshes. The creature is its own mirror image, so a map that swaps left and right keeps all
lengths just as well as the right one. Many candidates are refined and judged without the truth; the answer names the
best, the distinct others, and how clear the decision was.
"""

from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np

import kfmaps
from kfmaps.viz import draw_surface, position_colors, true_views

pair = kfmaps.datasets.symmetric_creature(vertices=2000)

# %%
# ``Config()`` is what :func:`kfmaps.match` uses by itself when there are no landmarks. Only its sizes are
# reduced here.

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
print("scores of the map and of the runners-up:", [round(float(score), 2) for score in result.score.scores])


# %%
# The truth is known for both: the direct one, and the one that swaps the sides.


def mean_error(points, truth):
    return kfmaps.geodesic_errors(pair.source, points, truth).mean()


direct, swapped = (mean_error(result.target_to_source, truth) for truth in (pair.truth, pair.mirrored))
print(f"the map: mean error x 100: {100 * direct:.2f} against the truth, {100 * swapped:.2f} against the mirrored one")
for i, points in enumerate(result.alternatives):
    errors = [100 * mean_error(points, truth) for truth in (pair.truth, pair.mirrored)]
    print(f"runner-up {i + 1}: {errors[0]:.2f} and {errors[1]:.2f}")

# %%
# All from the same side, in the source's colours. A map that swaps the sides gives each arm the colours of the other;
# others go wrong in a part of the body.

view_s, view_t = true_views(pair.source, pair.target, pair.truth, np.arange(len(pair.truth)))
colors = position_colors(pair.source)
shown = {"source": (pair.source, colors, view_s), "the answer": (pair.target, colors[result.target_to_source], view_t)}
for i, points in enumerate(result.alternatives):
    shown[f"runner-up {i + 1}"] = (pair.target, colors[points], view_t)

figure, axes = plt.subplots(1, len(shown), figsize=(2.2 * len(shown), 3.2), layout="constrained")
for ax, (label, (mesh, painted, view)) in zip(axes, shown.items(), strict=True):
    draw_surface(ax, mesh, painted, view)
    ax.set_title(label, fontsize=10)

# %%
assert direct < 0.05 < swapped
