"""The search for a configuration: the problem, the paper's algorithm, the exact solver, and why there is no answer."""
