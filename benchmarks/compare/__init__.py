"""The tree as it is beside the tree at a git revision, in one run."""
