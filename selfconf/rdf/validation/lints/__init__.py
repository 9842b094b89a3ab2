"""Checks of a well-formed file that no shape can make, by what they look at."""
