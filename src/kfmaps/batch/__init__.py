"""Whole collections: which pairs, prepared shapes kept, matching in parallel, results and a summary."""
