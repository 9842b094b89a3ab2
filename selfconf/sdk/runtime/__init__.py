"""What joins one component to the bus: its life, the control calls that it obeys, and the watch over who calls.

A `ComponentRuntime` is all of that; the other modules of this room are its parts.
"""

from selfconf.sdk.runtime.runtime import ComponentRuntime

__all__ = ["ComponentRuntime"]
