"""The search beside general solvers."""
