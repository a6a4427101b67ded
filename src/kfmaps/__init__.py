"""Kernel functional maps: which point of one 3D surface corresponds to which point of another."""

__version__ = "0.1.0"
