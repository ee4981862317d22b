"""Plays ``body.mjs`` without Node: the small flat is its server, and our physics its player.

``python fake_body.py MODE``: honest, or one of the ways to misbehave that the tests name.
"""

import base64
import json
import sys
import time
import zlib
from functools import cached_property
from types import SimpleNamespace

SPAWN = (3.0, 65.0, 3.0)
FLAGS = ("forward", "back", "left", "right", "jump", "sneak", "sprint")


class FakeServer:
    """A server with one player."""

    def __init__(self, mode):
        self.mode, self.holds, self.places = mode, 0, 0
        self.body = SimpleNamespace(
            position=SPAWN, velocity=(0, 0, 0), on_ground=True, hit_wall=False
        )

    @cached_property
    def volume(self):
        from small_flat import flat_volume  # Not every test waits for what this loads.

        return flat_volume()[0]

    @cached_property
    def world(self):
        from world2minecraft.minecraft.physics import BlockWorld

        return BlockWorld.of_volume(self.volume)

    def pose(self):
        return [*self.body.position, *self.body.velocity, int(self.body.on_ground),
                int(self.body.hit_wall)]  # fmt: skip

    def news(self):
        changed, self.holds = [], self.holds + 1
        if self.mode == "builder" and self.holds == 3:
            changed = [[5, 66, 5, "minecraft:gold_block"], [500, 66, 5, "minecraft:stone"]]
        too_many = self.mode == "flood" and self.holds == 3
        return {"pose": self.pose(), "forced": 0, "changed": changed, "too_many": too_many,
                "places": self.places}  # fmt: skip

    def join(self, told):
        return {"version": "1.20.1", "name": told.get("name", "w2m_walker"), **self.news()}

    def place(self, told):
        self.places += 1
        if self.mode == "no operator":
            return {"moved": False, **self.news()}
        from world2minecraft.minecraft.physics import Body

        self.body = Body((told["x"], told["y"], told["z"]))
        return {"moved": True, **self.news()}

    def hold(self, told):
        if self.mode in ("liar", "not a number", "chatty"):
            count = len(told["ticks"]) + (self.mode == "liar")
            poses = [self.pose() for _ in range(count)]
            poses[0][0] = "here" if self.mode == "not a number" else poses[0][0]
            return {"poses": poses, **self.news()}
        from world2minecraft.minecraft.physics import Body, Keys, step

        is_late = self.mode == "late" and self.places == 1
        if isinstance(self.body, SimpleNamespace) or is_late or self.mode == "stubborn":
            self.body = Body(SPAWN, on_ground=True)
        poses = []
        for bits, yaw, _ in told["ticks"]:
            held = {flag: bool(bits >> n & 1) for n, flag in enumerate(FLAGS)}
            self.body = step(self.world, self.body, Keys(**held, yaw_deg=yaw))
            poses.append(self.pose())
        return {"poses": poses, **self.news()}

    def blocks(self, told):
        if self.mode == "far away":
            return {"missing": True}
        if self.mode in ("bomb", "too long", "odd names"):
            return self.wrong_blocks()
        import numpy as np

        low, high = np.array(told["low"]), np.array(told["high"]) + 1
        found = np.zeros(high - low, np.uint16)
        corner, shape = np.array(self.volume.corner), np.array(self.volume.states.shape)
        first, last = np.maximum(low, corner), np.minimum(high, corner + shape)
        if (first < last).all():
            here = tuple(slice(a, b) for a, b in zip(first - low, last - low, strict=True))
            there = tuple(slice(a, b) for a, b in zip(first - corner, last - corner, strict=True))
            found[here] = self.volume.states[there]
        at = np.array([5, 66, 5])
        has_changed = self.mode == "flood" and self.holds >= 3
        if has_changed and (low <= at).all() and (high > at).all():
            found[tuple(at - low)] = 2
        packed = base64.b64encode(zlib.compress(found.tobytes())).decode()
        return {"palette": list(self.volume.palette), "states": packed}

    def wrong_blocks(self):
        length = {"bomb": 1 << 26, "too long": 20, "odd names": 18}[self.mode]  # Of 9 blocks.
        packed = base64.b64encode(zlib.compress(bytes(length))).decode()
        name = "no state!" if self.mode == "odd names" else "minecraft:air"
        return {"palette": [name], "states": packed}

    def where(self, told):
        return self.news()

    def leave(self, told):
        return {}


def misbehave(mode):
    """What some modes do in place of an answer to ``hold``."""
    if mode == "silent":
        time.sleep(60)
    if mode == "dead":
        sys.stderr.write("out of memory\n")
        sys.exit(3)
    if mode == "huge":
        sys.stdout.write("[" * (9 << 20))
    if mode == "junk":
        sys.stdout.write("Hello, world\n")
    if mode == "a list":
        sys.stdout.write("[1, 2]\n")
    if mode == "chatty":
        sys.stdout.write('{"id": 0, "error": "late"}\n' * 5)
    sys.stdout.flush()


def main():
    server = FakeServer(sys.argv[1])
    for line in sys.stdin:
        told = json.loads(line)
        if told["do"] == "hold":
            misbehave(server.mode)
        if told["do"] == "hold" and server.mode == "refuses":
            answer = {"error": "keys are\nheld \x1b[31malready"}
        else:
            answer = getattr(server, told["do"])(told)
        sys.stdout.write(json.dumps({"id": told["id"], **answer}) + "\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
