"""
A kernel of your own
====================

Any callable that returns ``(n, m)`` values for ``(n, d)`` and ``(m, d)`` arrays is a kernel, so those of scikit-learn
can be passed as they are. A kernel should be positive definite; otherwise its negative part is dropped, with a warning.
"""

from dataclasses import replace

import numpy as np
from sklearn.gaussian_process.kernels import RationalQuadratic
from sklearn.metrics.pairwise import rbf_kernel

import kfmaps
from kfmaps.kernels.landmark_selection import farthest_descriptors
from kfmaps.viz import match_figure

pair = kfmaps.datasets.two_poses(vertices=2000)
marked = farthest_descriptors(pair.target.vertices, 4)
landmarks = [(int(pair.truth[v]), int(v)) for v in marked]
base = replace(
    kfmaps.Config.single_fit(),
    basis=kfmaps.BasisConfig(n_eigenfunctions=50),
    descriptors=kfmaps.DescriptorConfig(n_spectral=20, n_eigenfunctions=80, shot=False),
    nystrom=kfmaps.NystromConfig(samples=150),
    refinement=None,
)
source, target = kfmaps.prepare(pair.source, base), kfmaps.prepare(pair.target, base)


def matched(kernel):
    return kfmaps.match(source, target, replace(base, kernel=kernel), landmarks=landmarks)


# %%
# First a check: scikit-learn's Gaussian kernel gives the same map as the package's own. Its γ must be given, since the
# package cannot know how a foreign kernel depends on it.


def gaussian(X, Y):
    return rbf_kernel(X, Y, gamma=0.15)


theirs, ours = matched(gaussian), matched(kfmaps.Gaussian(gamma=0.15))
difference = np.abs(theirs.functional_map - ours.functional_map).max()
print(f"largest difference of the two functional maps: {difference:.1e}")
print("named in the result:", theirs.fit.kernel)

# %%
# The rational quadratic kernel, a mixture of Gaussian kernels of every width, is one that the package does not have.

mixture = RationalQuadratic(length_scale=2.0, alpha=1.0)
result = matched(mixture)
errors = kfmaps.geodesic_errors(pair.source, result.target_to_source, pair.truth)
print(f"rational quadratic: {result.fit.rank} features, mean error x 100: {100 * errors.mean():.2f}")
figure = match_figure(pair.source, pair.target, result.target_to_source, errors=errors)

# %%
# A kernel can also be a function of your own. This one compares ten descriptors with a Gaussian kernel and the other
# ten linearly; the sum of two kernels is a kernel.


def halves(X, Y):
    near = kfmaps.Gaussian(gamma=0.3)(X[:, :10], Y[:, :10])
    return near + X[:, 10:] @ Y[:, 10:].T


own = kfmaps.geodesic_errors(pair.source, matched(halves).target_to_source, pair.truth)
print(f"a kernel of two halves: mean error x 100: {100 * own.mean():.2f}")

assert difference < 1e-6
assert max(errors.mean(), own.mean()) < 0.03
