"""Door leaves: real doors of wood, that open and that a player can walk through."""

from dataclasses import replace

import numpy as np
import pytest
from tests.construction.build_samples import DARK, FLOOR, OBJS, VOXEL_M, WHITE, WOOD, Sketch

from world2minecraft.construction import BuildParameters, build_volume, with_hinges
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import BlockVolume, Layout, Opening
from world2minecraft.minecraft.block_states import parse_state
from world2minecraft.minecraft.physics.shortest_paths import shortest_path
from world2minecraft.minecraft.physics.walk_graph import WalkRule, walk_graph
from world2minecraft.minecraft.rules.stability import find_unstable

SIZE = (50, 50, 30)
LOW, HIGH, HEAD = 13, 25, 25  # The leaf along its wall and its height, in cells.
OUTWARD = {"east": (1, 0), "west": (-1, 0), "north": (0, 1), "south": (0, -1)}


def room_with_leaf(side: str, colour=WOOD, deep: int = 1) -> tuple[Sketch, Layout]:
    """A room with a closed leaf in one wall, which reaches from the wall's face to its back."""
    sketch = Sketch(SIZE)
    x, y, _ = SIZE
    low = (-deep, 0)
    across = {"east": (x, x + deep), "west": low, "north": (y, y + deep), "south": low}[side]
    face = {"east": x, "west": 0, "north": y, "south": 0}[side] * VOXEL_M
    spans = [across, (LOW, HIGH)] if side in ("east", "west") else [(LOW, HIGH), across]
    sketch.put(*spans, (0, HEAD), OBJS, colour, 7)
    along = np.array([LOW, HIGH]) * VOXEL_M
    ends = [[face, a] if side in ("east", "west") else [a, face] for a in along]
    outline = np.array([[0, 0], [x, 0], [x, y], [0, y]]) * VOXEL_M
    opening = Opening("door", np.array(ends[0]), np.array(ends[1]), 0.0, HEAD * VOXEL_M)
    return sketch, Layout(outline, SIZE[2] * VOXEL_M, (opening,))


def built(sketch: Sketch, room: Layout, scale=4.0, **settings) -> BlockVolume:
    return build_volume(
        sketch.grid(),
        (),
        (),
        corner_m=sketch.corner_m,
        blocks_per_metre=scale,
        parameters=BuildParameters(**settings),
        rooms=(room,),
    )


def doors_of(volume: BlockVolume) -> list[tuple[tuple[int, ...], dict[str, str]]]:
    """The cell and the properties of each half of a door."""
    return [
        (tuple(cell), dict(state.properties) | {"name": state.name})
        for cell in np.argwhere(volume.states).tolist()
        if (state := parse_state(volume.palette[volume.states[tuple(cell)]])).name.endswith("_door")
    ]


def walks_through(volume: BlockVolume, side: str, *, opens: bool = True) -> bool:
    """Whether a player of the game's size gets from the room's middle to behind the door."""
    graph = walk_graph(volume, WalkRule(scale=1.0, jump=True, opens_doors=opens))
    east, north = OUTWARD[side]
    cells = np.array([cell for cell, _ in doors_of(volume)])
    goal = cells.mean(axis=0) + 0.5 + np.array([east, 0, -north])
    goal[1] = cells[:, 1].min()
    goal += volume.corner
    end = graph.nearest(goal)
    middle = np.array(volume.corner) + np.array(volume.states.shape) / 2
    start = graph.nearest((middle[0], goal[1], middle[2]))
    if np.abs(graph.feet[end] - goal).max() > 0.75:
        return False
    return shortest_path(graph, start, end) is not None


@pytest.mark.parametrize("side", sorted(OUTWARD))
@pytest.mark.parametrize("scale", [1.0, 2.0, 3.0, 4.0])
def test_player_walks_through_opened_door(side: str, scale: float) -> None:
    volume = built(*room_with_leaf(side), scale)
    assert {half["facing"] for _, half in doors_of(volume)} == {side}
    assert walks_through(volume, side)
    assert not walks_through(volume, side, opens=False)
    assert find_unstable(volume) == []


