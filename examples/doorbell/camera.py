"""A camera: asked to describe a place, it says what it sees there."""

import sys
from typing import Any

from selfconf.sdk import Component, Refused, Signal, main


class Camera(Component):
    advertisement = "cameras.ttl"

    def called(self, operation: str, request: Signal) -> Any:
        if request["text"] != "the door":
            raise Refused(f"{request['text']} is out of sight")
        return {"text": f"{self.component.rpartition('#')[2]}: the postman"}


if __name__ == "__main__":
    name = sys.argv[1]
    main(type(name, (Camera,), {"component": f"https://example.org/my-home#{name}"}), arguments=sys.argv[2:])
