"""Matching a part of a shape to the whole: by distances and SHOT between samples, then by bending the part onto it."""
