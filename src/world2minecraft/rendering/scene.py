"""Preparation of a block volume for ray casting: the arrays of ``SceneTables`` and cell metadata.

The preparation scans the whole volume. To render many images of a volume, create the scene once and
pass it instead of the volume.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.rules.light import MAX_REACH
from world2minecraft.rendering.block_elements import BlockModel, ModelSource
from world2minecraft.rendering.block_models import BuiltinModels
from world2minecraft.rendering.empty_space_boxes import find_empty_boxes
from world2minecraft.rendering.light import LightField, light_field
from world2minecraft.rendering.light.exposure import standing_cells
from world2minecraft.rendering.off_grid_elements import (
    CellElements,
    EntityLabels,
    add_cell_rows,
    display_entity_elements,
    elements_by_cell,
    grid_margin,
    split_overhanging,
)
from world2minecraft.rendering.scene_baking import (
    AIR,
    Baker,
    ElementTable,
    is_pane,
    joins_neighbours,
    kind_of,
    models_of,
)
from world2minecraft.rendering.scene_tables import BOXES, JOINS, PANE, SceneTables

HIDDEN_LIGHT_BLOCKS = {"minecraft:light"}
# A build is dark where fewer of the places where one can stand have light of so many levels.
MIN_LIT_LEVEL, MIN_LIT_SHARE = 4, 0.6


@dataclass(frozen=True, eq=False)
class BlockScene:
    """A block volume prepared for rendering."""

    tables: SceneTables
    material: np.ndarray  # uint8 [L, M, 5], see rendering.atlas
    side_px: int  # of a texture
    semantic: np.ndarray  # uint8 [X, Y, Z]
    instance: np.ndarray  # uint16 [X, Y, Z]
    things: EntityLabels
    room_to_grid: np.ndarray  # float64 [4, 4]: room metres to cells of this grid
    cells_per_metre: float
    light: LightField
    exposure: float | None = None  # of all its pictures; None: by what lies around the camera
    exposures: dict[object, float] = field(
        default_factory=dict
    )  # found so far, see rendering.shading_parameters


def prepare_scene(
    volume: BlockVolume,
    looks: ModelSource | None = None,
    *,
    texture_px: int = 16,
    reach: float | None = None,
    hidden_lamps: bool | None = None,
) -> BlockScene:
    """Return the scene of a volume.

    Args:
        volume: The blocks and display entities.
        looks: Source of models and textures. None uses the built-in set.
        texture_px: Texture size in pixels: 16, 32, 64 or 128.
        reach: Number of blocks over which light loses one level. None uses the game's value of 1,
            or more if blocks are smaller than half a metre, so that rooms are lit.
        hidden_lamps: Whether the game's invisible light blocks emit light. None uses them only in
            builds that would otherwise be dark.

    Raises:
        ValueError: If the texture size or the reach is out of range.
    """
    baker = Baker(looks or BuiltinModels(texture_px), texture_px)
    return bake_scene(volume, baker, reach, hidden_lamps)[0]


def bake_scene(
    volume: BlockVolume,
    baker: Baker,
    reach: float | None = None,
    hidden_lamps: bool | None = None,
) -> tuple[BlockScene, CellElements]:
    """Return the scene of a volume, and the freestanding elements in each cell that has any.

    The arguments are those of ``prepare_scene``, with an empty baker that contains the models.
    """
    looks = baker.looks
    models, guests = split_overhanging(models_of(volume.palette, looks), volume.states)
    things, more = display_entity_elements(volume, looks)
    guests += more
    margin = grid_margin(guests, volume.states.shape)
    states = np.pad(volume.states, margin.T) if margin.any() else volume.states
    start, refs = _bake_palette(volume.palette, models, baker)
    cell_looks = states.astype(np.int32)
    lists = elements_by_cell([guest.moved(margin[0]) for guest in guests], states.shape, baker)
    start, refs = add_cell_rows(lists, cell_looks, start, refs)
    cells = np.array(list(lists), np.int64).reshape(-1, 3)
    kinds = np.array([kind_of(model, looks) for model in models], np.int8)[states]
    hosts = tuple(cells[kinds[tuple(cells.T)] == AIR].T)
    kinds[hosts] = BOXES
    grid_to_world = np.eye(4)
    grid_to_world[:3, 3] = volume.corner - margin[0]
    table, light = baker.table(), _light_of(volume, states, reach, hidden_lamps)
    space, bounds = find_empty_boxes(kinds)
    scene = BlockScene(
        tables=SceneTables(
            space=space,
            bounds=bounds,
            looks=cell_looks,
            look_start=start,
            refs=refs,
            **_element_arrays(table),
            light=light.lattice,
            window=np.array([margin[0], volume.states.shape], np.int64),
            semantic=volume.semantic.reshape(-1),
            instance=volume.instance.reshape(-1),
            thing_semantic=things.semantic,
            thing_instance=things.instance,
        ),
        material=table.atlas.material,
        side_px=baker.side_px,
        semantic=volume.semantic,
        instance=volume.instance,
        things=things,
        room_to_grid=np.linalg.inv(volume.block_to_room @ grid_to_world),
        cells_per_metre=volume.blocks_per_metre,
        light=light,
    )
    return scene, lists


def _light_of(
    volume: BlockVolume, states: np.ndarray, reach: float | None, hidden_lamps: bool | None
) -> LightField:
    """Return the light of a volume's states, which may have a margin; see ``prepare_scene``."""
    if reach is None:
        reach = min(max(1.0, volume.blocks_per_metre / 2), MAX_REACH)
    light = light_field(states, volume.palette, reach, hidden_lamps=bool(hidden_lamps))
    if hidden_lamps is not None or not HIDDEN_LIGHT_BLOCKS & {
        state.partition("[")[0] for state in volume.palette
    }:
        return light
    where = standing_cells(light)
    bright = np.maximum(light.sky, light.block).reshape(-1)[where] >= MIN_LIT_LEVEL * reach
    if len(where) == 0 or bright.mean() >= MIN_LIT_SHARE:
        return light
    return light_field(states, volume.palette, reach)


