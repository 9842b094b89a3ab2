"""Lints: what reads well and is probably not what was meant. `all_lints` has the tables of them, and says which run."""
