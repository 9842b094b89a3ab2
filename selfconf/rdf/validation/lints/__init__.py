"""Lints: what reads well and is probably not what was meant."""
