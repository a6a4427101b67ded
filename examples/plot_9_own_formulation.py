"""
A formulation of your own
=========================

This penalty, a group lasso, is not in the package: it keeps few rows of the map. It needs a value and a quadratic term
that lies above it and touches it at the current map. The package provides the rest: kernel, constraint and solver.
"""

from dataclasses import dataclass, replace

import numpy as np

import kfmaps
from kfmaps.fmap.minimize import MinimizeOptions, Objective, minimize
from kfmaps.fmap.terms import Elementwise
from kfmaps.matching.assemble import assemble
from kfmaps.matching.fit import fit_points


@dataclass(frozen=True, eq=False)
class FewRows:
    """``Σ_a √(Σ_b C_ab² + ε²)``, smoothed where a row vanishes."""

    smoothing: float = 1e-3

    def value(self, C):
        return float(np.sqrt((C * C).sum(axis=1) + self.smoothing**2).sum())

    def majorizer(self, C):
        # √x lies below its tangent: the weights ½ / √x, doubled, since a term is half a squared residual.
        rows = np.sqrt((C * C).sum(axis=1) + self.smoothing**2)
        return Elementwise(np.broadcast_to(1 / rows[:, None], C.shape))


# %%
# The energy of a pair is made as in :func:`kfmaps.match`; the penalty is added to it.

pair = kfmaps.datasets.two_poses(vertices=1500)
config = replace(kfmaps.Config.single_fit(), basis=kfmaps.BasisConfig(n_eigenfunctions=40), refinement=None)
source, target = (kfmaps.prepare(mesh, config) for mesh in (pair.source, pair.target))
marks = np.stack([pair.truth[::300], np.arange(len(pair.truth))[::300]], axis=1)
points = fit_points(source, target, config, marks)
task = assemble(*points.shapes, points.bases, points.descriptors, config, np.random.default_rng(0), (source, target))

how = MinimizeOptions(config.solver)
plain = minimize(Objective(task.energy), how).value
few = minimize(Objective(task.energy, {"rows": (0.1, FewRows())}), how).value
used = [int((np.linalg.norm(C, axis=1) > 0.05).sum()) for C in (plain, few)]
print(f"rows in use: {used[0]} by least squares, {used[1]} with the penalty")
assert used[1] < used[0]
