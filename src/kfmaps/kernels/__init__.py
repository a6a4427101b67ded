"""Kernels, and the low rank that stands for them: knows of arrays alone."""
