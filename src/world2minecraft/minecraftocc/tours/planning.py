"""``plan_views``: walks through all rooms of a volume, and the views of them that are worth it."""

from world2minecraft.core.errors import UsageError
from world2minecraft.core.progress import Progress, silent
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.physics.walk_graph import (
    SLIM,
    Solid,
    WalkGraph,
    WalkRule,
    solid_of,
    walk_graph,
)
from world2minecraft.minecraftocc.tours.rooms import TourRoom, find_rooms, shared
from world2minecraft.minecraftocc.tours.tourist import Kinds, Tourist
from world2minecraft.minecraftocc.tours.values import PlannedView, TourRule
from world2minecraft.minecraftocc.tours.walks import Grounds
from world2minecraft.rendering.scene import BlockScene, prepare_scene

LEAST_FLOOR_M2 = 1.0  # Of all rooms: with less a slimmer body is tried.


def plan_views(
    volume: BlockVolume,
    count: int,
    seed: int = 0,
    rule: TourRule | None = None,
    *,
    scene: BlockScene | None = None,
    progress: Progress = silent,
) -> list[PlannedView]:
    """Return views of the rooms of a volume, tour after tour; the same for the same seed.

    Fewer come back where the rooms do not give as many that differ.

    Args:
        volume: the blocks, with their classes.
        count: how many views.
        seed: 0 or more.
        rule: the camera and all choices.
        scene: ``prepare_scene`` of the volume, where the caller has it already.
        progress: told of the views found.

    Raises:
        UsageError: the count is below 1, or nobody can stand anywhere in the volume.
    """
    how = rule or TourRule()
    if count < 1:
        raise UsageError(f"a plan has one view or more, not {count}")
    solid = solid_of(volume)
    graph, rooms = _rooms(volume, solid, how)
    ready, kinds = scene or prepare_scene(volume), Kinds()
    tourists = []
    for room in rooms:
        grounds = Grounds(graph.part(room.places), solid, volume.corner)
        tourists.append(Tourist(volume, ready, room, grounds, how, seed, kinds))
    _fill(tourists, count, progress)
    return [view for tourist in tourists for view in tourist.views()]


def _rooms(volume: BlockVolume, solid: Solid, rule: TourRule) -> tuple[WalkGraph, list[TourRoom]]:
    """Return where a player walks in a volume; where none fits, where a slim one would.

    A cluttered scan may leave no floor that is wide enough for a person, though a camera fits.
    """
    for slim in (1.0, SLIM):
        graph = walk_graph(volume, WalkRule(scale=slim * volume.blocks_per_metre))
        rooms = find_rooms(volume, graph, solid, rule)
        if sum(room.floor_m2 for room in rooms) >= LEAST_FLOOR_M2 or (rooms and slim < 1):
            return graph, rooms
    raise UsageError("nobody can stand anywhere in this world, so there is no view to plan")


def _fill(tourists: list[Tourist], count: int, progress: Progress) -> None:
    """Let rooms find their shares; what one cannot give is asked of the others."""
    progress("views", 0, count)
    left = count
    while left > 0:
        open_ones = [one for one in tourists if not one.is_done]
        if not open_ones:
            break
        for one, share in zip(open_ones, shared([t.room for t in open_ones], left), strict=True):
            one.find(share)
            progress("views", min(count, sum(t.count for t in tourists)), count)
        left = count - sum(one.count for one in tourists)
    progress("views", count, count)
