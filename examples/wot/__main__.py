"""A switch and two lamps that never heard of each other: `python -m examples.wot`.

It starts three Things, a bridge that lets them play in an ecology, and a task. Then it presses the switch, pulls the
plug of the lamp that shines, and presses the switch again: the other lamp has taken its place.
"""

from __future__ import annotations

import secrets
import urllib.request
from pathlib import Path

from examples.players import PATIENCE, Player, need, stage, until

HERE = Path(__file__).parent


def press(switch: str) -> None:
    """Press a switch, as a hand would."""
    print("* the switch is pressed", flush=True)
    urllib.request.urlopen(urllib.request.Request(f"{switch}press", method="POST"), timeout=PATIENCE).close()


def main() -> None:
    """Play the scene once."""
    need("aiohttp")
    ecology = f"light-{secrets.token_hex(3)}"
    with stage() as play:
        things = [
            play(str(HERE / "thing.py"), *who) for who in (("switch", "hall"), ("lamp", "desk"), ("lamp", "shelf"))
        ]
        urls = [thing.says("http://") for thing in things]
        bridge = play("-m", "selfconf", "bridge", "wot", *urls, "--rate", "5", "--ecology", ecology)
        bridge.says("is here", times=len(things))
        task = play("-m", "selfconf", "run", str(HERE / "light.ttl"), "--wait", "--ecology", ecology)
        task.says("running")
        lamps = things[1:]
        press(urls[0])
        until(lambda: any(lamp.shines() for lamp in lamps), "light")
        one, other = sorted(lamps, key=Player.shines, reverse=True)
        print("* the plug of the lamp that shines is pulled", flush=True)
        one.process.kill()
        other.says("is on")
        press(urls[0])
        other.says("is off")
        print("* that was all", flush=True)


if __name__ == "__main__":
    main()
