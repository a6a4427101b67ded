"""The functional map: its energy, its solvers, its points, its refinement and evaluation."""
