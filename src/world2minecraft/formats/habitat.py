"""A scene dataset for Habitat-Sim: meshes, semantic colours and the JSON files that name them.

::

    NAME.scene_dataset_config.json      the file to open in Habitat
    scenes/NAME.scene_instance.json     a scene with the stage and no separate objects
    stages/NAME.stage_config.json       the files of the stage
    stages/NAME.glb                     meshes for rendering
    stages/NAME.semantic.glb            the same meshes with a unique colour per object
    stages/NAME.semantic.txt            colour, id and name of each object, in HM3D's format
    stages/info_semantic.json           classes, objects and their boxes, in Replica's format

The id of an object is its ``instance``. Walls, floor and other structure have the ids after the
last object. Meshes have y up. The boxes in ``info_semantic.json`` are in the room frame with z up,
as Habitat expects for Replica.
"""

import colorsys
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft import __version__
from world2minecraft.core.classes import CLASS_DISPLAY_NAMES
from world2minecraft.core.coordinates import ROOM_AXES_TO_BLOCK
from world2minecraft.core.errors import UsageError
from world2minecraft.core.files import write_bytes, write_json, write_text
from world2minecraft.core.types import BlockVolume
from world2minecraft.core.vocabulary import nyu40_of
from world2minecraft.formats.block_meshes import BlockMesh, volume_meshes
from world2minecraft.formats.gltf import (
    GlbWriter,
    add_default_scene,
    add_triangles,
    add_vertices,
    base_center,
    body_extras,
    gltf_bytes,
)
from world2minecraft.geometry.colour import srgb_to_linear

HEADER = "HM3D Semantic Annotations"
MAX_ID = 10_000  # Habitat's own limit.
_TURN = 0.618034  # Step on the colour circle between objects, so that neighbours differ.


def write_habitat(
    volume: BlockVolume,
    folder: str | Path,
    *,
    name: str = "room",
    names: Mapping[int, str] | None = None,
) -> None:
    """Write a volume as a Habitat scene dataset with one scene.

    Args:
        volume: Blocks to write. If they have labels, each object becomes a mesh.
        folder: Output folder, which is created if necessary.
        name: Name of the scene.
        names: Name of each object by id, such as ``office chair``. Others have that of their class.

    Raises:
        UsageError: If the volume contains no visible blocks or more than 10,000 objects, or if the
            name is not a valid file name.
        OutputError: If a file cannot be written.
    """
    if not name or not all(letter.isalnum() or letter in "_-" for letter in name):
        raise UsageError(f"scene name must consist of letters, digits, _ and -, got {name!r}")
    target, render = Path(folder), gltf_bytes(volume, names=names, keep_blocks=False)
    meshes, _ = volume_meshes(volume, names)
    ids = semantic_ids(meshes)
    stages = target / "stages"
    write_bytes(stages / f"{name}.glb", render)
    write_bytes(stages / f"{name}.semantic.glb", _semantic_glb(meshes, ids))
    write_text(stages / f"{name}.semantic.txt", semantic_text(meshes, ids))
    write_json(stages / "info_semantic.json", semantic_json(meshes, ids))
    write_json(stages / f"{name}.stage_config.json", _stage(name))
    scene = {"stage_instance": {"template_name": name}, "object_instances": []}
    write_json(target / "scenes" / f"{name}.scene_instance.json", scene)
    dataset = {
        "stages": {"paths": {".json": ["stages"]}},
        "scene_instances": {"paths": {".json": ["scenes"]}},
    }
    write_json(target / f"{name}.scene_dataset_config.json", dataset)


def semantic_ids(meshes: Sequence[BlockMesh]) -> list[int]:
    """Return the id of each mesh: its object id, or the next free id for structure.

    Raises:
        UsageError: If an id exceeds the limit of Habitat.
    """
    last = max(mesh.instance for mesh in meshes)
    ids = []
    for mesh in meshes:
        last += not mesh.instance
        ids.append(mesh.instance or last)
    if max(ids) > MAX_ID:
        raise UsageError(
            f"Habitat supports ids up to {MAX_ID:,}, but the highest object id is {max(ids):,}"
        )
    return ids


def semantic_colour(number: int) -> tuple[int, int, int]:
    """Return the sRGB colour of an id, which is unique for ids up to 10,000.

    Example:
        >>> semantic_colour(1)
        (32, 64, 193)
    """
    hue = number * _TURN % 1.0
    value = 1.0 - 0.15 * (number % 4)
    red, green, blue = (round(255 * part) for part in colorsys.hsv_to_rgb(hue, 0.85, value))
    # The lowest bits tell ids apart for sure.
    low = (number >> 10 & 15, number >> 5 & 31, number & 31)
    return red & ~15 | low[0], green & ~31 | low[1], blue & ~31 | low[2]


