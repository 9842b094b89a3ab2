"""Lints: what reads well and is probably not what was meant.

`all_lints` has the tables of them, and says which run. Each looks at a `linted_file`; what its shapes ask of a node is
put together by `normal_form`, and `contradictions` are found in that.
"""
