"""Matching colours for a room: wood, walls, floor and fabric."""

from dataclasses import dataclass

import numpy as np

from world2minecraft.procgen.rooms.furniture_model import Colour

WOODS: tuple[Colour, ...] = ((186, 142, 92), (132, 88, 56), (206, 170, 122), (160, 106, 62))
WALLS: tuple[Colour, ...] = (
    (236, 232, 222), (226, 220, 204), (206, 216, 206), (208, 218, 226), (234, 220, 200),
    (222, 214, 216),
)  # fmt: skip
CLOTHS: tuple[Colour, ...] = (
    (70, 92, 130), (122, 126, 132), (190, 142, 62), (62, 116, 112), (176, 94, 70), (116, 134, 96),
    (142, 82, 92), (92, 86, 116),
)  # fmt: skip
FRONTS: tuple[Colour, ...] = (
    (168, 44, 40), (232, 230, 224), (92, 116, 102), (78, 100, 132),
    (198, 160, 108), (214, 186, 120),
)  # fmt: skip
WORKTOPS: tuple[Colour, ...] = ((66, 66, 68), (150, 108, 70), (196, 194, 188))
WHITE: Colour = (238, 237, 232)


@dataclass(frozen=True)
class Style:
    """The colour scheme of a room."""

    wood: Colour
    dark_wood: Colour
    wall: Colour
    accent_wall: Colour
    cloth: Colour
    second_cloth: Colour
    curtain: Colour
    front: Colour
    worktop: Colour
    floor_wood: Colour


def choose_style(rng: np.random.Generator) -> Style:
    """Choose a random colour scheme."""
    cloth = int(rng.integers(len(CLOTHS)))
    second = (cloth + 1 + int(rng.integers(len(CLOTHS) - 1))) % len(CLOTHS)
    wall = WALLS[int(rng.integers(len(WALLS)))]
    accent = _mix(CLOTHS[second], (230, 226, 216), 0.68) if rng.random() < 0.5 else wall
    return Style(
        wood=WOODS[int(rng.integers(len(WOODS)))],
        dark_wood=(96, 66, 46),
        wall=wall,
        accent_wall=accent,
        cloth=CLOTHS[cloth],
        second_cloth=CLOTHS[second],
        curtain=_mix(CLOTHS[second], (240, 236, 226), 0.35),
        front=FRONTS[int(rng.integers(len(FRONTS)))],
        worktop=WORKTOPS[int(rng.integers(len(WORKTOPS)))],
        floor_wood=WOODS[int(rng.integers(len(WOODS)))],
    )


def _mix(a: Colour, b: Colour, share_b: float) -> Colour:
    red, green, blue = (round(x * (1 - share_b) + y * share_b) for x, y in zip(a, b, strict=True))
    return red, green, blue
