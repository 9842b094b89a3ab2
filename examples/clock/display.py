"""A display: it shows what it is told, on the terminal."""

from selfconf.sdk import Component, Signal, main


class Display(Component):
    advertisement = "display.ttl"

    def received(self, port: str, signal: Signal) -> None:
        print(signal["text"], flush=True)


if __name__ == "__main__":
    main(Display)
