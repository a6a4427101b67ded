"""Many shapes at once: which pairs to match, maps that agree over cycles, and what a collection tells."""
