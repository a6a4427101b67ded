"""
A kernel learned from pairs
===========================

The weights of the descriptors, the bandwidth of the kernel and the weights of the terms decide what a map preserves.
Here they are learned from two pairs of shapes with known correspondences, and tested on another pair. Learning needs
PyTorch (``pip install 'kfmaps[learn]'``); using the result does not.
"""

from dataclasses import replace

import kfmaps
from kfmaps.kernels.landmark_selection import farthest_descriptors

# Learning begins as this configuration, with ten descriptors and a map of 40 by 40.
config = replace(
    kfmaps.Config.single_fit(),
    basis=kfmaps.BasisConfig(n_eigenfunctions=40),
    descriptors=kfmaps.DescriptorConfig(n_spectral=10, n_eigenfunctions=60, shot=False),
    nystrom=kfmaps.NystromConfig(samples=100),
    refinement=None,
)


def creature(number):
    """A creature in two poses: both shapes prepared, their true correspondence, six landmarks."""
    made = kfmaps.datasets.two_poses(vertices=1500, rng=number)
    marked = farthest_descriptors(made.target.vertices, 6)
    landmarks = [(int(made.truth[v]), int(v)) for v in marked]
    return kfmaps.prepare(made.source, config), kfmaps.prepare(made.target, config), made, landmarks


# %%
# Learning takes the descriptors and the truth of each pair. It changes the width γ of the kernel, a metric on the
# descriptors, and the weights of the energy's terms, so that the expected error of the map falls on two pairs. The
# third pair decides when to stop.

pairs = []
for number in (1, 2, 3):
    source, target, made, landmarks = creature(number)
    truth = (made.truth, range(len(made.truth)))
    pairs.append(kfmaps.learn.training_pair(source, target, config, landmarks=landmarks, truth=truth, samples=60))

model = kfmaps.learn.Model(config, pairs[:2], rank={"signature": 4, "landmark": 1})
training = kfmaps.learn.TrainingOptions(epochs=8, patience=6)
state = kfmaps.learn.learn(model, pairs[:2], pairs[2:], training)
learned = model.settings()
print(learned.kernel, learned.weights, sep="\n")

# %%
# The losses of each epoch. The ring marks the state that was kept, the best on the held-out pair.

figure = kfmaps.learn.learning_figure(state.history)

# %%
# A fourth pair, which had no part in learning, with the settings before and after:

source, target, made, landmarks = creature(4)
means = {}
for name, settings in (("before", config), ("learned", learned)):
    result = kfmaps.match(source, target, settings, landmarks=landmarks)
    means[name] = kfmaps.geodesic_errors(made.source, result.target_to_source, made.truth).mean()
    print(f"{name:8} mean error {100 * means[name]:.2f} % of √area")

# %%
# The weights are plain numbers: ``kfmaps learn`` writes them to a settings file for ``kfmaps match --config``.

assert means["learned"] < 0.97 * means["before"]
