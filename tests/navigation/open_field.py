"""A field without a scene: blocks of a metre, walls where x is under -1 or over 4, one goal."""

import math

import numpy as np

from world2minecraft.navigation.types import MOVE_SETS, Episode, Instruction, Move, Stance

LEAST_X, MOST_X = -1.0, 4.0


class OpenField:
    """A ground whose shortest ways are straight lines. ``views`` counts the pictures taken."""

    move_set = MOVE_SETS["vlnce"]
    metres_per_block = 1.0
    step_m = 0.25

    def __init__(self):
        self.views = 0

    def view(self, stance):
        self.views += 1
        shade = int(abs(stance.x) * 40 + abs(stance.yaw_deg)) % 256
        return np.full((30, 40, 3), shade, np.uint8)

    def step(self, stance, move):
        if move in (Move.LEFT, Move.RIGHT):
            turn = 15.0 if move == Move.RIGHT else -15.0
            yaw = (stance.yaw_deg + turn + 180) % 360 - 180
            return Stance(stance.x, stance.y, stance.z, yaw), False
        yaw = math.radians(stance.yaw_deg)
        x, z = stance.x - 0.25 * math.sin(yaw), stance.z + 0.25 * math.cos(yaw)
        if not LEAST_X <= x <= MOST_X:
            return stance, True
        return Stance(x, stance.y, z, stance.yaw_deg), False

    def distance_m(self, stance, goals):
        return min(math.dist(stance.feet, goal) for goal in goals)

    def expert(self, stance, goals, facing=None):
        moves = []
        while self.distance_m(stance, goals) > 0.2:
            x, _, z = goals[0]
            wanted = math.degrees(math.atan2(-(x - stance.x), z - stance.z))
            off = (wanted - stance.yaw_deg + 180) % 360 - 180
            move = Move.FORWARD if abs(off) <= 7.6 else Move.RIGHT if off > 0 else Move.LEFT
            moves.append(move)
            stance, _ = self.step(stance, move)
        return (*moves, Move.STOP)

    @property
    def offline(self):
        return self

    def plan(self, stances):
        return np.full((20, 20, 3), min(len(stances), 255), np.uint8)

    def to_room_m(self, feet):
        return np.asarray(feet, float)[:, [0, 2, 1]]


def an_episode(*, goal=(3.0, 64.0, 0.0), max_steps=60, yaw_deg=0.0, name="e1"):
    return Episode(
        name,
        "field",
        "field",
        Stance(0.0, 64.0, 0.0, yaw_deg),
        (goal,),
        "post",
        Instruction("Go to the post", "human", "goal"),
        max_steps=max_steps,
    )
