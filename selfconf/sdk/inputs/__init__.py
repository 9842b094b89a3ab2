"""The inputs of one component: which outputs they follow, what waits to be read, and when one of them is unfed.

`Inputs` does as the calls of configurators say, and tells its component by `InputEvents`; what does so in its place is
an `InputFollower`.
"""

from selfconf.sdk.inputs.inputs import InputFollower, Inputs
from selfconf.sdk.inputs.signal_input import InputEvents

__all__ = ["InputEvents", "InputFollower", "Inputs"]