def semantic_text(meshes: Sequence[BlockMesh], ids: Sequence[int]) -> str:
    """Return the object list in HM3D's format: a header, then id, colour, name and region."""
    rows = [
        f'{number},{"".join(f"{part:02X}" for part in semantic_colour(number))},"{_plain(mesh)}",0'
        for number, mesh in sorted(zip(ids, meshes, strict=True), key=lambda pair: pair[0])
    ]
    return "\n".join([HEADER, *rows]) + "\n"


def semantic_json(meshes: Sequence[BlockMesh], ids: Sequence[int]) -> dict[str, Any]:
    """Return Replica's ``info_semantic.json``: classes, objects with boxes, and classes of ids.

    Objects have a ``name`` and a ``nyu40`` id beside their class of the paper's twelve.
    ``id_to_label`` contains the class of each id from 0, or -1 for ids without an object.
    """
    pairs = sorted(zip(ids, meshes, strict=True), key=lambda pair: pair[0])
    labels = [-1] * (max(ids) + 1)
    for number, mesh in pairs:
        labels[number] = mesh.class_id
    classes = [{"id": 0, "name": "unknown"}]
    classes += [{"id": n, "name": name} for n, name in enumerate(CLASS_DISPLAY_NAMES) if n]
    return {
        "classes": classes,
        "objects": [_object(number, mesh) for number, mesh in pairs],
        "id_to_label": labels,
    }


def _object(number: int, mesh: BlockMesh) -> dict[str, Any]:
    to_room = ROOM_AXES_TO_BLOCK.T
    low, high = mesh.bounds
    center, sizes = to_room @ ((low + high) / 2), np.abs(to_room @ (high - low))
    return {
        "id": number,
        "class_id": mesh.class_id,
        "class_name": CLASS_DISPLAY_NAMES[mesh.class_id] if mesh.class_id else "unknown",
        "name": mesh.title,
        "nyu40": nyu40_of(mesh.object_name, mesh.class_id) if mesh.class_id else 0,
        "instance": mesh.instance,
        "oriented_bbox": {
            "abb": {"center": np.round(center, 6).tolist(), "sizes": np.round(sizes, 6).tolist()},
            "orientation": {"rotation": [0.0, 0.0, 0.0, 1.0], "translation": [0.0, 0.0, 0.0]},
        },
    }


def _plain(mesh: BlockMesh) -> str:
    """Return the name of a mesh without the marks that separate the fields of a line."""
    return " ".join(re.split(r'[",\s]+', mesh.title)).strip() or "unknown"


def _stage(name: str) -> dict[str, Any]:
    upright = {"up": [0, 1, 0], "front": [0, 0, -1]}
    return {
        "render_asset": f"{name}.glb",
        "semantic_asset": f"{name}.semantic.glb",
        "semantic_descriptor_filename": f"{name}.semantic.txt",
        "has_semantic_textures": False,
        **upright,
        **{f"semantic_{key}": value for key, value in upright.items()},
        "origin": [0, 0, 0],
        "scale": [1, 1, 1],
        "units_to_meters": 1.0,
        "is_collidable": True,
        "shader_type": "flat",
    }


def _semantic_glb(meshes: Sequence[BlockMesh], ids: Sequence[int]) -> bytes:
    """Return the meshes with uniform vertex colours, which are linear in glTF."""
    writer = GlbWriter(f"World2Minecraft {__version__}")
    nodes = []
    for number, mesh in zip(ids, meshes, strict=True):
        rows = np.arange(len(mesh.looks))
        colour = srgb_to_linear(np.array(semantic_colour(number), np.uint8))
        attributes = add_vertices(writer, mesh, rows)
        painted = np.tile(colour.astype(np.float32), (4 * len(rows), 1))
        attributes["COLOR_0"] = writer.accessor(painted, "vertices")
        primitive = {"attributes": attributes, "indices": add_triangles(writer, len(rows))}
        index = writer.add("meshes", {"name": mesh.name, "primitives": [primitive]})
        extras = body_extras(mesh) | {"id": number}
        place = {"translation": base_center(mesh).tolist(), "extras": extras}
        nodes.append(writer.add("nodes", {"name": mesh.name, "mesh": index, **place}))
    add_default_scene(writer, nodes)
    return writer.to_bytes()
