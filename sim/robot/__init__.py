"""Astrid: her body, what her sensors make of the world, and the algorithms that tell where she is and drive her."""
