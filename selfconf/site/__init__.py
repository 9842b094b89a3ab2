"""A site: the init-component of a host (section 2.1 of the paper).

`Shelf` reads the advertisements of the host from their files; `Site` serves them to an ecology, and starts and ends the
processes of the host's dormant components, by its `ProcessSettings`. `programs_of` says which components share a
process. `forget_oldest` removes logs of sites that have ended; `log_part` reads one, while it is written.
"""

from selfconf.site.kept_log import log_part
from selfconf.site.log_file import forget_oldest
from selfconf.site.processes import ProcessSettings, programs_of
from selfconf.site.shelf import Shelf
from selfconf.site.site import Site

__all__ = ["ProcessSettings", "Shelf", "Site", "forget_oldest", "log_part", "programs_of"]
