"""What goes into the package and its environments: the pinned versions, and the bill of materials in the wheel."""
