"""A contact sheet of all texture generators for visual inspection."""

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from world2minecraft.core.files import image_bytes
from world2minecraft.rendering.textures.catalogue import GROUPS
from world2minecraft.rendering.textures.recipe import PREFIX
from world2minecraft.rendering.textures.synthesis import texture_of

COLUMNS = 10
GAP_PX, NAME_PX, HEAD_PX = 12, 18, 34
PAPER, INK, FAINT = (247, 248, 249), (34, 38, 43), (109, 116, 124)
LIGHT, DARK = 226, 208  # The chequers behind holes.
SEEN_PX = 128  # A tile, where a texture is smaller.


def texture_sheet(
    size_px: int, repeat: int = 1, columns: int = COLUMNS, right_px: int | None = None
) -> np.ndarray:
    """Return an image of all texture generators with their names, uint8 [H, W, 3].

    Args:
        size_px: Texture size in pixels: 16, 32, 64 or 128.
        repeat: Number of repetitions in both directions, to show how textures tile.
        columns: Textures per row.
        right_px: Texture size of the right half of each tile, for comparison.

    Raises:
        UsageError: If a size is not supported.
    """
    tile = _tile_px(max(size_px, right_px or 0) * repeat)
    step = tile + GAP_PX
    rows = {name: -(-len(group) // columns) for name, group in GROUPS.items()}
    height = sum(HEAD_PX + count * (step + NAME_PX) for count in rows.values()) + GAP_PX
    page = Image.new("RGB", (columns * step + GAP_PX, height), PAPER)
    draw, top = ImageDraw.Draw(page), 0
    for title, group in GROUPS.items():
        draw.text((GAP_PX, top + 10), title, FAINT, ImageFont.load_default(18))
        top += HEAD_PX
        for index, (name, generator) in enumerate(group.items()):
            row, column = divmod(index, columns)
            left, upper = GAP_PX + column * step, top + row * (step + NAME_PX)
            recipe = f"{PREFIX}{name}{generator.sample}"
            shown = tiled(recipe, size_px, repeat, tile)
            if right_px is not None:
                shown[:, tile // 2 :] = tiled(recipe, right_px, repeat, tile)[:, tile // 2 :]
            page.paste(Image.fromarray(shown), (left, upper))
            draw.text((left, upper + tile + 1), name, INK, ImageFont.load_default(12))
        top += rows[title] * (step + NAME_PX)
    return np.asarray(page)


def _tile_px(needed_px: int) -> int:
    """Return the side of a tile: whole texels, and not too small to be seen."""
    return needed_px * max(1, SEEN_PX // needed_px)


def tiled(recipe: str, size_px: int, repeat: int, side_px: int) -> np.ndarray:
    """Return a texture repeated over a checkerboard, uint8 [side_px, side_px, 3].

    ``side_px`` must be a multiple of ``size_px * repeat``.
    """
    colour = np.tile(texture_of(recipe, size_px).colour, (repeat, repeat, 1))
    grown = side_px // len(colour)
    colour = colour.repeat(grown, axis=0).repeat(grown, axis=1).astype(np.float64)
    place = np.arange(side_px) // 8
    chequers = np.where((place[:, None] + place) % 2 == 0, LIGHT, DARK)[..., None]
    share = colour[..., 3:] / 255
    return np.rint(colour[..., :3] * share + chequers * (1 - share)).astype(np.uint8)


def page_png(page: np.ndarray) -> bytes:
    """Encode a page, uint8 [H, W, 3], as a PNG with quantized colours to reduce its size."""
    return image_bytes(Image.fromarray(page & np.uint8(0xFE)), "PNG", optimize=True)
