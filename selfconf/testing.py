"""Trying a component or a task without a network."""
