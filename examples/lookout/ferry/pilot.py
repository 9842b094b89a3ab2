"""The pilot of the ferry: says how far it is, and nothing else."""

from selfconf.sdk import Component, Signal, main


class Pilot(Component):
    advertisement = "pilot.ttl"

    def received(self, port: str, signal: Signal) -> None:
        print(f"{signal['x']:.0f} m, {signal['frame']}", flush=True)


if __name__ == "__main__":
    main(Pilot)
