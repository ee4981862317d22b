"""Blocks received from a game server as a volume, requested one chunk column at a time."""

import base64
import binascii
import zlib
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.errors import ServerError, UnknownNameError, UsageError
from world2minecraft.core.types import AIR, BlockVolume
from world2minecraft.minecraft.block_renames import read_state
from world2minecraft.minecraft.block_states import parse_state
from world2minecraft.minecraft.versions import game_version, game_versions

MAX_CELLS = 1 << 24  # 256 x 256 blocks and 256 high.
MAX_PALETTE = 1 << 15  # The game has about 26,000 states.
CHUNK = 16
AIRS = ("minecraft:cave_air", "minecraft:void_air")

Box = tuple[int, int, int, int, int, int]
Ask = Callable[..., dict[str, Any]]


def checked_box(box: Sequence[int]) -> Box:
    """Validate a box x0 y0 z0 x1 y1 z1 with exclusive ends.

    Raises:
        UsageError: If the box is invalid, or too large to be read from a server.
    """
    numbers = [int(value) for value in box]
    sides = [b - a for a, b in zip(numbers[:3], numbers[3:], strict=False)]
    if len(numbers) != 6 or min(sides) < 1 or max(map(abs, numbers)) > 30_000_000:
        raise UsageError(
            "a box must be x0 y0 z0 x1 y1 z1 with the second corner greater than the "
            f"first on each axis, got {list(box)}"
        )
    if (cells := sides[0] * sides[1] * sides[2]) > MAX_CELLS:
        raise UsageError(
            f"a box must contain at most {MAX_CELLS:,} blocks, got {cells:,}; choose a smaller one"
        )
    x0, y0, z0, x1, y1, z1 = numbers
    return x0, y0, z0, x1, y1, z1


def read_blocks(ask: Ask, box: Box, version: str) -> BlockVolume:
    """Return the blocks of a box with 1.20.1 names, one metre per block and without classes.

    Args:
        ask: A function that requests ``blocks`` from ``low`` to ``high`` (inclusive) within one
            chunk column.
        box: The box to read.
        version: The game version of the server.

    Raises:
        ServerError: If a part of the box has not been received, or a reply is invalid.
    """
    x0, y0, z0, x1, y1, z1 = box
    states = np.zeros((x1 - x0, y1 - y0, z1 - z0), np.uint16)
    rows = {AIR: 0}
    data_version = data_version_of(version)
    for west, east in _parts(x0, x1):
        for north, south in _parts(z0, z1):
            answer = ask("blocks", low=[west, y0, north], high=[east - 1, y1 - 1, south - 1])
            if answer.get("missing"):
                raise ServerError(
                    f"the server has not sent the blocks around {west} {north}; move the "
                    "player closer, choose a smaller box, or raise view-distance in "
                    "server.properties"
                )
            found, palette = _column(answer, (east - west, y1 - y0, south - north), data_version)
            table = np.array([rows.setdefault(state, len(rows)) for state in palette], np.uint16)
            states[west - x0 : east - x0, :, north - z0 : south - z0] = table[found]
    empty = np.zeros(states.shape, np.uint8)
    to_room = block_to_room(np.zeros(2), 1.0)
    return BlockVolume(
        states, tuple(rows), empty, empty.astype(np.uint16), (x0, y0, z0), to_room
    )  # fmt: skip


def state_of(text: Any, data_version: int) -> str:
    """Convert a server's block state to its name in 1.20.1.

    Raises:
        ServerError: If the block state is invalid.
    """
    try:
        state = read_state(str(parse_state(text)), data_version)
    except (UsageError, AttributeError, TypeError) as error:
        raise ServerError("the server sent a block state that cannot be parsed") from error
    return AIR if state in AIRS else state


def data_version_of(version: str) -> int:
    """Return the data version of a game version, or the newest one if the version is unknown."""
    try:
        return game_version(version).data_version
    except UnknownNameError:
        return game_versions()[-1].data_version


def _parts(low: int, high: int) -> list[tuple[int, int]]:
    """Split a range at chunk borders."""
    cuts = [low, *range(low // CHUNK * CHUNK + CHUNK, high, CHUNK), high]
    return list(pairwise(cuts))


def _column(
    answer: dict[str, Any], shape: tuple[int, int, int], data_version: int
) -> tuple[np.ndarray, list[str]]:
    palette, packed = answer.get("palette"), answer.get("states")
    count = shape[0] * shape[1] * shape[2]
    if not isinstance(palette, list) or not 1 <= len(palette) <= MAX_PALETTE:
        raise ServerError("the server sent the blocks of a chunk without a palette")
    try:
        unpacker = zlib.decompressobj()
        data = unpacker.decompress(base64.b64decode(str(packed), validate=True), 2 * count + 1)
    except (binascii.Error, zlib.error) as error:
        raise ServerError("the blocks of a chunk cannot be decompressed") from error
    found = np.frombuffer(data[: len(data) // 2 * 2], "<u2")
    if len(data) != 2 * count or int(found.max(initial=0)) >= len(palette):
        raise ServerError(
            f"expected {count:,} blocks of a chunk, but the server sent another number"
        )
    return found.reshape(shape), [state_of(text, data_version) for text in palette]
