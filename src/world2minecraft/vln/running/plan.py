"""A plan of a scene with the way that was walked drawn into it, a storey at a time."""

from collections.abc import Sequence

import numpy as np
from PIL import Image, ImageDraw

from world2minecraft.render.cutaway import storeys_of
from world2minecraft.render.preview import plan_view
from world2minecraft.types import BlockVolume
from world2minecraft.vln.values import Stance

WAY, HERE, GOAL, BEGIN = (235, 90, 20), (200, 20, 30), (20, 130, 60), (40, 80, 200)
PAPER = (244, 243, 240)
FINE = 2  # A plan is drawn so many times larger and then made small.


class PlanMap:
    """Plans of the storeys of a volume, each drawn once."""

    def __init__(self, volume: BlockVolume, size_px: int):
        self.size_px = size_px
        self._storeys = storeys_of(volume)
        self._drawn: dict[int, tuple[Image.Image, float, tuple[float, float]]] = {}

    def picture(
        self, stances: Sequence[Stance], goals: Sequence[tuple[float, float, float]]
    ) -> Image.Image:
        """Return the plan of the storey of the last stance, with the way and the goals on it."""
        here = stances[-1]
        storey = self._storey(here.y)
        plain, scale, (left, top) = self._plan(storey)
        picture = plain.copy()
        draw = ImageDraw.Draw(picture)

        def place(x: float, z: float) -> tuple[float, float]:
            return ((x - left) * scale, (z - top) * scale)

        radius = self.size_px * FINE / 70
        for x, y, z in goals:
            if self._storey(y) == storey:
                _dot(draw, place(x, z), radius, GOAL)
        way = [place(one.x, one.z) for one in stances if self._storey(one.y) == storey]
        if len(way) > 1:
            draw.line(way, WAY, round(radius * 0.7), "curve")
        if self._storey(stances[0].y) == storey:
            _dot(draw, place(stances[0].x, stances[0].z), radius * 0.8, BEGIN)
        _arrow(draw, place(here.x, here.z), here.yaw_deg, radius * 2.2)
        return picture.resize((self.size_px, self.size_px), Image.Resampling.LANCZOS)

    def _storey(self, y: float) -> int:
        floors = [n for n, one in enumerate(self._storeys) if one.corner[1] <= y + 0.5]
        return floors[-1] if floors else 0

    def _plan(self, storey: int) -> tuple[Image.Image, float, tuple[float, float]]:
        """Return a square plan, its pixels a block, and the block at its corner."""
        if storey not in self._drawn:
            volume = self._storeys[storey]
            side = self.size_px * FINE
            x_blocks, _, z_blocks = volume.states.shape
            most = max(x_blocks, z_blocks)
            image = Image.fromarray(plan_view(volume, max(1, side // most)))
            scale = side / most
            image = image.resize(
                (max(1, round(x_blocks * scale)), max(1, round(z_blocks * scale))),
                Image.Resampling.LANCZOS,
            )
            square = Image.new("RGB", (side, side), PAPER)
            offset = ((side - image.width) // 2, (side - image.height) // 2)
            square.paste(image, offset)
            corner = (volume.corner[0] - offset[0] / scale, volume.corner[2] - offset[1] / scale)
            self._drawn[storey] = (square, scale, corner)
        return self._drawn[storey]


def _dot(
    draw: ImageDraw.ImageDraw,
    at: tuple[float, float],
    radius: float,
    colour: tuple[int, int, int],
) -> None:
    x, y = at
    draw.ellipse((x - radius, y - radius, x + radius, y + radius), colour, (255, 255, 255), 2)


def _arrow(
    draw: ImageDraw.ImageDraw, at: tuple[float, float], yaw_deg: float, length: float
) -> None:
    """Draw where one stands and looks; on the plan x is right and z is down."""
    yaw = np.radians(yaw_deg)
    ahead = np.array([-np.sin(yaw), np.cos(yaw)])
    side = np.array([ahead[1], -ahead[0]])
    points = [ahead * length, -ahead * length * 0.6 + side * length * 0.7,
              -ahead * length * 0.6 - side * length * 0.7]  # fmt: skip
    corners = [(float(at[0] + x), float(at[1] + y)) for x, y in points]
    draw.polygon(corners, HERE, (255, 255, 255), 2)
