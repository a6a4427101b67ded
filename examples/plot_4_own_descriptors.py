"""
Descriptors of your own
=======================

``descriptors=(D_s, D_t)`` takes two arrays with one row per vertex and the same columns on both shapes, measured or
learned. They are used in addition to those of the configuration, or alone. Here they are the distances along the
surface to four landmarks.
"""

from dataclasses import replace

import numpy as np

import kfmaps
from kfmaps.geometry.mesh import surface_area
from kfmaps.kernels.landmark_selection import farthest_descriptors
from kfmaps.viz import match_figure

pair = kfmaps.datasets.two_poses(vertices=2000)
marked = farthest_descriptors(pair.target.vertices, 4)
landmarks = np.stack([pair.truth[marked], marked], axis=1)

# %%
# Descriptors have to mean the same on both shapes. Distances are divided by the square root of each shape's area, so
# that units do not matter. A bump around each landmark emphasises points near it.


def described(mesh, vertices):
    distances = kfmaps.geodesic_distances(mesh, vertices).T / np.sqrt(surface_area(mesh))
    return np.hstack([distances, np.exp(-((distances / 0.3) ** 2))])


D_s, D_t = described(pair.source, landmarks[:, 0]), described(pair.target, landmarks[:, 1])
print("shapes:", D_s.shape, D_t.shape)

# %%
# Used alone, without signature and landmark maps. No ``landmarks`` are passed either; the descriptors contain them.

alone = replace(
    kfmaps.Config.single_fit(),
    basis=kfmaps.BasisConfig(n_eigenfunctions=50),
    descriptors=kfmaps.DescriptorConfig(signature="none", landmark_descriptor="none", n_eigenfunctions=80, shot=False),
    nystrom=kfmaps.NystromConfig(samples=200),
    refinement=kfmaps.ZoomOut(start=30, stop=100, step=5),
)
source, target = kfmaps.prepare(pair.source, alone), kfmaps.prepare(pair.target, alone)
result = kfmaps.match(source, target, alone, descriptors=(D_s, D_t))
errors = kfmaps.geodesic_errors(pair.source, result.target_to_source, pair.truth)
figure = match_figure(pair.source, pair.target, result.target_to_source, errors=errors)

# %%
# Used together with the wave kernel signature.

both = replace(alone, descriptors=kfmaps.DescriptorConfig(n_spectral=50, n_eigenfunctions=80, shot=False))
beside = kfmaps.match(source, target, both, descriptors=(D_s, D_t))
errors_beside = kfmaps.geodesic_errors(pair.source, beside.target_to_source, pair.truth)

print(f"mean error x 100: {100 * errors.mean():.2f} alone, {100 * errors_beside.mean():.2f} with the signature")
assert errors.mean() < 0.02
