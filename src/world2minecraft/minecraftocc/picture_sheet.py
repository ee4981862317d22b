"""Draw contact sheets: many images side by side, each with a caption under it."""

from collections.abc import Iterable, Sequence

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Camera
from world2minecraft.geometry.undistort import pinhole_camera
from world2minecraft.rendering.light import LightSettings
from world2minecraft.rendering.presentation.shot_rendering import DrawOptions, draw_frames
from world2minecraft.rendering.scene import BlockScene
from world2minecraft.rendering.shading_parameters import DAY

GAP_PX, LINE_PX = 6, 16
PAPER, INK = (250, 250, 248), (40, 42, 46)
MAX_PX = 60_000_000  # Of a sheet.


def make_contact_sheet(
    pictures: Iterable[tuple[np.ndarray, str]], columns: int = 6, tile_px: int = 240
) -> np.ndarray:
    """Return a sheet of pictures with captions, uint8 [H, W, 3].

    Args:
        pictures: uint8 [h, w, 3] each, and its caption; they may differ in size.
        columns: pictures a row.
        tile_px: the width of a picture on the sheet.

    Raises:
        UsageError: there is no picture, or the sheet would be too large.
    """
    tiles = [(_thumbnail(colour, tile_px), caption) for colour, caption in pictures]
    if not tiles:
        raise UsageError("a sheet needs one picture or more")
    tall = max(tile.height for tile, _ in tiles) + LINE_PX + GAP_PX
    columns = min(columns, len(tiles))
    size = (columns * (tile_px + GAP_PX) + GAP_PX, -(-len(tiles) // columns) * tall + GAP_PX)
    if size[0] * size[1] > MAX_PX:
        raise UsageError(f"a sheet of {size[0]}x{size[1]} pixels is too large; ask for fewer")
    page = Image.new("RGB", size, PAPER)
    drawn, font = ImageDraw.Draw(page), ImageFont.load_default(12)
    for number, (tile, caption) in enumerate(tiles):
        row, column = divmod(number, columns)
        x, y = GAP_PX + column * (tile_px + GAP_PX), GAP_PX + row * tall
        page.paste(tile, (x, y))
        drawn.text((x, y + tile.height + 1), caption, INK, font)
    return np.asarray(page)


def spread_indices(count: int, limit: int) -> list[int]:
    """Return up to ``limit`` numbers below ``count``, evenly spread.

    Example:
        >>> spread_indices(10, 4)
        [0, 3, 6, 9]
    """
    if count <= limit:
        return list(range(count))
    return [int(n) for n in np.round(np.linspace(0, count - 1, limit))]


def draw_views(
    scene: BlockScene,
    views: Sequence[tuple[Camera, np.ndarray]],
    width_px: int,
    light: LightSettings = DAY,
) -> Iterable[np.ndarray]:
    """Draw views small, uint8 [h, width_px, 3] each.

    Args:
        scene: ``prepare_scene`` of a volume.
        views: cameras, and ``camera_to_room`` float64 [4, 4].
        width_px: how wide.
        light: how it is lit.
    """
    cameras = [pinhole_camera(camera, width_px) for camera, _ in views]
    options = DrawOptions(outputs=("colour",), light=light, samples=2)
    for picture in draw_frames(scene, cameras, [pose for _, pose in views], options):
        yield np.asarray(picture.colour)


def _thumbnail(colour: np.ndarray, width_px: int) -> Image.Image:
    picture = Image.fromarray(colour)
    height_px = max(1, round(picture.height * width_px / picture.width))
    return picture.resize((width_px, height_px), Image.Resampling.BOX)
