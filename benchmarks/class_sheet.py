"""Sheets of pictures of labelled cells: grids drawn from above, and what their colours mean."""

import numpy as np
from PIL import Image, ImageDraw, ImageOps

from world2minecraft.classes import CLASS_COLOURS, CLASS_NAMES, UNKNOWN
from world2minecraft.coordinates import look_at
from world2minecraft.render.voxels import cast_voxels
from world2minecraft.types import Camera

SIDE = 360
SHADES = np.array([0.72, 0.72, 0.84, 0.84, 0.6, 1.0])  # Of the faces -x +x -y +y -z +z.
PAPER = 244
TEXT = (60, 60, 60)
FOOT_PX = 22


def drawn(labels: np.ndarray, voxel_m: float = 0.08, side: int = SIDE) -> Image.Image:
    """Return a picture of labels uint8 [X, Y, Z] from above, without the ceiling; pixels a side."""
    shown = np.where((labels == 1) | (labels == UNKNOWN), np.uint8(0), labels)
    size = np.array(shown.shape) * voxel_m
    target = size * [0.5, 0.5, 0.3]
    eye = target + np.array([0.55, -0.9, 1.25]) * 1.25 * size.max()
    camera = Camera(side, side, 1.5 * side, 1.5 * side, side / 2, side / 2)
    hits = cast_voxels(shown, camera, look_at(eye, target), voxel_m=voxel_m)
    there = hits.voxel_index >= 0
    picture = np.full((side, side, 3), PAPER, np.float64)
    kinds = shown.reshape(-1)[hits.voxel_index[there]]
    picture[there] = np.array(CLASS_COLOURS)[kinds] * SHADES[hits.face[there]][:, None]
    return Image.fromarray(picture.round().astype(np.uint8))


def framed(picture: np.ndarray, side: int = SIDE) -> Image.Image:
    """Return a picture in a square of the sheet."""
    image = ImageOps.contain(Image.fromarray(picture), (side - 12, side - 12))
    return ImageOps.pad(image, (side, side), color=(PAPER,) * 3)


def sheet(
    titles: tuple[str, ...], rows: list[tuple[str, list[Image.Image]]], side: int = SIDE
) -> Image.Image:
    """Return rows of pictures, each with a line over it, the titles above and the classes below."""
    page = Image.new("RGB", (side * len(titles), (side + 20) * len(rows) + 44), (PAPER,) * 3)
    pen = ImageDraw.Draw(page)
    for column, title in enumerate(titles):
        pen.text((side * column + 10, 4), title, fill=TEXT, font_size=15)
    for row, (told, pictures) in enumerate(rows):
        top = 24 + row * (side + 20)
        pen.text((10, top + 4), told, fill=(90, 90, 90), font_size=13)
        for column, picture in enumerate(pictures):
            page.paste(picture, (side * column, top + 20))
    _name_classes(pen, page)
    return page


def _name_classes(pen: ImageDraw.ImageDraw, page: Image.Image) -> None:
    apart = (page.width - 20) / (len(CLASS_NAMES) - 1)
    for kind, label in enumerate(CLASS_NAMES[1:], 1):
        left = round(10 + (kind - 1) * apart)
        pen.rectangle((left, page.height - 18, left + 12, page.height - 6), CLASS_COLOURS[kind])
        pen.text((left + 18, page.height - FOOT_PX + 2), label, fill=TEXT, font_size=13)
