"""
A kernel learned from a pair
============================

What the map preserves is a choice: which descriptors count, how sharply, and how much each term of the energy weighs. Here
these numbers are learned from one pair of shapes whose true correspondence is known, and tried on another pair. This
needs PyTorch (``pip install 'kfmaps[learn]'``); what was learned does not.
"""

import kfmaps
from kfmaps.kernel.select import farthest

# The learned part begins as this configuration, with ten descriptors and a map of 30 by 30.
config = kfmaps.Config(
    basis=kfmaps.BasisConfig(functions=30),
    descriptors=kfmaps.DescriptorConfig(count=10, eigenfunctions=60),
    nystrom=kfmaps.NystromConfig(samples=100),
    refinement=None,
)


def pair(number):
    """Two prepared shapes, their true correspondence, and six landmarks."""
    made = kfmaps.datasets.non_isometric(vertices=1500, rng=number)
    marked = farthest(made.target.vertices, 6)
    landmarks = [(int(made.truth[v]), int(v)) for v in marked]
    return kfmaps.prepare(made.source, config), kfmaps.prepare(made.target, config), made, landmarks


# %%
# Learning wants what a pair offers: descriptors, and the truth. It changes the width γ of the kernel, a weight for each
# descriptor, and the weights of the energy's terms, so that the expected error of the map falls.

lessons = []
for number in (1, 2):
    source, target, made, landmarks = pair(number)
    truth = (made.truth, range(len(made.truth)))
    lessons.append(kfmaps.learn.lesson(source, target, config, landmarks=landmarks, truth=truth, samples=60))

model = kfmaps.learn.Model(config, lessons, ["gamma", "ard", "terms"])
state = kfmaps.learn.learn(model, lessons[:1], lessons[1:], kfmaps.learn.Training(epochs=8, rate=0.2))
learned = model.settings()
print(learned.kernel, learned.weights, sep="\n")

# %%
# How it went, epoch by epoch; the ring marks the state that was kept, the best on the pair held out.

figure = kfmaps.learn.learning_figure(state.history)

# %%
# On a third pair, which had no part in it, the settings before and after:

source, target, made, landmarks = pair(3)
means = {}
for name, settings in (("before", config), ("learned", learned)):
    result = kfmaps.match(source, target, settings, landmarks=landmarks)
    means[name] = kfmaps.geodesic_errors(made.source, result.target_to_source, made.truth).mean()
    print(f"{name:8} mean error {100 * means[name]:.2f} % of √area")

# %%
# The weights are plain numbers, and a settings file holds them: ``kfmaps learn`` writes one for ``kfmaps match --config``.

assert means["learned"] < means["before"]
