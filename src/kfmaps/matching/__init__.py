"""One fit of two prepared shapes."""
