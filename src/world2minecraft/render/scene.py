"""A block volume made ready for rays: the arrays of ``SceneTables``, and what its cells are.

Making it costs one sweep over the volume; whoever takes many pictures of one volume makes the
scene once and passes it in the volume's place.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from world2minecraft.render.bake import AIR, Baker, ElementTable, joins, kind_of, models_of
from world2minecraft.render.elements import BlockModel, LookSource
from world2minecraft.render.empties import empty_boxes
from world2minecraft.render.light import LightField, light_field
from world2minecraft.render.looks import OwnLooks
from world2minecraft.render.standing_boxes import (
    StandingThings,
    margin_of,
    overhanging,
    place_guests,
    standing_things,
)
from world2minecraft.render.tables import BOXES, JOINS, SceneTables
from world2minecraft.types import BlockVolume


@dataclass(frozen=True, eq=False)
class BlockScene:
    """What pictures of a volume are taken of."""

    tables: SceneTables
    material: np.ndarray  # uint8 [L, M, 5], see render.atlas
    side_px: int  # of a texture
    semantic: np.ndarray  # uint8 [X, Y, Z]
    instance: np.ndarray  # uint16 [X, Y, Z]
    things: StandingThings
    room_to_grid: np.ndarray  # float64 [4, 4]: room metres to cells of this grid
    cells_per_metre: float
    light: LightField
    exposure: float | None = None  # of all its pictures; None: by what lies around the camera
    exposures: dict[object, float] = field(default_factory=dict)  # found so far, see render.lamps


def prepare_scene(
    volume: BlockVolume,
    looks: LookSource | None = None,
    *,
    texture_px: int = 16,
    reach: float = 1.0,
) -> BlockScene:
    """Return the scene of a volume.

    Args:
        volume: the blocks, with display entities.
        looks: where models and textures come from; our own set where None.
        texture_px: the side of a texture, 16, 32, 64 or 128.
        reach: how many blocks light goes for each level that it loses; 1 is the game's.

    Raises:
        ValueError: the size of the textures or the reach is out of range.
    """
    looks = looks or OwnLooks(texture_px)
    baker = Baker(looks, texture_px)
    models, guests = overhanging(models_of(volume.palette, looks), volume.states)
    things, more = standing_things(volume, looks)
    guests += more
    margin = margin_of(guests, volume.states.shape)
    states = np.pad(volume.states, margin.T) if margin.any() else volume.states
    start, refs = _lists_of(volume.palette, models, baker)
    cell_looks = states.astype(np.int32)
    start, refs, cells = place_guests(
        [guest.moved(margin[0]) for guest in guests], cell_looks, start, refs, baker
    )
    kinds = np.array([kind_of(model, looks) for model in models], np.int8)[states]
    hosts = tuple(cells[kinds[tuple(cells.T)] == AIR].T)
    kinds[hosts] = BOXES
    grid_to_world = np.eye(4)
    grid_to_world[:3, 3] = volume.corner - margin[0]
    table, light = baker.table(), light_field(states, volume.palette, reach)
    return BlockScene(
        tables=_tables(table, *empty_boxes(kinds), cell_looks, start, refs)._replace(
            light=light.lattice,
            window=np.array([margin[0], volume.states.shape], np.int64),
            semantic=volume.semantic.reshape(-1),
            instance=volume.instance.reshape(-1),
            thing_semantic=things.semantic,
            thing_instance=things.instance,
        ),
        material=table.atlas.material,
        side_px=texture_px,
        semantic=volume.semantic,
        instance=volume.instance,
        things=things,
        room_to_grid=np.linalg.inv(volume.block_to_room @ grid_to_world),
        cells_per_metre=volume.blocks_per_metre,
        light=light,
    )


def _lists_of(
    palette: Sequence[str], models: Sequence[BlockModel], baker: Baker
) -> tuple[np.ndarray, np.ndarray]:
    """Bake the models of a palette; return ``look_start`` and ``refs``."""
    refs, counts = [], []
    for state, model in zip(palette, models, strict=True):
        flags = JOINS * joins(state, model)
        refs += [
            baker.add(element, flags, even=not model.ambient_occlusion)
            for element in model.elements
        ]
        counts.append(len(model.elements))
    start = np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)
    return start, np.array(refs, np.int32)


def _tables(
    table: ElementTable,
    space: np.ndarray,
    bounds: np.ndarray,
    looks: np.ndarray,
    start: np.ndarray,
    refs: np.ndarray,
) -> SceneTables:
    """Return the tables, without light and window."""
    return SceneTables(
        space=space,
        bounds=bounds,
        looks=looks,
        look_start=start,
        refs=refs,
        boxes=table.boxes,
        traits=table.traits,
        turns=table.turns,
        normals=table.normals,
        layers=table.layers,
        uv=table.uv,
        tints=table.tints,
        emission=table.emission,
        texels=table.atlas.texels,
        translucent=table.atlas.translucent,
        light=np.empty((3, 0, 0, 0), np.uint16),
        window=np.zeros((2, 3), np.int64),
        semantic=np.zeros(1, np.uint8),
        instance=np.zeros(1, np.uint16),
        thing_semantic=np.zeros(1, np.uint8),
        thing_instance=np.zeros(1, np.uint16),
    )
