"""Conversion of entities to NBT, and block display entities of any size and rotation.

A ``block_display`` entity renders one block state in games since 1.19.4. Its ``transformation``
applies to the block's unit cube in this order: ``right_rotation``, ``scale``, ``left_rotation``,
``translation``. The entity's ``Rotation`` and position apply last. All axes are block axes: x is
east, y is up, z is south.

Entities have no collision boxes. Tags such as ``w2m``, ``w2m_object_7`` and ``w2m_class_chair``
identify the object that an entity is part of, and are preserved in files.
"""

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.core.errors import MALFORMED, UsageError
from world2minecraft.core.types import BlockVolume, Entity
from world2minecraft.minecraft.block_states import parse_state
from world2minecraft.minecraft.nbt import Float
from world2minecraft.minecraft.paintings import PAINTING, painting_cube
from world2minecraft.minecraft.versions import GameVersion

BLOCK_DISPLAY = "minecraft:block_display"
FIRST_VERSION = 3337  # 1.19.4, the first game with display entities.
TAG = "w2m"
VIEW_BLOCKS = 64.0  # How far the game draws a display of view range 1, at its usual setting.
DECIMALS = 6  # Of blocks: finer than single precision tells at the edge of a room.


def entity_nbt(entity: Entity, number: int) -> dict[str, Any]:
    """Return the NBT of an entity, with a UUID derived from its number so that it is unique."""
    digest = hashlib.sha256(f"{number} {entity.id} {entity.position}".encode()).digest()
    common = {
        "Motion": [0.0, 0.0, 0.0],
        "Rotation": [Float(0), Float(0)],
        "UUID": np.frombuffer(digest[:16], ">i4").astype(np.int32),
    }
    return {**common, **entity.nbt, "id": entity.id, "Pos": [float(v) for v in entity.position]}


def entity_tags(nbt: Mapping[str, Any]) -> list[str]:
    """Return the command tags of an entity's NBT, or an empty list if the field is not a list.

    Example:
        >>> entity_tags({"Tags": ["chair", 7]}), entity_tags({"Tags": 7})
        (['chair', '7'], [])
    """
    tags = nbt.get("Tags")
    return [str(tag) for tag in tags] if isinstance(tags, list | tuple) else []


@dataclass(frozen=True, eq=False)
class DisplayCube:
    """The block state that a display entity or painting renders, and the transform of its cube.

    ``cube_to_world``, float64 [4, 4], maps [0, 1] cubed to world block coordinates.
    """

    state: str
    cube_to_world: np.ndarray
    class_id: int = 0
    instance: int = 0


def block_display(
    state: str,
    box: np.ndarray,
    position: Sequence[float],
    *,
    yaw_deg: float = 0.0,
    class_id: int = 0,
    instance: int = 0,
    view_range: float = 1.0,
    light: int | None = None,
) -> Entity:
    """Return a display entity that renders a box with the texture of one block.

    Args:
        state: The block state to render.
        box: x0, y0, z0, x1, y1, z1 in blocks relative to ``position``, before rotation; float64
            [6].
        position: The entity's position in world block coordinates. The game uses the light level at
            this position.
        yaw_deg: Rotation about the position in degrees, counter-clockwise seen from above.
        class_id: The class of the object that the entity is part of.
        instance: The instance number of the object that the entity is part of.
        view_range: The distance up to which the game renders the entity, in units of 64 blocks.
        light: A fixed light level from 0 to 15. The default is the light level at the position.

    Raises:
        UsageError: If ``state`` is not a valid block state.
    """
    quarters = int(np.round(yaw_deg / 90.0))
    turned, rest = _rotate_box(np.asarray(box, np.float64), quarters), yaw_deg - 90.0 * quarters
    low, size = turned[:3], turned[3:] - turned[:3]
    half = np.radians(rest) / 2
    nbt: dict[str, Any] = {
        "block_state": _state_nbt(state),
        "transformation": {
            "left_rotation": _floats([0.0, np.sin(half), 0.0, np.cos(half)]),
            "right_rotation": _floats([0.0, 0.0, 0.0, 1.0]),
            "scale": _floats(size),
            "translation": _floats(_rotation_about_y(rest) @ low),
        },
        "view_range": Float(view_range),
        # Stated, so that a rotation of the volume rotates it too.
        "Rotation": _floats([0.0, 0.0]),
        "Tags": owner_tags(class_id, instance),
    }
    if light is not None:
        nbt["brightness"] = {"block": int(light), "sky": int(light)}
    x, y, z = (round(float(value), DECIMALS) for value in position)
    return Entity((x, y, z), BLOCK_DISPLAY, nbt, class_id, instance)


def owner_tags(class_id: int, instance: int) -> list[str]:
    """Return the tags that identify the object that an entity is part of."""
    tags = [TAG]
    if class_id:
        tags.append(f"{TAG}_class_{CLASS_NAMES[class_id]}")
    return [*tags, f"{TAG}_object_{instance}"] if instance else tags


def owner_of(entity: Entity) -> tuple[int, int]:
    """Return the class and instance of the object that an entity is part of.

    The tags are used if the entity's own fields are 0.
    """
    class_id, instance = entity.class_id, entity.instance
    for tag in entity_tags(entity.nbt):
        kind, _, name = tag.removeprefix(f"{TAG}_").partition("_")
        if kind == "class" and not class_id and name in CLASS_NAMES:
            class_id = CLASS_NAMES.index(name)
        elif kind == "object" and not instance and name.isdecimal() and int(name) < 1 << 16:
            instance = int(name)
    return class_id, instance


