"""Many maps, judged without the truth."""
