"""Floor maps of a scene with a walked path, one map per storey."""

import math
from collections.abc import Sequence

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from world2minecraft.core.types import BlockVolume
from world2minecraft.navigation.scene import VlnScene
from world2minecraft.navigation.types import Stance
from world2minecraft.rendering.cutaway import split_storeys
from world2minecraft.rendering.preview import plan_view

WAY, HERE, GOAL, BEGIN = (235, 90, 20), (200, 20, 30), (20, 130, 60), (40, 80, 200)
PAPER = (244, 243, 240)
SIDE_PX = 320
MARGIN_M = 1.0  # Around the floor, for walls and furniture along them.
FINE = 2  # Supersampling factor.


def floor_plans(scene: VlnScene) -> "PlanMap":
    """Return the maps of a scene, cropped to the area around its walkable floor.

    Without cropping, a large garden would take up most of the map.
    """
    floor = scene.graph.feet[scene.main_places][:, [0, 2]]
    margin = MARGIN_M * scene.blocks_per_metre
    (x0, z0), (x1, z1) = floor.min(axis=0) - margin, floor.max(axis=0) + margin
    return PlanMap(scene.volume, SIDE_PX, (float(x0), float(z0), float(x1), float(z1)))


class PlanMap:
    """Maps of the storeys of a volume, each rendered once."""

    def __init__(
        self,
        volume: BlockVolume,
        size_px: int,
        box: tuple[float, float, float, float] | None = None,
    ):
        """Create the maps of a volume.

        Args:
            volume: The blocks.
            size_px: The side length of a map in pixels.
            box: The area to draw in world blocks: minimum x and z, maximum x and z. None draws all.
        """
        self.size_px, self._box = size_px, box
        self._storeys = split_storeys(volume)
        self._drawn: dict[int, tuple[Image.Image, float, tuple[float, float]]] = {}

    def picture(
        self,
        stances: Sequence[Stance],
        goals: Sequence[tuple[float, float, float]],
        goal_name: str = "",
    ) -> Image.Image:
        """Return the map of the storey of the last stance, with the path and the goals.

        Args:
            stances: The stances of the walk so far.
            goals: The goal positions in world blocks.
            goal_name: The name written beside the first goal on the storey.
        """
        here = stances[-1]
        storey = self._storey(here.y)
        plain, scale, (left, top) = self._plan(storey)
        picture = plain.copy()
        draw = ImageDraw.Draw(picture)

        def place(x: float, z: float) -> tuple[float, float]:
            return ((x - left) * scale, (z - top) * scale)

        radius = self.size_px * FINE / 70
        shown = [place(x, z) for x, y, z in goals if self._storey(y) == storey]
        for at in shown:
            _dot(draw, at, radius, GOAL)
        way = [place(one.x, one.z) for one in stances if self._storey(one.y) == storey]
        if len(way) > 1:
            draw.line(way, WAY, round(radius * 0.7), "curve")
        if self._storey(stances[0].y) == storey:
            _dot(draw, place(stances[0].x, stances[0].z), radius * 0.8, BEGIN)
        _arrow(draw, place(here.x, here.z), here.yaw_deg, radius * 2.2)
        if shown and goal_name:
            _label(draw, shown[0], radius, goal_name, picture.width)
        return picture.resize((self.size_px, self.size_px), Image.Resampling.LANCZOS)

    def _storey(self, y: float) -> int:
        floors = [n for n, one in enumerate(self._storeys) if one.corner[1] <= y + 0.5]
        return floors[-1] if floors else 0

    def _plan(self, storey: int) -> tuple[Image.Image, float, tuple[float, float]]:
        """Return a square map, its scale in pixels per block, and the block at its corner."""
        if storey not in self._drawn:
            volume = self._storeys[storey]
            side = self.size_px * FINE
            x0, z0, x1, z1 = self._cut(volume)
            most = max(x1 - x0, z1 - z0)
            fine = max(1, side // most)
            image = Image.fromarray(plan_view(volume, fine))
            image = image.crop((x0 * fine, z0 * fine, x1 * fine, z1 * fine))
            scale = side / most
            image = image.resize(
                (max(1, round((x1 - x0) * scale)), max(1, round((z1 - z0) * scale))),
                Image.Resampling.LANCZOS,
            )
            square = Image.new("RGB", (side, side), PAPER)
            offset = ((side - image.width) // 2, (side - image.height) // 2)
            square.paste(image, offset)
            corner = (
                volume.corner[0] + x0 - offset[0] / scale,
                volume.corner[2] + z0 - offset[1] / scale,
            )
            self._drawn[storey] = (square, scale, corner)
        return self._drawn[storey]

    def _cut(self, volume: BlockVolume) -> tuple[int, int, int, int]:
        """Return the columns of a storey to draw: minimum x and z, maximum x and z."""
        wide, _, deep = volume.states.shape
        if self._box is None:
            return 0, 0, wide, deep
        x0, z0, x1, z1 = self._box
        left, top = math.floor(x0) - volume.corner[0], math.floor(z0) - volume.corner[2]
        right, foot = math.ceil(x1) - volume.corner[0], math.ceil(z1) - volume.corner[2]
        found = (max(0, left), max(0, top), min(wide, right), min(deep, foot))
        return found if found[0] < found[2] and found[1] < found[3] else (0, 0, wide, deep)


def _dot(
    draw: ImageDraw.ImageDraw,
    at: tuple[float, float],
    radius: float,
    colour: tuple[int, int, int],
) -> None:
    x, y = at
    draw.ellipse((x - radius, y - radius, x + radius, y + radius), colour, (255, 255, 255), 2)


def _label(
    draw: ImageDraw.ImageDraw, at: tuple[float, float], radius: float, text: str, side_px: int
) -> None:
    """Write a text above a point, or below it at the upper edge, within the map."""
    font = ImageFont.load_default(round(radius * 4.4))
    shown = printable(text)[:24]
    width, height = font.getlength(shown), radius * 5.2
    left = min(max(at[0] - width / 2, 4.0), max(side_px - width - 4, 4.0))
    top = at[1] - radius - height if at[1] > radius + height else at[1] + radius
    draw.text((left, top), shown, GOAL, font, stroke_width=3, stroke_fill=(255, 255, 255))


def printable(text: str) -> str:
    """Collapse white space, and replace characters that the font lacks with question marks."""
    return "".join(mark if " " <= mark <= "ÿ" else "?" for mark in " ".join(text.split()))


def _arrow(
    draw: ImageDraw.ImageDraw, at: tuple[float, float], yaw_deg: float, length: float
) -> None:
    """Draw an arrow at a position. On the map, x points right and z points down."""
    yaw = np.radians(yaw_deg)
    ahead = np.array([-np.sin(yaw), np.cos(yaw)])
    side = np.array([ahead[1], -ahead[0]])
    points = [ahead * length, -ahead * length * 0.6 + side * length * 0.7,
              -ahead * length * 0.6 - side * length * 0.7]  # fmt: skip
    corners = [(float(at[0] + x), float(at[1] + y)) for x, y in points]
    draw.polygon(corners, HERE, (255, 255, 255), 2)