def display_cubes(entities: Iterable[Entity]) -> list[DisplayCube]:
    """Return the cubes that block displays and paintings render, without other and invalid ones."""
    found = (_PARSERS[entity.id](entity) for entity in entities if entity.id in _PARSERS)
    return [cube for cube in found if cube is not None]


def check_displays(volume: BlockVolume, version: GameVersion) -> None:
    """Check that the game version supports the display entities of a volume.

    Raises:
        UsageError: If the volume contains display entities and the game is older than 1.19.4.
    """
    if version.data_version < FIRST_VERSION and any(
        entity.id.endswith("_display") for entity in volume.entities
    ):
        raise UsageError(
            f"Minecraft {version.name} does not support display entities (new in 1.19.4); use "
            "build.style=blocks or another version (--mc-version)"
        )


def _parse_display(entity: Entity) -> DisplayCube | None:
    try:
        state = _state_text(entity.nbt["block_state"])
        placed = np.eye(4)
        placed[:3, 3] = entity.position
        matrix = (
            placed @ _entity_rotation(entity.nbt) @ _matrix_of(entity.nbt.get("transformation"))
        )
    except (*MALFORMED, UsageError):
        return None  # The file is not ours, and a game that reads it draws nothing either.
    if not np.isfinite(matrix).all() or abs(matrix).max() > 1e9:
        return None
    class_id, instance = owner_of(entity)
    return DisplayCube(state, matrix, class_id, instance)


def _parse_painting(entity: Entity) -> DisplayCube | None:
    try:
        state, matrix = painting_cube(entity.nbt, entity.position)
    except MALFORMED:
        return None
    return DisplayCube(state, matrix, *owner_of(entity))


_PARSERS = {BLOCK_DISPLAY: _parse_display, PAINTING: _parse_painting}


def _matrix_of(transformation: Any) -> np.ndarray:
    """Return the 4x4 matrix of a transformation, given as components or as 16 numbers."""
    if transformation is None:
        return np.eye(4)
    if not isinstance(transformation, Mapping):
        return np.array(transformation, np.float64).reshape(4, 4)
    turn = _rotation_of(transformation.get("left_rotation"))
    stretch = np.diag(_vector3(transformation.get("scale"), 1.0))
    matrix = np.eye(4)
    matrix[:3, :3] = turn @ stretch @ _rotation_of(transformation.get("right_rotation"))
    matrix[:3, 3] = _vector3(transformation.get("translation"), 0.0)
    return matrix


def _vector3(values: Any, default: float) -> np.ndarray:
    return np.array([default] * 3 if values is None else values, np.float64).reshape(3)


def _rotation_of(stated: Any) -> np.ndarray:
    """Return the 3x3 matrix of a quaternion (x, y, z, w), or of an axis and an angle in radians."""
    if stated is None:
        return np.eye(3)
    if isinstance(stated, Mapping):
        axis = np.array(stated["axis"], np.float64).reshape(3)
        half = float(stated["angle"]) / 2
        axis = axis / max(float(np.linalg.norm(axis)), 1e-12)
        x, y, z, w = *(axis * np.sin(half)), np.cos(half)
    else:
        quaternion = np.array(stated, np.float64).reshape(4)
        x, y, z, w = quaternion / max(float(np.linalg.norm(quaternion)), 1e-12)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def _entity_rotation(nbt: Mapping[str, Any]) -> np.ndarray:
    """Return the 4x4 matrix of an entity's Rotation (yaw clockwise from above, pitch down)."""
    yaw, pitch = (float(value) for value in nbt.get("Rotation", (0.0, 0.0)))
    cosine, sine = np.cos(np.radians(pitch)), np.sin(np.radians(pitch))
    turn = np.eye(4)
    turn[:3, :3] = _rotation_about_y(-yaw) @ [[1, 0, 0], [0, cosine, -sine], [0, sine, cosine]]
    return turn


def _rotation_about_y(yaw_deg: float) -> np.ndarray:
    """Return the 3x3 rotation about the y axis, counter-clockwise seen from above."""
    cosine, sine = np.cos(np.radians(yaw_deg)), np.sin(np.radians(yaw_deg))
    return np.array([[cosine, 0, sine], [0, 1, 0], [-sine, 0, cosine]])


def _rotate_box(box: np.ndarray, quarter_turns: int) -> np.ndarray:
    """Rotate a box about the y axis by quarter turns: x becomes -z, and z becomes x."""
    for _ in range(quarter_turns % 4):
        x0, y0, z0, x1, y1, z1 = box
        box = np.array([z0, y0, -x1, z1, y1, -x0])
    return box


def _floats(values: Iterable[float]) -> list[Float]:
    """Convert numbers to tags, rounded so that every machine writes the same bytes."""
    return [Float(round(float(value), DECIMALS) + 0.0) for value in values]


def _state_nbt(state: str) -> dict[str, Any]:
    parsed = parse_state(state)
    if not parsed.properties:
        return {"Name": parsed.name}
    return {"Name": parsed.name, "Properties": dict(parsed.properties)}


def _state_text(nbt: Mapping[str, Any]) -> str:
    """Return the validated text of a block state from an untrusted file."""
    pairs = ",".join(f"{key}={value}" for key, value in dict(nbt.get("Properties", {})).items())
    return str(parse_state(f"{nbt['Name']}[{pairs}]" if pairs else str(nbt["Name"])))
