"""glTF: a volume as a binary ``.glb`` with one mesh for each object.

Metres, y up, from the room's origin: room (x, y, z) stands at (x, z, -y). Each object is a node
with its middle below as origin, and ``extras``: ``class`` (the id), ``class_name``, ``instance``
and ``size_m`` along x, y and z. Colours are texels of one small texture, so that every viewer,
engine and editor shows them; a second texture holds what glows.

The blocks themselves lie in a buffer view of their own, named by the root's ``extras``: from a
file that no editor has written since, ``read_gltf`` gives the volume back, labels and all.
"""

import io
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from world2minecraft import __version__
from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.core.files import write_bytes
from world2minecraft.core.types import BlockVolume
from world2minecraft.formats.blob import pack_volume, unpack_volume
from world2minecraft.formats.bodies import Body, Look, bodies_of
from world2minecraft.formats.glb import GlbWriter, read_glb, view_bytes

EXTRAS_KEY = "world2minecraft"
TRIANGLES = np.array([0, 1, 2, 0, 2, 3])
NEAREST, CLAMP = 9728, 33071  # A texel keeps its own colour at any distance.
OPAQUE, CLEAR = 0, 1  # The two materials.


def write_gltf(
    volume: BlockVolume,
    path: str | Path,
    *,
    templates: Mapping[int, str] | None = None,
    keep_blocks: bool = True,
) -> None:
    """Write a volume as ``.glb``.

    Args:
        volume: the blocks; labels, where it has some, part them into objects.
        path: the file.
        templates: the template of each object by its number; it goes into the extras.
        keep_blocks: whether the blocks go into the file too, so that it can be read again.

    Raises:
        UsageError: nothing of the volume can be seen. OutputError: it cannot be written.
    """
    write_bytes(path, gltf_bytes(volume, templates=templates, keep_blocks=keep_blocks))


def gltf_bytes(
    volume: BlockVolume,
    *,
    templates: Mapping[int, str] | None = None,
    keep_blocks: bool = True,
) -> bytes:
    """Return the bytes of ``write_gltf``. Raises what it raises."""
    bodies, looks = bodies_of(volume)
    if not bodies:
        raise UsageError("the volume holds no block that can be seen; glTF needs a mesh")
    writer = GlbWriter(f"World2Minecraft {__version__}")
    _put_materials(writer, looks)
    side = texture_side(len(looks))
    nodes = [
        writer.add("nodes", _node(writer, body, looks, side, (templates or {}).get(body.instance)))
        for body in bodies
    ]
    finish(writer, nodes)
    extras: dict[str, Any] = {"metres_per_block": 1 / volume.blocks_per_metre}
    if keep_blocks:
        extras["blocks"] = writer.view(pack_volume(volume))
    writer.tree["extras"] = {EXTRAS_KEY: extras}
    return writer.to_bytes()


def read_gltf(path: str | Path) -> BlockVolume:
    """Read the volume that ``write_gltf`` put into a file.

    Raises:
        InputError: there is no file, or it holds no blocks. DamagedFileError: it is no ``.glb``.
        LimitError: it is too large.
    """
    tree, numbers = read_glb(path)
    held = tree.get("extras")
    ours = held.get(EXTRAS_KEY) if isinstance(held, dict) else None
    if not isinstance(ours, dict) or "blocks" not in ours:
        reason = "holds meshes and no blocks; only a .glb that this program wrote is read"
        raise InputError(path, reason)
    return unpack_volume(view_bytes(tree, numbers, ours["blocks"], path), path)


def body_extras(body: Body, template: str | None = None) -> dict[str, Any]:
    """Return what a body is: ``class``, ``class_name``, ``instance``, ``size_m``."""
    low, high = body.bounds
    extras: dict[str, Any] = {
        "class": body.class_id,
        "class_name": CLASS_NAMES[body.class_id] if body.class_id else "unknown",
        "instance": body.instance,
        "size_m": np.round(high - low, 6).tolist(),
    }
    return extras | ({"template": template} if template else {})


def foot_of(body: Body) -> np.ndarray:
    """Return the middle of a body's underside, float64 [3], where its node stands."""
    low, high = body.bounds
    return np.round([(low[0] + high[0]) / 2, low[1], (low[2] + high[2]) / 2], 6)


