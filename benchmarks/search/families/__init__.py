"""Families of problems, each instance made from its parameters and a seed, the same on every machine."""
