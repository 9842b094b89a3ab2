"""`python -m selfconf.query`: the process that answers one SPARQL question, which comes in on standard input."""

import sys

from selfconf.query.process import main

sys.exit(main())
