"""`python -m selfconf.query`: the process that answers one SPARQL question, which comes in on standard input.

With the number of a socket as its argument it is a standing process, which answers many.
"""

import gc
import sys

if len(sys.argv) > 1:
    from selfconf.query import standing_process

    code = standing_process.main(int(sys.argv[1]))
else:
    from selfconf.query import process

    code = process.main()
gc.freeze()  # what is left ends with the process, and need not be looked through for garbage
sys.exit(code)
