"""Whole collections: choice of pairs, a cache of prepared shapes, parallel matching, results and a summary."""
