"""How many components are recruited, and how long that takes, beside general solvers."""
