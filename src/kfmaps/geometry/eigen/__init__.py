"""Sparse eigenpairs: pencil, factorisation, block Lanczos."""