def _bake_palette(
    palette: Sequence[str], models: Sequence[BlockModel], baker: Baker
) -> tuple[np.ndarray, np.ndarray]:
    """Bake the models of a palette; return ``look_start`` and ``refs``."""
    refs, counts = [], []
    for state, model in zip(palette, models, strict=True):
        refs += bake_model(state, model, baker)
        counts.append(len(model.elements))
    start = np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)
    return start, np.array(refs, np.int32)


def with_elements(scene: BlockScene, baker: Baker, looks: Sequence[tuple[int, ...]]) -> BlockScene:
    """Return the scene with all elements of a baker and new rows of elements.

    Args:
        scene: The scene, whose cells are kept.
        baker: The baker of the scene, which may have received more elements.
        looks: Elements of each row, starting with the rows of the scene.
    """
    tables = scene.tables
    if len(looks) > len(tables.look_start) - 1:
        start = np.concatenate([[0], np.cumsum([len(look) for look in looks])]).astype(np.int32)
        refs = np.array([number for look in looks for number in look], np.int32)
        tables = tables._replace(look_start=start, refs=refs)
    if len(baker.elements) == len(tables.boxes):
        return replace(scene, tables=tables)
    table = baker.table()
    tables = tables._replace(**_element_arrays(table))
    return replace(scene, tables=tables, material=table.atlas.material)


def bake_model(state: str, model: BlockModel, baker: Baker) -> list[int]:
    """Bake the elements of a state's model and return their numbers."""
    flags = JOINS * joins_neighbours(state, model) | PANE * is_pane(state)
    even = not model.ambient_occlusion
    return [baker.add(element, flags, even=even) for element in model.elements]


def _element_arrays(table: ElementTable) -> dict[str, np.ndarray]:
    """Return the fields of ``SceneTables`` that elements and their textures fill."""
    return {
        "boxes": table.boxes,
        "traits": table.traits,
        "turns": table.turns,
        "normals": table.normals,
        "layers": table.layers,
        "uv": table.uv,
        "tints": table.tints,
        "emission": table.emission,
        "texels": table.atlas.texels,
        "translucent": table.atlas.translucent,
    }
