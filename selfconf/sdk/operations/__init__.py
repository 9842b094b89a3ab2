"""The operations of a component: those that others call (`OfferedOperations`), and those that it calls itself
(`NeededOperations`).

A call is a question on the key of the operation, and its answer the only reply. What is sent along travels as a signal
does, and so does the answer (`OperationSignals`).

*At most once.* A call is made once. If it comes to nothing, the caller may not know whether the component was about to
do what it was asked: so it receives what is known, and nothing is repeated on its behalf.

*Bounds.* A request and an answer have at most `MOST_PAYLOAD` bytes; at most `MOST_CALLS` requests wait for the code of
a component, or for its futures, and at most as many of its own calls for their answers.
"""

from selfconf.sdk.operations.needed_operations import NeededOperations
from selfconf.sdk.operations.offered_operations import OfferedOperations
from selfconf.sdk.operations.operation_signals import MOST_CALLS, MOST_PAYLOAD, OperationSignals

__all__ = ["MOST_CALLS", "MOST_PAYLOAD", "NeededOperations", "OfferedOperations", "OperationSignals"]
