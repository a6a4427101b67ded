"""Check the memory that a fit needs before it is computed."""

from __future__ import annotations

from kfmaps._memory import check_memory
from kfmaps.config import Config


def check_match_memory(config: Config, n_s: int, n_t: int, landmarks: int = 0) -> None:
    """Refuse numbers of descriptors or samples whose arrays do not fit into the machine's memory.

    Only arrays that cannot be avoided are counted. ``n_s`` and ``n_t``: vertices of source and target; ``landmarks``:
    number of landmarks, each of which makes at least one descriptor.
    """
    most = config.fit_samples or max(n_s, n_t)
    rows = min(n_s, most) + min(n_t, most)
    count = max(config.descriptors.n_spectral, landmarks)
    remedy = "lower descriptors.n_spectral; 100 are usual"
    check_memory(8.0 * rows * count, "settings", f"{count:,} descriptors of {rows:,} points", remedy)
    samples = min(config.nystrom.samples, n_s + n_t)
    remedy = "lower nystrom.samples; 400 are usual"
    need = 8.0 * samples * (samples + rows)
    check_memory(need, "settings", f"{samples:,} Nyström samples of {rows:,} points", remedy)