@pytest.mark.parametrize("scale", [1.0, 4.0])
def test_edge_of_the_room_does_not_close_the_way(scale: float) -> None:
    sketch, room = room_with_leaf("south", deep=2)
    assert walks_through(built(sketch, room, scale), "south")


def test_door_has_two_halves_and_outer_hinges() -> None:
    halves = doors_of(built(*room_with_leaf("east")))
    assert len(halves) == 4  # 0.96 m are four blocks: a pair of doors.
    lower = {cell[2]: half for cell, half in halves if half["half"] == "lower"}
    north, south = sorted(lower)
    assert (lower[north]["hinge"], lower[south]["hinge"]) == ("left", "right")
    assert all(half["open"] == "false" for _, half in halves)
    upper = {(x, y - 1, z) for (x, y, z), half in halves if half["half"] == "upper"}
    assert upper == {cell for cell, half in halves if half["half"] == "lower"}


def test_hinge_is_at_the_nearer_corner_by_default() -> None:
    for side, hinge in (("east", "right"), ("west", "left"), ("north", "left"), ("south", "right")):
        room = with_hinges([room_with_leaf(side)[1]])[0]
        assert room.openings[0].hinge == hinge, side


@pytest.mark.parametrize("is_open", [False, True])
def test_layout_states_hinge_and_whether_it_is_open(is_open: bool) -> None:
    sketch, room = room_with_leaf("north")
    stated = replace(room.openings[0], hinge="right", is_open=is_open)
    halves = doors_of(built(sketch, replace(room, openings=(stated,)), 1.0))
    assert {half["hinge"] for _, half in halves} == {"right"}
    assert {half["open"] for _, half in halves} == {str(is_open).lower()}


@pytest.mark.parametrize(("colour", "wood"), [(WHITE, "birch"), (DARK, "dark_oak")])
def test_door_has_the_wood_nearest_in_colour(colour, wood: str) -> None:
    halves = doors_of(built(*room_with_leaf("east", colour)))
    assert {half["name"] for _, half in halves} == {f"minecraft:{wood}_door"}


def test_rest_of_the_leaf_is_of_the_same_wood() -> None:
    volume = built(*room_with_leaf("south"))
    own = volume.instance == 7
    names = {volume.palette[n].partition("[")[0] for n in np.unique(volume.states[own])}
    kinds = {name.rpartition("_")[2] for name in names}
    assert kinds == {"door", "trapdoor"}
    assert len({name.rpartition("_")[0] for name in names}) == 1
    assert np.ptp(np.argwhere(own), axis=0).tolist() == [3, 7, 0]  # 4 x 8 blocks, one thick.
    assert set(np.unique(volume.semantic[own])) == {OBJS}


def test_doorstep_has_an_edge_unless_edges_are_off() -> None:
    sketch, room = room_with_leaf("east")
    for edge in ("barrier", "none"):
        volume = built(sketch, room, edge=edge, lights="off")
        cells = np.array([cell for cell, _ in doors_of(volume)])
        x, y, z = cells.max(axis=0)[0], cells[:, 1].min(), cells[:, 2]
        beyond = volume.states[x + 1, y - 1, z.min() : z.max() + 1]
        assert (volume.semantic[x + 1, y - 1, z.min() : z.max() + 1] == FLOOR).all()
        assert (beyond > 0).all()
        barriers = [n for n, name in enumerate(volume.palette) if name.endswith("barrier")]
        fenced = np.isin(volume.states[x + 2, y, z.min() : z.max() + 1], barriers)
        assert fenced.all() == (edge == "barrier")


def test_without_rooms_or_leaf_cells_there_is_no_door() -> None:
    sketch, room = room_with_leaf("east")
    assert doors_of(build_volume(sketch.grid(), (), (), corner_m=sketch.corner_m)) == []
    sketch.labels[sketch.instance == 7] = SemanticClass.WALL
    assert doors_of(built(sketch, room)) == []


def test_display_builds_have_doors_too() -> None:
    volume = built(*room_with_leaf("west"), style="display")
    assert walks_through(volume, "west")
    assert all(entity.instance != 7 for entity in volume.entities)
