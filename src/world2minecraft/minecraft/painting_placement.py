"""Paintings in a volume of blocks, hung in place of the cells of pictures.

A painting is an entity, so no block state holds it. While furniture is placed block by block, every
cell of a picture has the state ``minecraft:painting[facing=east,motif=landscape]``, which the game
does not know. ``hang_paintings`` replaces these cells by invisible blocks with the same labels, and
hangs one of the game's paintings in front of the wall behind them.
"""

from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from typing import NamedTuple

import numpy as np

from world2minecraft.core.types import AIR, BlockVolume, Entity
from world2minecraft.minecraft.block_states import complete, parse_state
from world2minecraft.minecraft.collision_shapes import is_full_cube
from world2minecraft.minecraft.entities import owner_tags
from world2minecraft.minecraft.nbt import Byte, Float
from world2minecraft.minecraft.paintings import PAINTING, SIDES, THICK, VARIANTS

INVISIBLE = "minecraft:light[level=0,waterlogged=false]"  # Passable, and it holds the labels.
PANEL = "minecraft:spruce_trapdoor[facing={},half=bottom,open=true]"
# Paintings that suit a home.
HUNG = ("alban", "kebab", "plant", "wasteland", "courbet", "creebet", "sea", "sunset", "graham",
        "wanderer", "bust", "match", "stage", "fighters", "pigscene", "pointer")  # fmt: skip
# By the side that a painting faces: the step to that side, and the step along the wall in which the
# game counts the painting's columns.
_STEPS = {
    "south": ((0, 0, 1), (1, 0, 0)),
    "west": ((-1, 0, 0), (0, 0, 1)),
    "north": ((0, 0, -1), (-1, 0, 0)),
    "east": ((1, 0, 0), (0, 0, -1)),
}

_OPPOSITE = {"south": "north", "north": "south", "west": "east", "east": "west"}


def painting_state(facing: str, motif: str) -> str:
    """Return the state of a cell of a picture before ``hang_paintings``."""
    return f"{PAINTING}[facing={facing},motif={motif}]"


class _Picture(NamedTuple):
    """The cells of a picture, int [N, 3] in block axes, and what hangs there."""

    cells: np.ndarray
    facing: str
    motif: str
    class_id: int
    instance: int


def hang_paintings(volume: BlockVolume) -> BlockVolume:
    """Return a volume in which paintings hang in place of the cells of pictures.

    A picture that is one block off its wall moves to the wall, and one whose front is at a wall is
    turned. Panels replace a picture without a wall. The palette is sorted, without unused states.
    """
    pictures = list(_pictures(volume))
    if not pictures:
        return volume
    kept = [state for state in volume.palette if state.partition("[")[0] != PAINTING]
    palette = list(dict.fromkeys([*kept, INVISIBLE, *(_panel(one.facing) for one in pictures)]))
    number = {state: index for index, state in enumerate(palette)}
    states = np.array([number.get(state, 0) for state in volume.palette], np.uint16)[volume.states]
    semantic = volume.semantic.copy()
    instance = volume.instance.copy()
    solid = np.array([is_full_cube(state) for state in palette])[states]
    entities = list(volume.entities)
    for one in pictures:
        semantic[tuple(one.cells.T)] = instance[tuple(one.cells.T)] = 0
    for picture in pictures:
        one, supported = _at_wall(picture, solid, states == 0)
        at = tuple(one.cells.T)
        states[at] = number[INVISIBLE if len(supported) else _panel(one.facing)]
        semantic[at], instance[at] = one.class_id, one.instance
        if len(supported):
            entities.append(_best_painting(one, supported + volume.corner))
    names = sorted(palette[index] for index in np.unique(states) if palette[index] != AIR)
    order = {name: index for index, name in enumerate((AIR, *names))}
    return replace(
        volume,
        states=np.array([order.get(name, 0) for name in palette], np.uint16)[states],
        palette=(AIR, *names),
        semantic=semantic,
        instance=instance,
        entities=tuple(entities),
    )


def _panel(facing: str) -> str:
    return str(complete(parse_state(PANEL.format(facing))))