def finish(writer: GlbWriter, nodes: Sequence[int]) -> None:
    """Put nodes into the one scene, which is the file's default."""
    writer.add("scenes", {"name": "room", "nodes": list(nodes)})
    writer.tree["scene"] = 0


def vertices_of(writer: GlbWriter, body: Body, rows: np.ndarray) -> dict[str, int]:
    """Add positions and normals of some faces of a body, from its foot; return the attributes."""
    positions = (body.corners[rows].reshape(-1, 3) - foot_of(body)).astype(np.float32)
    normals = np.repeat(body.normals[rows], 4, axis=0).astype(np.float32)
    return {
        "POSITION": writer.accessor(positions, "vertices"),
        "NORMAL": writer.accessor(normals + np.float32(0), "vertices"),
    }


def triangles_of(writer: GlbWriter, count: int) -> int:
    """Add the triangles of ``count`` rectangles; return their accessor."""
    corners = np.arange(count)[:, None] * 4 + TRIANGLES
    dtype = np.uint16 if count * 4 < 0xFFFF else np.uint32
    return writer.accessor(corners.ravel().astype(dtype), "indices")


def texture_side(count: int) -> int:
    """Return the side, a power of two, of the square texture that holds so many colours.

    Example:
        >>> texture_side(26)
        8
    """
    return 1 << max(0, int(np.ceil(np.log2(max(count, 1)) / 2)))


def _node(
    writer: GlbWriter, body: Body, looks: Sequence[Look], side: int, template: str | None
) -> dict[str, Any]:
    is_clear = np.array([look.is_clear for look in looks])[body.looks]
    primitives = [
        _primitive(writer, body, np.flatnonzero(is_clear == (material == CLEAR)), side, material)
        for material in (OPAQUE, CLEAR)
        if (is_clear == (material == CLEAR)).any()
    ]
    return {
        "name": body.name,
        "mesh": writer.add("meshes", {"name": body.name, "primitives": primitives}),
        "translation": foot_of(body).tolist(),
        "extras": body_extras(body, template),
    }


def _primitive(
    writer: GlbWriter, body: Body, rows: np.ndarray, side: int, material: int
) -> dict[str, Any]:
    row, column = np.divmod(np.repeat(body.looks[rows], 4), side)
    texels = ((np.column_stack([column, row]) + 0.5) / side).astype(np.float32)
    attributes = vertices_of(writer, body, rows)
    attributes["TEXCOORD_0"] = writer.accessor(texels, "vertices")
    return {
        "attributes": attributes,
        "indices": triangles_of(writer, len(rows)),
        "material": material,
    }


def _put_materials(writer: GlbWriter, looks: Sequence[Look]) -> None:
    colours = np.zeros((texture_side(len(looks)) ** 2, 4), np.uint8)
    glows = np.zeros_like(colours)
    glows[:, 3] = colours[:, 3] = 255
    for number, look in enumerate(looks):
        colours[number] = (*look.rgb, look.alpha)
        glows[number, :3] = look.rgb if look.glows else 0
    writer.add(
        "samplers", {"magFilter": NEAREST, "minFilter": NEAREST, "wrapS": CLAMP, "wrapT": CLAMP}
    )
    for name, pixels in (("colours", colours), ("glow", glows)):
        image = {"name": name, "mimeType": "image/png", "bufferView": writer.view(_png(pixels))}
        writer.add("textures", {"sampler": 0, "source": writer.add("images", image)})
    has_glass = any(look.is_clear for look in looks)
    for name in ("blocks", "glass") if has_glass else ("blocks",):
        material: dict[str, Any] = {
            "name": name,
            "pbrMetallicRoughness": {
                "baseColorTexture": {"index": 0},
                "metallicFactor": 0,
                "roughnessFactor": 1,
            },
            "emissiveTexture": {"index": 1},
            "emissiveFactor": [1, 1, 1],
        }
        writer.add("materials", material | ({"alphaMode": "BLEND"} if name == "glass" else {}))


def _png(pixels: np.ndarray) -> bytes:
    side = int(np.sqrt(len(pixels)))
    stream = io.BytesIO()
    Image.fromarray(pixels.reshape(side, side, 4)).save(stream, "PNG")
    return stream.getvalue()
