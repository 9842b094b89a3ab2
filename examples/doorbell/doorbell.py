"""A doorbell: it rings once a second, and has a camera say who stands there. It never learns which camera."""

from selfconf.sdk import Component, Response, main


class Doorbell(Component):
    advertisement = "doorbell.ttl"

    def started(self) -> None:
        self.every(1.0, self.ring)

    def ring(self) -> None:
        self.call("look", {"text": "the door"}, answered=self.looked, seconds=1.0)

    def looked(self, answer: Response) -> None:
        print(answer["text"] if answer else f"nobody looks: {answer.detail}", flush=True)


if __name__ == "__main__":
    main(Doorbell)
