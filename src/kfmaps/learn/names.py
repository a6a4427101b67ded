"""What can be learned, and by which losses: names that the command's help shows without PyTorch."""

PARTS = {
    "gamma": "the width γ of the kernel",
    "ard": "a weight for each descriptor",
    "metric": "a low-rank metric M = L Lᵀ on the descriptors",
    "mixture": "shares of kernels of several widths",
    "terms": "the weights of the energy's terms",
    "network": "a small network on the signature and SHOT",
}

LOSSES = {
    "geodesic": "expected geodesic error of the soft point map",
    "supervised": "distance from the functional map of the truth",
    "orthogonality": "how far the map is from keeping areas",
    "cycle": "how far there and back is from where one was",
    "commutativity": "how far the map is from an isometry's",
    "coupling": "how far the map is from the soft point map of the features",
}

SUPERVISED = ("geodesic", "supervised")
"""Losses that need the truth."""
