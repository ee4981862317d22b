"""Meshes as packets of arrays, which pages draw.

A packet: ``magic`` (4 bytes), u32 length of the header, the header in UTF-8 padded with spaces,
then the arrays, little-endian and in C order, each at a multiple of 8 bytes after the header. The
header is JSON. Its ``arrays`` is ``{name: {"dtype": "f4", "shape": [...], "offset": bytes after the
header}}``.
"""

import json
import struct
from collections.abc import Mapping
from typing import Any

import numpy as np

from world2minecraft.rendering.mesh.baking import BlockMesh

_ALIGN = 8
COMPACT_UNIT = 4096  # Steps a block, or a texture, of the numbers in compact arrays.


def pack_arrays(magic: bytes, facts: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> bytes:
    """Return a packet with arrays and additional header fields as bytes."""
    rows, parts, offset = {}, [], 0
    for name, values in arrays.items():
        kind = values.dtype.newbyteorder("<")
        data = np.ascontiguousarray(values, kind).tobytes()
        rows[name] = {"dtype": kind.str[1:], "shape": list(values.shape), "offset": offset}
        parts += [data, bytes(-len(data) % _ALIGN)]
        offset += len(data) + len(parts[-1])
    text = json.dumps({**facts, "arrays": rows}, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-(len(text) + len(magic) + 4) % _ALIGN)
    return b"".join([magic, struct.pack("<I", len(text)), text, *parts])


def mesh_arrays(mesh: BlockMesh) -> dict[str, np.ndarray]:
    """Return the mesh arrays with a row per corner, and the click data with a row per quad."""
    emission = np.repeat(mesh.emission[:, None], 4, axis=1)[..., None]
    colour = np.concatenate([mesh.tint, mesh.shade[:, None]], axis=1)
    facts = mesh.semantic + mesh.cuts * np.uint16(256)
    kind = np.stack([mesh.layer, facts, mesh.cover, np.zeros_like(facts)], axis=1)
    return {
        "position": mesh.position.reshape(-1, 3),
        "uv": mesh.uv.reshape(-1, 2),
        "light": np.concatenate([mesh.light, emission], axis=2).reshape(-1, 4),
        "colour": np.repeat(colour, 4, axis=0),
        "kind": np.repeat(kind, 4, axis=0),
        "state": mesh.state,
        "instance": mesh.instance,
        "texels": filled_texels(mesh),
    }


def filled_texels(mesh: BlockMesh) -> np.ndarray:
    """Return the finest level of each texture with transparent texels coloured.

    The result is uint8 [L, N, N, 4]. Graphics cards average textures that are drawn small.
    Transparent texels get the mean colour of their texture, so that leaves and glass panes do not
    get dark or pink edges.
    """
    side = mesh.atlas.side_px
    texels = mesh.atlas.texels[:, : side * side].copy()
    for texture in texels:
        solid = texture[:, 3] >= 128
        if solid.any() and not solid.all():
            texture[~solid & (texture[:, 3] == 0), :3] = texture[solid, :3].mean(axis=0)
    return texels.reshape(-1, side, side, 4)


def compact_mesh_arrays(mesh: BlockMesh) -> dict[str, np.ndarray]:
    """Return the mesh as arrays that compress well, with a column per quad.

    Quads are parallelograms, in space and on their texture, so three of their corners suffice.
    Positions and texture coordinates are rounded to ``COMPACT_UNIT``. ``web/src/build/compact.ts``
    restores the arrays of ``mesh_arrays`` from them.
    """
    return {
        "corners": _edges(mesh.position),
        "uvs": _edges(mesh.uv),
        "lights": np.concatenate(
            [mesh.light.reshape(len(mesh), 12).T, mesh.emission[None]]
        ),  # uint8 [13, Q]
        "colours": np.concatenate([mesh.tint.T, mesh.shade[None]]),  # uint8 [4, Q]
        "kinds_of_quads": np.stack(
            [mesh.layer, mesh.semantic + mesh.cuts * np.uint16(256), mesh.cover, mesh.instance]
        ),  # uint16 [4, Q]
        "texels": filled_texels(mesh),
    }


def _edges(corners: np.ndarray) -> np.ndarray:
    """Return the first corner and two edges of each quad as planes of bytes, uint8 [4, 3 K, Q].

    The planes are those of little-endian 32-bit numbers: most bytes of high planes are equal.

    Args:
        corners: float32 [Q, 4, K].
    """
    whole = np.rint(corners.astype(np.float64) * COMPACT_UNIT).astype("<i4")
    rows = np.concatenate([whole[:, 0], whole[:, 1] - whole[:, 0], whole[:, 3] - whole[:, 0]], 1)
    columns = np.ascontiguousarray(rows.T)
    return np.ascontiguousarray(
        np.moveaxis(columns.view(np.uint8).reshape(*columns.shape, 4), 2, 0)
    )
