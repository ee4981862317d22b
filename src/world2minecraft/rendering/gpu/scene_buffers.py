"""A scene packed for the shader, in five buffers of 32-bit words.

``cells`` combines ``space`` and ``looks``: the index of an air box (0 or more), -1 - (2 * look + 1)
for boxes, or -1 - 2 * look for a full cube. ``tables`` contains all small tables one after another.
An element has ``ELEMENT_WORDS`` consecutive words, so that a ray reads them together. Freestanding
elements are relative to the cell with their centre (their anchor), so that 32 bits are sufficiently
precise in a large world.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.rendering.ray_caster.shading import dominant_face
from world2minecraft.rendering.scene import BlockScene
from world2minecraft.rendering.scene_tables import ABSOLUTE, BOXES, FLAGS, OWNER, TURN, SceneTables

# Words of an element: the box, then these.
TURN_WORD, FLAGS_WORD, OWNER_WORD, EMISSION_WORD, ANCHOR_WORD, FACES_WORD = 6, 7, 8, 9, 10, 13
# Words of a face: its texture, then these.
TINT_WORD, UV_WORD, FACE_WORDS = 1, 4, 12
ELEMENT_WORDS = FACES_WORD + 6 * FACE_WORDS
# Words of a turn: 3 x 4 to the element's frame, three normals, the main face of each side.
NORMALS_WORD, MAIN_WORD, TURN_WORDS = 12, 21, 22
TRANSLUCENT = 1 << 30
LAYOUT = {
    name: value for name, value in globals().items() if name.endswith(("_WORD", "_WORDS"))
}  # What the shader's constants are called.


@dataclass(frozen=True, eq=False)
class PackedScene:
    """The packed arrays of a scene, with the offsets of the tables within ``tables``."""

    cells: np.ndarray  # int32 [X * Y * Z]
    light: np.ndarray  # uint32, two entries of the lattice a word
    tables: np.ndarray  # uint32
    texels: np.ndarray  # uint32 [L * M]: red lowest, alpha highest
    labels: np.ndarray  # uint32 [N + S]: class, instance from bit 16; cells, then entities
    offsets: dict[str, int]

    @property
    def buffers(self) -> dict[str, np.ndarray]:
        """The arrays by their names in the shader."""
        return {
            "cells": self.cells, "light": self.light, "tables": self.tables,
            "texels": self.texels, "labels": self.labels,
        }  # fmt: skip


def pack_scene(scene: BlockScene) -> PackedScene:
    """Pack a scene for the shader."""
    tables = scene.tables
    turns, rows, anchors = _turns(tables)
    parts = {
        "at_bounds": np.ascontiguousarray(tables.bounds, np.int16).view(np.uint32),
        "at_starts": tables.look_start.astype(np.uint32),
        "at_refs": tables.refs.astype(np.uint32),
        "at_elements": _elements(tables, rows, anchors),
        "at_turns": turns,
    }
    flat = [np.ravel(part) for part in parts.values()]
    starts = np.concatenate([[0], np.cumsum([len(part) for part in flat])])
    light = np.ravel(tables.light)
    light = np.append(light, np.uint16(0)) if len(light) % 2 else light
    return PackedScene(
        cells=cell_words(tables),
        light=np.ascontiguousarray(light).view(np.uint32),
        tables=np.concatenate([*flat, np.zeros(1, np.uint32)]),
        texels=np.ascontiguousarray(tables.texels).view(np.uint32).ravel(),
        labels=_labels(tables),
        offsets=dict(zip(parts, map(int, starts), strict=False)),
    )


def buffer_bytes(scene: BlockScene) -> dict[str, int]:
    """Return the size in bytes of the buffers of a scene, without creating them."""
    tables = scene.tables
    words = (
        3 * len(tables.bounds) + len(tables.look_start) + len(tables.refs)
        + ELEMENT_WORDS * len(tables.boxes)
        + TURN_WORDS * int((tables.traits[:, TURN] >= 0).sum()) + 1
    )  # fmt: skip
    return {
        "cells": 4 * tables.space.size,
        "light": 4 * ((tables.light.size + 1) // 2),
        "tables": 4 * words,
        "texels": tables.texels.size,
        "labels": 4 * (len(tables.semantic) + len(tables.thing_semantic)),
    }


def cell_words(tables: SceneTables) -> np.ndarray:
    """Return the packed word of each cell, int32 [X * Y * Z]."""
    code = 2 * tables.looks + (tables.space == BOXES)
    return np.where(tables.space >= 0, tables.space, -1 - code).astype(np.int32).ravel()


def _labels(tables: SceneTables) -> np.ndarray:
    classes = np.concatenate([tables.semantic, tables.thing_semantic]).astype(np.uint32)
    objects = np.concatenate([tables.instance, tables.thing_instance]).astype(np.uint32)
    return classes | objects << 16


def _turns(tables: SceneTables) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return T turns uint32 [T, TURN_WORDS], each element's row of them, and its anchor."""
    turned = np.flatnonzero(tables.traits[:, TURN] >= 0)
    old = tables.traits[turned, TURN]
    rows = np.full(len(tables.traits), -1, np.int32)
    rows[turned] = np.arange(len(turned))
    anchors = np.zeros((len(rows), 3), np.int32)
    matrices = tables.turns[old].astype(np.float64)
    standing = tables.traits[turned, FLAGS] & ABSOLUTE != 0
    middle = tables.boxes[turned].reshape(-1, 2, 3).mean(axis=1).astype(np.float64)
    if standing.any():
        linear = matrices[standing, :, :3]
        away = (middle[standing] - matrices[standing, :, 3])[..., None]
        anchors[turned[standing]] = np.floor(np.linalg.solve(linear, away)[..., 0])
    matrices[..., 3] += np.einsum("nij,nj->ni", matrices[..., :3], anchors[turned])
    words = np.zeros((len(turned), TURN_WORDS), np.uint32)
    values = words.view(np.float32)
    values[:, :NORMALS_WORD] = matrices.reshape(-1, 12)
    values[:, NORMALS_WORD:MAIN_WORD] = tables.normals[old].reshape(-1, 9)
    words[:, MAIN_WORD] = [_main_faces(normals) for normals in tables.normals[old]]
    return words, rows, anchors


