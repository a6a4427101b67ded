"""Transfer of functions beyond the span of the basis, through products of basis functions.

A functional map of k functions transfers only their span. But a map that comes from a point map preserves products:
``T(fg) = T(f) T(g)``. So a function is written in the basis *and* in products of basis functions, by least squares, and
its image is the same combination of the images of the basis functions and of their products (Nogneng, Melzi, Rodolà,
Castellani, Bronstein and Ovsjanikov, Improved functional mappings via product preservation, 2018). It is a closed form
in C.
"""

from __future__ import annotations

import numpy as np

from kfmaps._arrays import Array, check, check_count, check_positive, namespace, refuse, take
from kfmaps.geometry.basis import Basis


def transfer_functions(
    values: Array, C: Array, source: Basis, target: Basis, products: int | None = 20, ridge: float = 0.1
) -> Array:
    """Return the images ``(n_t, d)`` on the target of functions on the source.

    Parameters
    ----------
    values : (n_s, d) or (n_s,)
    C : (k_t, k_s)
    source, target : Basis
        Of at least that many functions.
    products : int or None
        How many of the first functions are multiplied with each other; ``None`` gives ``Φ_t C Φ_sᵀ A_s f``, what the
        functional map alone carries. The constant, with which a product is nothing new, is left out.
    ridge : float
        Damping of the products' coefficients against unit norm of each product: they are far from independent, and
        their images are not exact.

    Raises
    ------
    InvalidInput
        When shapes do not fit, or more functions are to be multiplied than ``C`` carries.
    """
    xp = namespace(C)
    k_t, k_s = C.shape
    single = len(values.shape) == 1
    values = values[:, None] if single else values
    source, target = source.truncate(k_s), target.truncate(k_t)
    check(values, "values", shape=(source.functions.shape[0], None), remedy="give one row per source vertex")
    coefficients = source.project(values)
    images = target.functions @ C
    found = images @ coefficients
    if products is not None:
        check_count(products, "products", low=2)
        check_positive(ridge, "ridge")
        if products > k_s:
            raise refuse("products", f"at most the {k_s} functions that the map carries", str(products), "lower it")
        on_s, on_t = _function_pairs(source.functions, products), _function_pairs(images, products)
        # Of unit norm on the source, and the same divisor for the image.
        weights = source.mass[:, None]
        norms = xp.sqrt(xp.sum(weights * on_s * on_s, axis=0))
        norms = xp.where(norms > 0, norms, xp.ones_like(norms))[None, :]
        on_s, on_t = on_s / norms, on_t / norms
        # The basis takes all it can; the products explain what is left. Both at once, the basis undamped, is the
        # same problem with the products' parts in the basis taken out.
        inside = source.project(on_s)
        rest = on_s - source.reconstruct(inside)
        left = values - source.reconstruct(coefficients)
        gram = rest.T @ (weights * rest)
        eye = xp.eye(gram.shape[0], dtype=gram.dtype, device=gram.device)
        share = xp.linalg.solve(gram + ridge * eye, rest.T @ (weights * left))
        found = found + on_t @ share - images @ (inside @ share)
    return found[:, 0] if single else found


def _function_pairs(functions: Array, count: int) -> Array:
    """Products ``(n, m)`` of two of the columns 1 to ``count`` of ``functions``, the first (the constant) left out."""
    first, second = np.triu_indices(count - 1)
    return take(functions, first + 1, axis=1) * take(functions, second + 1, axis=1)