def _pictures(volume: BlockVolume) -> Iterator[_Picture]:
    for number, state in enumerate(volume.palette):
        parsed = parse_state(state)
        if parsed.name != PAINTING:
            continue
        properties = dict(parsed.properties)
        cells = np.argwhere(volume.states == number)
        owners = volume.instance[tuple(cells.T)]
        for owner in np.unique(owners).tolist():
            own = cells[owners == owner]
            class_id = int(volume.semantic[tuple(own[0])])
            yield _Picture(own, properties["facing"], properties["motif"], class_id, owner)


def _at_wall(picture: _Picture, solid: np.ndarray, free: np.ndarray) -> tuple[_Picture, np.ndarray]:
    """Return a picture at the nearest wall, and those of its cells that have the wall behind them.

    The front of a thin scanned picture is a guess, so the wall before it counts too.

    Args:
        picture: The picture.
        solid: Full blocks, bool [X, Y, Z].
        free: Air, bool [X, Y, Z], including the cells of pictures.
    """
    best = picture, picture.cells[:0]
    for shift, facing in product((0, 1), (picture.facing, _OPPOSITE[picture.facing])):
        back = -np.array(_STEPS[facing][0])
        cells = picture.cells + shift * back
        cells = cells[_lookup(free, cells)]
        supported = cells[_lookup(solid, cells + back)]
        if len(supported) > len(best[1]):
            best = picture._replace(cells=cells, facing=facing), supported
    return best


def _lookup(grid: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Look up cells, int [N, 3], in a bool grid; cells outside the grid are False."""
    inside = ((cells >= 0) & (cells < grid.shape)).all(axis=1)
    found = np.zeros(len(cells), bool)
    found[inside] = grid[tuple(cells[inside].T)]
    return found


def _best_painting(picture: _Picture, cells: np.ndarray) -> Entity:
    """Return the largest painting that fits on supported cells, in their middle if it can.

    Of paintings of the same size, those of the picture's motif are preferred.
    """
    ahead, along = (np.array(step) for step in _STEPS[picture.facing])
    plane = {tuple(cell) for cell in np.stack([cells @ along, cells[:, 1]], axis=1).tolist()}
    middle = np.mean(sorted(plane), axis=0)
    sizes = {(VARIANTS[name].width, VARIANTS[name].height) for name in HUNG}
    choices = []
    for (u, v), (width, height) in product(plane, sizes):
        covered = set(product(range(u, u + width), range(v, v + height)))
        if covered <= plane:
            away = np.abs(middle - (u + (width - 1) / 2, v + (height - 1) / 2)).sum()
            choices.append((-width * height, round(float(away), 3), (u, v), (width, height)))
    _, _, (u, v), size = min(choices)
    alike = [name for name in HUNG if VARIANTS[name][:2] == size]
    motifs = [name for name in alike if VARIANTS[name].motif == picture.motif] or alike
    depth = int(cells[0] @ ahead)
    return _painting(picture, motifs[picture.instance % len(motifs)], (u, v, depth))


def _painting(picture: _Picture, variant: str, first: tuple[int, int, int]) -> Entity:
    """Return a painting whose first cell is at (along the wall, up, ahead of the wall)."""
    ahead, along = (np.array(step) for step in _STEPS[picture.facing])
    width, height = VARIANTS[variant][:2]
    u, v, depth = first
    anchor = (u + (width - 1) // 2) * along + depth * ahead + (0, v + (height - 1) // 2, 0)
    centre = (u + (width - 1) / 2) * along + depth * ahead + (0, v + (height - 1) / 2, 0) + 0.5
    centre = centre - (1 - THICK) / 2 * ahead
    side = SIDES.index(picture.facing)
    nbt = {
        **dict.fromkeys(("variant", "Motive"), f"minecraft:{variant}"),  # Motive is before 1.19.
        **dict.fromkeys(("facing", "Facing"), Byte(side)),
        **dict(zip(("TileX", "TileY", "TileZ"), map(int, anchor), strict=True)),
        "Rotation": [Float(90.0 * side), Float(0.0)],
        "Tags": owner_tags(picture.class_id, picture.instance),
    }
    x, y, z = (float(value) for value in centre)
    return Entity((x, y, z), PAINTING, nbt, picture.class_id, picture.instance)
