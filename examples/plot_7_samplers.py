"""
How samples for Nyström are chosen
==================================

The kernel between all vertices of two shapes is a matrix with millions of entries. Nyström's method replaces it by one
of low rank, from its values at some samples. The error depends on the samples.
"""

import matplotlib.pyplot as plt
import numpy as np

import kfmaps
from kfmaps.descriptors.spectral import normalize, wave_energies, wave_signature
from kfmaps.geometry.geodesics import farthest_geodesic
from kfmaps.geometry.mesh import unit_area
from kfmaps.kernels.landmark_selection import farthest_descriptors, pivoted_cholesky, uniform
from kfmaps.kernels.nystrom import nystrom

pair = kfmaps.datasets.two_poses(vertices=1500)
meshes = [unit_area(mesh) for mesh in (pair.source, pair.target)]
bases = [kfmaps.laplace_basis(mesh, 80) for mesh in meshes]

# %%
# The descriptors: 50 energies of the wave kernel signature, the same energies on both shapes, each with a maximum of 1.
# Here the kernel of all vertices of both shapes is small enough to be stored.

energies, sigma = wave_energies(50, *bases)
signatures = [wave_signature(basis, energies, sigma) for basis in bases]
D_s, D_t = normalize(signatures[0], signatures[1], "max", bases[0].mass, bases[1].mass)
D = np.concatenate([D_s, D_t])
kernel = kfmaps.Gaussian(gamma=1.0)
K = kernel(D, D)

# %%
# No matrix of rank r is closer to K than the one with its first r eigenpairs. That is the bound.

eigenvalues = np.sort(np.abs(np.linalg.eigvalsh(K)))[::-1]
bound = np.sqrt(np.cumsum(eigenvalues[::-1] ** 2)[::-1]) / np.linalg.norm(K)


def halves(choose, count):
    """Half of the samples from each shape, as in section 6.2 of the paper."""
    return np.concatenate([choose(0, count // 2), len(D_s) + choose(1, count // 2)])


sides = (D_s, D_t)
samplers = {
    "uniform": lambda q: halves(lambda i, half: uniform(len(sides[i]), half), q),
    "farthest, along the surface": lambda q: halves(lambda i, half: farthest_geodesic(meshes[i], half), q),
    "farthest, between descriptors": lambda q: halves(lambda i, half: farthest_descriptors(sides[i], half), q),
    "pivoted Cholesky": lambda q: pivoted_cholesky(kernel, D, q),
}
ranks = [20, 40, 80, 160, 320]


def relative_error(rows):
    W = nystrom(kernel, D[rows]).features(D)
    return np.linalg.norm(K - W @ W.T) / np.linalg.norm(K)


found = {name: np.array([relative_error(sampler(q)) for q in ranks]) for name, sampler in samplers.items()}

# %%
# Errors of Nyström against the number of samples.

figure, ax = plt.subplots(figsize=(6, 4), layout="constrained")
styles = zip(("o-", "s--", "^-.", "D:"), ("#D55E00", "#009E73", "#0072B2", "#CC79A7"), strict=True)
for (name, values), (style, color) in zip(found.items(), styles, strict=True):
    ax.semilogy(ranks, values, style, color=color, label=name)
    print(f"{name:30}", "  ".join(f"{value:.1e}" for value in values))
ax.semilogy(ranks, bound[ranks], "-", color="black", linewidth=1, label="best possible of that rank")
ax.set_xlabel("samples, of both shapes together")
ax.set_ylabel("relative error, Frobenius norm")
ax.spines[["top", "right"]].set_visible(False)
figure.legend(loc="outside lower center", ncols=2, frameon=False)

# %%
# Nothing is better than the bound. With few samples random ones are best: they lie where most vertices are, while the
# others begin with the extremes. With many samples the others are better by a factor of tens.

assert all(np.all(values >= 0.999 * bound[ranks]) for values in found.values())
assert found["farthest, between descriptors"][-1] < 0.1 * found["uniform"][-1]
assert found["pivoted Cholesky"][-1] < 0.1 * found["uniform"][-1]
