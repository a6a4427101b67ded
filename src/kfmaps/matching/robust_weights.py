"""Which landmarks or descriptors are to be believed: weights from a small robust fit.

A wrong landmark spoils every value of a kernel of all descriptors, so the loss cannot wait until the kernel is formed.
With the *linear* kernel, on the other hand, the energy is a sum over descriptors, and a robust loss of the sum over
each landmark's (or of each descriptor) is minimised by reweighting alone, its value falling in every round
(:class:`kfmaps.fmap.losses.RobustData`). Its weights then scale the descriptors before the kernel of the fit is
formed, whichever it is: what is weighed at zero is as good as not there.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from kfmaps._arrays import like, refuse
from kfmaps.config import Config
from kfmaps.fmap.energy import Energy
from kfmaps.fmap.losses import Loss, RobustData
from kfmaps.fmap.minimize import MinimizeOptions, Objective, minimize
from kfmaps.fmap.multiplication_operators import multiplication_operators, unpack_operators
from kfmaps.fmap.solvers import CG
from kfmaps.fmap.terms import laplacian_term
from kfmaps.geometry.basis import Basis
from kfmaps.matching.features import Descriptors


def robust_weights(
    descriptors: Descriptors, bases: tuple[Basis, Basis], config: Config
) -> tuple[Descriptors, np.ndarray]:
    """Return ``descriptors`` times square roots of the weights of a robust loss, and the weights (g,).

    They are those of landmarks or of descriptors. ``descriptors``: those of no landmark keep their size when the loss
    is per landmark; ``config``: its formulation and weights count.
    """
    asked = config.formulation
    if asked.loss_group == "landmark":
        groups = descriptors.landmark
        if not (groups >= 0).any():
            raise refuse("loss per landmark", "landmarks with maps of their own", "none", "take it per descriptor")
    else:
        groups = np.arange(descriptors.source.shape[1])
    functions = 30  # size of the small fit: enough to tell a wrong landmark, a tenth of the work of the fit itself
    k = min(functions, config.basis.n_eigenfunctions)
    small = [basis.truncate(k) for basis in bases]
    sides = (descriptors.source, descriptors.target)
    P = [basis.project(D) for basis, D in zip(small, sides, strict=True)]
    X = [
        unpack_operators(multiplication_operators(b, D, threads=config.threads))
        for b, D in zip(small, sides, strict=True)
    ]
    weights = config.weights
    against = weights.descriptors or 1.0
    data = RobustData(P[0], P[1], groups, Loss("squared"), X[0], X[1], weights.commutativity / against)
    alone = Energy(
        {"laplacian": laplacian_term(small[0], small[1])}, {"laplacian": max(weights.laplacian / against, 1e-6)}
    )
    how = MinimizeOptions(CG(rtol=1e-4, max_iter=500), max_outer_iter=asked.max_outer_iter, rtol=1e-3)
    C = minimize(Objective(alone, {"data": (1.0, data)}), replace(how, max_outer_iter=1)).value
    robust = replace(data, loss=Loss(asked.loss)).scaled(C, asked.loss_scale)
    C = minimize(Objective(alone, {"data": (1.0, robust)}), how, C).value
    columns = robust.weights(C)
    columns = np.where(groups < 0, 1.0, columns / max(1.0, float(columns[groups >= 0].max())))
    root = like(np.sqrt(columns), descriptors.source)[None, :]
    scaled = replace(descriptors, source=descriptors.source * root, target=descriptors.target * root)
    first = np.unique(groups, return_index=True)
    return scaled, columns[first[1][first[0] >= 0]]
