"""pySHACL and rdflib corrected, where they depart from the recommendations or take longer than they have to.

Within `corrected` they judge shapes that others write, with all corrections. Of these `only_ordered`, by which only
literals that have an order are compared, and `index_constraints`, by which constraints are looked up by hash, serve
also alone. `replaced` gives modules and classes of the libraries something else under a name while a block lasts.
"""

from selfconf.rdf.pyshacl_corrections.all_corrections import corrected
from selfconf.rdf.pyshacl_corrections.constraint_lookup import index_constraints
from selfconf.rdf.pyshacl_corrections.library_patches import replaced
from selfconf.rdf.pyshacl_corrections.ordered_literals import only_ordered

__all__ = ["corrected", "index_constraints", "only_ordered", "replaced"]