def _main_faces(normals: np.ndarray) -> int:
    """Return the main faces of six sides, four bits each; in float64, where 45 degrees tie."""
    word = 0
    for side in range(6):
        x, y, z = (1.0 if side % 2 else -1.0) * normals[side // 2]
        word |= int(dominant_face(x, y, z)) << (4 * side)
    return word


def _elements(tables: SceneTables, turns: np.ndarray, anchors: np.ndarray) -> np.ndarray:
    """Return E elements, uint32 [E, ELEMENT_WORDS]."""
    count = len(tables.boxes)
    glass = tables.translucent[np.maximum(tables.layers, 0)] & (tables.layers >= 0)
    faces = np.zeros((count, 6, FACE_WORDS), np.uint32)
    faces.view(np.int32)[..., 0] = np.where(glass, tables.layers | TRANSLUCENT, tables.layers)
    faces.view(np.float32)[..., TINT_WORD:UV_WORD] = tables.tints
    faces.view(np.float32)[..., UV_WORD:] = tables.uv.reshape(count, 6, 8)
    words = np.zeros((count, ELEMENT_WORDS), np.uint32)
    values, whole = words.view(np.float32), words.view(np.int32)
    values[:, :6] = tables.boxes
    whole[:, TURN_WORD] = turns
    whole[:, FLAGS_WORD] = tables.traits[:, FLAGS]
    whole[:, OWNER_WORD] = tables.traits[:, OWNER]
    values[:, EMISSION_WORD] = tables.emission
    whole[:, ANCHOR_WORD:FACES_WORD] = anchors
    words[:, FACES_WORD:] = faces.reshape(count, -1)
    return words
