"""Doors: each door leaf becomes a wooden door that a player can open and walk through.

A door of the game is one block wide and two high, and so is a player at every scale. Where a leaf
is larger, one or two doors stand at the bottom in its middle, and upright trapdoors of the same
wood fill the rest in the same plane. The way through the doors is cleared, and leads to a doorstep
where nothing was seen behind the wall.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from world2minecraft.construction.canvas import Canvas
from world2minecraft.construction.colour_sources import BuildSource
from world2minecraft.construction.door_leaves import FoundLeaves, Leaf
from world2minecraft.core.classes import SemanticClass
from world2minecraft.geometry.colour import srgb_to_oklab
from world2minecraft.minecraft.block_colours import colours_of

CEILING, FLOOR, WALL, OBJS = (
    int(SemanticClass[name]) for name in ("CEILING", "FLOOR", "WALL", "OBJS")
)
WOODS = ("oak", "spruce", "birch", "jungle", "acacia", "dark_oak")  # Of every version.
SIDES = {(0, 1): "east", (0, -1): "west", (1, 1): "north", (1, -1): "south"}  # By axis and sign.
PLAYER_BLOCKS = 2  # The height of a door, and the headroom of a player.
OPEN_COVER = 0.7  # Minimum share of a block's width that a leaf covers.
WALL_REACH = 2  # Layers beside a leaf's own in which its wall may have been built.
THICKEST_M = 0.45  # Of the wall around a door.


class Place(NamedTuple):
    """Where a leaf is built: its layer across the wall, its columns along it, and its rows."""

    layer: int
    columns: range
    rows: range


def put_doors(
    canvas: Canvas, footprints: Sequence[np.ndarray], found: FoundLeaves, source: BuildSource
) -> None:
    """Set the doors of a room with a finished shell and finished objects.

    Leaves in walls too low for a door, and all leaves if the palette has no door, are left out.

    Args:
        canvas: Canvas with the shell and the objects.
        footprints: Bool [X, Y] mask of the columns within the rooms, for each storey. The ways
            through the doors are added in place.
        found: The leaves.
        source: The grid with the leaves, its colours and the allowed blocks.
    """
    woods = [wood for wood in WOODS if source.palette.allows(f"minecraft:{wood}_door")]
    if not woods:
        return
    floor = _floor_block(canvas, source)
    for leaf in found.leaves:
        view = _View(canvas, leaf)
        place = view.place()
        if len(place.rows) < PLAYER_BLOCKS or not len(place.columns):
            continue
        wood = _nearest_wood(leaf, found, source, woods)
        view.fill_frame(place)
        view.put_leaf(place, wood, source.palette.allows(f"minecraft:{wood}_trapdoor"))
        storey = canvas.lattice.grounds.index(view.ground)
        view.clear_way(place, floor, footprints[storey])


def _floor_block(canvas: Canvas, source: BuildSource) -> str:
    """Return the most common block of the floors."""
    states = canvas.states[canvas.semantic == FLOOR]
    if not len(states):
        return source.palette.defaults[FLOOR]
    return canvas.palette[int(np.bincount(states).argmax())]


def _nearest_wood(leaf: Leaf, found: FoundLeaves, source: BuildSource, woods: Sequence[str]) -> str:
    """Return the wood of which the door is nearest in colour to a leaf."""
    cells = found.cells & source.coloured
    own = cells & (source.grid.instance == leaf.instance)
    cells = own if own.any() else cells
    if not cells.any():
        return woods[0]
    offered = srgb_to_oklab(colours_of([f"minecraft:{wood}_door" for wood in woods]))
    wanted = np.median(source.colours[cells], axis=0)
    return woods[int(np.linalg.norm(offered - wanted, axis=1).argmin())]


class _View:
    """The blocks around a leaf, seen with axis 0 leading out of the room and axis 1 along the wall.

    The arrays are views of those of the canvas.
    """

    def __init__(self, canvas: Canvas, leaf: Leaf):
        lattice = canvas.lattice
        self.canvas, self.leaf = canvas, leaf
        corners = np.zeros((2, 3))
        corners[:, leaf.axis] = leaf.face_m
        corners[:, 1 - leaf.axis] = leaf.along_m
        corners[:, 2] = leaf.floor_m, leaf.floor_m + leaf.head_m
        low, high = np.round(lattice.coordinates_of(corners), 6)
        self.along = float(low[1 - leaf.axis]), float(high[1 - leaf.axis])
        across = float(low[leaf.axis])
        self.face = across if leaf.sign > 0 else lattice.shape[leaf.axis] - across
        self.ground = lattice.ground_under(float(low[2]))
        self.height = max(PLAYER_BLOCKS, round(leaf.head_m * lattice.blocks_per_metre))
        self.states, self.semantic, self.instance = (
            self._turned(array) for array in (canvas.states, canvas.semantic, canvas.instance)
        )

    def _turned(self, array: np.ndarray) -> np.ndarray:
        """Return a view of a canvas array with the way out of the room first."""
        turned = np.moveaxis(array, self.leaf.axis, 0)
        return turned if self.leaf.sign > 0 else turned[::-1]

    def _put(self, at: tuple, state: str, class_id: int, instance: int = 0) -> None:
        self.states[at] = self.canvas.id_of(state)
        self.semantic[at] = class_id
        self.instance[at] = instance

    def place(self) -> Place:
        """Return where the leaf is built: in the layer in which most of its wall was built."""
        low, high = self.along
        touched = np.arange(
            max(int(np.floor(low)), 0), min(int(np.ceil(high)), len(self.states[0]))
        )
        cover = np.minimum(high, touched + 1) - np.maximum(low, touched)
        chosen = touched[cover >= min(OPEN_COVER, float(cover.max(initial=0)))]
        columns = range(int(chosen[0]), int(chosen[-1]) + 1) if len(chosen) else range(0)
        usual = int(np.floor(self.face + 0.5))
        near = range(max(usual - WALL_REACH, 0), min(usual + WALL_REACH + 1, len(self.states)))
        beside = [max(columns.start - 1, 0), min(columns.stop, self.states.shape[1] - 1)]
        body = slice(self.ground, self.ground + self.height)
        # Of equal layers, that behind the measured face.
        walled = {n: int((self.semantic[n, beside, body] == WALL).sum()) for n in near}
        layer = max(near, key=lambda n: (walled[n], -abs(n - usual)), default=usual)
        top = self.ground
        while top < min(self.ground + self.height, self.states.shape[2]):
            if (self.semantic[layer, columns.start : columns.stop, top] == CEILING).any():
                break
            top += 1
        return Place(layer, columns, range(self.ground, top))

    def fill_frame(self, place: Place) -> None:
        """Fill the gaps between the leaf and its wall with the most common block of the wall."""
        first, last = max(place.columns.start - 1, 0), place.columns.stop + 1
        reach = len(place.columns) + 2
        around = slice(max(first - reach, 0), last + reach), slice(self.ground, None)
        wall = self.states[place.layer][around][self.semantic[place.layer][around] == WALL]
        if not len(wall):
            return
        frame = slice(first, last), slice(self.ground, place.rows.stop + 1)
        states = self.states[place.layer][frame]
        gaps = states == 0
        states[gaps] = np.bincount(wall).argmax()
        self.semantic[place.layer][frame][gaps] = WALL

    def put_leaf(self, place: Place, wood: str, has_trapdoor: bool) -> None:
        """Set the doors, and panels of the same wood around them."""
        leaf, layer = self.leaf, place.layer
        facing = SIDES[leaf.axis, leaf.sign]
        panel = f"minecraft:{wood}_planks"
        if has_trapdoor:
            panel = f"minecraft:{wood}_trapdoor[facing={facing},half=bottom,open=true]"
        whole = (layer, slice(place.columns.start, place.columns.stop))
        self._put((*whole, slice(self.ground, place.rows.stop)), panel, OBJS, leaf.instance)
        state = f"minecraft:{wood}_door[facing={facing},open={str(leaf.is_open).lower()}"
        for column, hinge in self._doors(place).items():
            for up, half in enumerate(("lower", "upper")):
                full = f"{state},half={half},hinge={hinge}]"
                self._put((layer, column, self.ground + up), full, OBJS, leaf.instance)

    def _doors(self, place: Place) -> dict[int, str]:
        """Return the columns of the doors, in the middle of the leaf, and their hinges."""
        columns, middle = place.columns, place.columns[len(place.columns) // 2]
        if len(columns) % 2:
            return {middle: self.leaf.hinge}
        # West is left of who looks north, south of who looks west.
        lower_is_left = SIDES[self.leaf.axis, self.leaf.sign] in ("north", "west")
        lower, higher = ("left", "right") if lower_is_left else ("right", "left")
        return {middle - 1: lower, middle: higher}

    def clear_way(self, place: Place, floor: str, footprint: np.ndarray) -> None:
        """Clear the wall before and behind the doors, and add a doorstep if there is no floor.

        Args:
            place: Where the leaf was built.
            floor: Block of a doorstep.
            footprint: Bool [X, Y] mask of the columns of the storey, to which the way is added.
        """
        doors = self._doors(place)
        columns = slice(min(doors), max(doors) + 1)
        scale = self.canvas.lattice.blocks_per_metre
        for layer in range(max(place.layer - WALL_REACH, 0), place.layer):
            self._clear(layer, columns)
        beyond = place.layer + 1
        last = min(beyond + int(np.ceil(THICKEST_M * scale)), len(self.states) - 1)
        while beyond < last and self._clear(beyond, columns):
            beyond += 1
        if beyond > last:
            return
        ground = self.states[place.layer : beyond + 1, columns, self.ground - 1]
        missing = ground == 0
        ground[missing] = self.canvas.id_of(floor)
        self.semantic[place.layer : beyond + 1, columns, self.ground - 1][missing] = FLOOR
        self._turned(footprint)[place.layer : beyond + 1, columns] = True

    def _clear(self, layer: int, columns: slice) -> bool:
        """Remove the wall and the leaf from the way in a layer; return whether there were any."""
        body = layer, columns, slice(self.ground, self.ground + PLAYER_BLOCKS)
        leaf = (self.instance[body] == self.leaf.instance) & (self.instance[body] > 0)
        blocked = (self.semantic[body] == WALL) | leaf
        for array in (self.states, self.semantic, self.instance):
            array[body][blocked] = 0
        return bool(blocked.any())
