"""Contact sheets of small objects, each rendered from its front corner at several scales.

The projection is orthographic, and each object fills its tile, so that shapes can be compared.
"""

import unicodedata
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from world2minecraft.core.coordinates import apply, look_at
from world2minecraft.core.files import image_bytes
from world2minecraft.core.types import BlockVolume
from world2minecraft.rendering.picture import picture_colour, render_parallel
from world2minecraft.rendering.scene import prepare_scene
from world2minecraft.rendering.shading_parameters import NEUTRAL

TILE_PX = 150
COLUMNS = 4  # Cards a row.
GAP_PX, HEAD_PX, FOOT_PX, GROUP_PX = 14, 40, 18, 54
FILLED = 0.86  # Share of a tile that the longer side of an image fills.
MAX_PX_PER_BLOCK = 84.0  # A lone block does not fill its tile.
ELEVATION_DEG, TURN_DEG = 27.0, 34.0
SUPERSAMPLE = 3
PAPER, CARD, INK, FAINT, RULE = "#ffffff", (221, 227, 232), "#22262b", "#6d747c", "#d3d8dc"


@dataclass(frozen=True, eq=False)
class Card:
    """An object on a contact sheet: its name, a subtitle, and a labelled volume for each column."""

    title: str
    note: str
    volumes: Mapping[str, BlockVolume]  # label, such as "1 block/m", to the object


def contact_sheet(groups: Mapping[str, Sequence[Card]], columns: int = COLUMNS) -> np.ndarray:
    """Return a page with groups of cards, uint8 [H, W, 3].

    Args:
        groups: Cards of each group by heading. Every card has at least one volume with a block.
        columns: Cards per row.

    Raises:
        ValueError: If there are no cards.
    """
    if not any(groups.values()):
        raise ValueError("a contact sheet needs at least one card")
    views = max(len(card.volumes) for cards in groups.values() for card in cards)
    width, height = views * TILE_PX, HEAD_PX + TILE_PX + FOOT_PX
    rows = {name: -(-len(cards) // columns) for name, cards in groups.items() if cards}
    tall = sum(GROUP_PX + count * (height + GAP_PX) for count in rows.values()) + GAP_PX
    page = Image.new("RGB", (columns * (width + GAP_PX) + GAP_PX, tall), PAPER)
    top = 0
    for name, count in rows.items():
        _heading(page, name, len(groups[name]), top)
        for index, card in enumerate(groups[name]):
            row, column = divmod(index, columns)
            left = GAP_PX + column * (width + GAP_PX)
            _paste_card(page, card, (left, top + GROUP_PX + row * (height + GAP_PX)), width)
        top += GROUP_PX + count * (height + GAP_PX)
    return np.asarray(page)


def _heading(page: Image.Image, name: str, count: int, top: int) -> None:
    draw = ImageDraw.Draw(page)
    font = ImageFont.load_default(24)
    draw.text((GAP_PX, top + 16), name, INK, font)
    after = GAP_PX + draw.textlength(name, font) + 12
    draw.text((after, top + 26), str(count), FAINT, ImageFont.load_default(14))
    draw.line((after + 34, top + 33, page.width - GAP_PX, top + 33), RULE, 1)


def _paste_card(page: Image.Image, card: Card, corner: tuple[int, int], width: int) -> None:
    left, top = corner
    draw = ImageDraw.Draw(page)
    bottom = top + HEAD_PX + TILE_PX + FOOT_PX
    draw.rounded_rectangle((left, top, left + width, bottom), 8, CARD)
    draw.text((left + 10, top + 5), _plain(card.title), INK, ImageFont.load_default(15))
    draw.text((left + 10, top + 23), card.note, FAINT, ImageFont.load_default(11))
    for index, (label, volume) in enumerate(card.volumes.items()):
        at = (left + index * TILE_PX, top + HEAD_PX)
        page.paste(Image.fromarray(object_picture(volume)), at)
        font = ImageFont.load_default(11)
        middle = at[0] + (TILE_PX - draw.textlength(label, font)) / 2
        draw.text((middle, at[1] + TILE_PX), label, FAINT, font)


def _plain(text: str) -> str:
    """Return a text in letters that the font has: those of ASCII, without accents."""
    return unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode()


def _axes() -> tuple[np.ndarray, np.ndarray]:
    """Return the direction from the object to the eye, and the image axes in the room, [2, 3]."""
    up, turn = np.radians(ELEVATION_DEG), np.radians(TURN_DEG)
    toward = np.array([np.cos(up) * np.cos(turn), -np.cos(up) * np.sin(turn), np.sin(up)])
    pose = look_at(toward, np.zeros(3))
    return toward, pose[:3, :2].T


def _corners(volume: BlockVolume) -> np.ndarray:
    """Return the corners, float64 [8, 3] in room metres, of the box of all blocks."""
    filled = np.argwhere(volume.states != 0)
    low = filled.min(axis=0) + volume.corner
    high = filled.max(axis=0) + 1 + volume.corner
    corners = np.array(np.meshgrid(*zip(low, high, strict=True), indexing="ij")).reshape(3, -1).T
    return apply(volume.block_to_room, corners.astype(np.float64))


def object_picture(volume: BlockVolume) -> np.ndarray:
    """Return a square image of an object that faces room +x, uint8 [TILE_PX, TILE_PX, 3]."""
    toward, axes = _axes()
    flat = _corners(volume) @ axes.T
    most = MAX_PX_PER_BLOCK * volume.blocks_per_metre
    px_per_metre = min(FILLED * TILE_PX / float(np.ptp(flat, axis=0).max()), most)
    middle = (flat.min(axis=0) + flat.max(axis=0)) / 2
    seen = axes.T @ middle + toward * (toward @ _corners(volume).mean(axis=0))
    pose = look_at(seen + toward * 50.0, seen)
    picture = render_parallel(
        prepare_scene(volume),
        px_per_metre,
        (TILE_PX, TILE_PX),
        pose,
        outputs=("colour",),
        samples=SUPERSAMPLE,
        light=NEUTRAL,
        background=(CARD, CARD),
    )
    return picture_colour(picture)


def sheet_png(page: np.ndarray) -> bytes:
    """Encode a page, uint8 [H, W, 3], as a PNG with 256 colours to reduce its size."""
    method = Image.Quantize.MAXCOVERAGE  # Small objects keep their colours, off by 22 at most.
    few = Image.fromarray(page).quantize(256, method, kmeans=3, dither=Image.Dither.NONE)
    return image_bytes(few, "PNG", optimize=True)
