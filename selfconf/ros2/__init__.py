"""Messages, services and actions of ROS 2 as they travel, without ROS 2: for the bridge, the importer and the SDK.

A `MessageType` is a type by its name and hash. `message` writes fields as CDR, `message_fields` reads them, and
`check_message` looks whether that can be done; `received` reads a signal whose media type says that it is a message
(`read_media`, a `MessageMedia`). `NAME` and `HASH` are how the name and the hash of a type look. `usual_type` is the
type of a name, `service_parts` what a service is asked and answers (`ServiceParts`), and `is_known` whether the fields
are known: of more types once `learn` has read the definitions in folders, such as the `named_folders`. A `MessageError`
says what cannot be written or read. `load` has all that loaded ahead of its first use. The names of parts end in
`REQUEST` and `RESPONSE` for a service, in `GOAL` and `RESULT` for an action, and in `SEND_GOAL`, `GET_RESULT` and
`FEEDBACK_MESSAGE` for what an action is made of; `CANCEL_GOAL` is the service that cancels goals.
"""

from selfconf.ros2.definitions import FEEDBACK_MESSAGE, GET_RESULT, GOAL, REQUEST, RESPONSE, RESULT, SEND_GOAL
from selfconf.ros2.messages import (
    HASH,
    NAME,
    MessageError,
    MessageMedia,
    MessageType,
    ServiceParts,
    check_message,
    is_known,
    learn,
    load,
    message,
    message_fields,
    named_folders,
    read_media,
    received,
    service_parts,
    usual_type,
)
from selfconf.ros2.services import CANCEL_GOAL

__all__ = [
    "CANCEL_GOAL",
    "FEEDBACK_MESSAGE",
    "GET_RESULT",
    "GOAL",
    "HASH",
    "NAME",
    "REQUEST",
    "RESPONSE",
    "RESULT",
    "SEND_GOAL",
    "MessageError",
    "MessageMedia",
    "MessageType",
    "ServiceParts",
    "check_message",
    "is_known",
    "learn",
    "load",
    "message",
    "message_fields",
    "named_folders",
    "read_media",
    "received",
    "service_parts",
    "usual_type",
]
