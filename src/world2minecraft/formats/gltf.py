"""glTF export of volumes to binary ``.glb`` files with one mesh per object.

Meshes are in metres with y up, from the room's origin: room (x, y, z) becomes (x, z, -y). Each
object is a node such as ``toilet_3``, whose origin is the centre of its underside, with
``extras``: ``class`` (the id), ``class_name``, ``name``, ``nyu40`` (the id), ``instance`` and
``size_m`` along x, y and z. Colours are texels of one small
texture, which all viewers, engines and editors support. A second texture contains glowing colours.

A ``.glb`` file consists of a JSON chunk and a chunk of little-endian numbers. Each buffer view
starts at a multiple of four bytes. The blocks are stored in a separate buffer view named by the
root's ``extras``: a gzip-compressed NBT tree with the size, corner, ``block_to_room``, palette,
states, labels, block entities and entities. ``read_gltf`` restores the volume with its labels from
a file that no editor has changed.
"""

import io
import json
import struct
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
from PIL import Image

from world2minecraft import __version__
from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.core.errors import (
    MALFORMED,
    DamagedFileError,
    InputError,
    LimitError,
    UsageError,
)
from world2minecraft.core.files import read_bytes, write_bytes
from world2minecraft.core.types import BlockEntity, BlockVolume, Entity
from world2minecraft.core.vocabulary import nyu40_of
from world2minecraft.formats.block_meshes import BlockMesh, Look, volume_meshes
from world2minecraft.minecraft.nbt import NbtLimits, pack_gzip, read_nbt, unpack, write_nbt

MAGIC, JSON_CHUNK, BIN_CHUNK = 0x46546C67, 0x4E4F534A, 0x004E4942
MAX_BYTES = 192 << 20
MAX_JSON_BYTES = 8 << 20  # A thousand objects take one; JSON grows thirtyfold in memory.
VERTICES, INDICES = 34962, 34963  # Which buffer of a graphics card a view is for.
_COMPONENTS = {np.dtype("<f4"): 5126, np.dtype("<u4"): 5125, np.dtype("<u2"): 5123}
_KINDS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
_HEAD, _CHUNK = struct.Struct("<III"), struct.Struct("<II")
MAX_CELLS = 32 << 20  # 320 blocks a side; with its labels such a volume takes 160 MB.
LIMITS = NbtLimits(bytes=6 * MAX_CELLS)
_ARRAYS = (("states", np.uint16), ("semantic", np.uint8), ("instance", np.uint16))
EXTRAS_KEY = "world2minecraft"
TRIANGLES = np.array([0, 1, 2, 0, 2, 3])
NEAREST, CLAMP = 9728, 33071  # A texel keeps its own colour at any distance.
OPAQUE, CLEAR = 0, 1  # The two materials.


class GlbWriter:
    """A writer that collects arrays and JSON rows of a glTF file."""

    def __init__(self, generator: str) -> None:
        self.tree: dict[str, Any] = {"asset": {"version": "2.0", "generator": generator}}
        self._numbers = bytearray()

    def add(self, kind: str, row: dict[str, Any]) -> int:
        """Append a row to a list of the tree, such as ``meshes``, and return its index."""
        self.tree.setdefault(kind, []).append(row)
        return len(self.tree[kind]) - 1

    def view(self, data: bytes, target: int | None = None) -> int:
        """Append bytes and return the index of their buffer view."""
        self._numbers += bytes(-len(self._numbers) % 4)
        row: dict[str, Any] = {"buffer": 0, "byteOffset": len(self._numbers)}
        row["byteLength"] = len(data)
        if target is not None:
            row["target"] = target
        self._numbers += data
        return self.add("bufferViews", row)

    def accessor(self, values: np.ndarray, use: Literal["vertices", "indices"]) -> int:
        """Append an array [N] or [N, 2 to 4] of float32, uint32 or uint16, and return its accessor.

        Bounds are written for vertices with three components, as required for positions.
        """
        target = VERTICES if use == "vertices" else INDICES
        packed = np.ascontiguousarray(values).astype(values.dtype.newbyteorder("<"))
        row: dict[str, Any] = {
            "bufferView": self.view(packed.tobytes(), target),
            "componentType": _COMPONENTS[packed.dtype],
            "count": len(values),
            "type": _KINDS[1 if values.ndim == 1 else values.shape[1]],
        }
        if use == "vertices" and row["type"] == "VEC3":
            row["min"] = values.min(axis=0).tolist()
            row["max"] = values.max(axis=0).tolist()
        return self.add("accessors", row)

    def to_bytes(self) -> bytes:
        """Return the whole file. Equal trees give identical bytes."""
        numbers = bytes(self._numbers) + bytes(-len(self._numbers) % 4)
        tree = dict(self.tree)
        if numbers:
            tree["buffers"] = [{"byteLength": len(numbers)}]
        text = json.dumps(tree, separators=(",", ":"), sort_keys=True, allow_nan=False).encode()
        text += b" " * (-len(text) % 4)
        chunks = _CHUNK.pack(len(text), JSON_CHUNK) + text
        if numbers:
            chunks += _CHUNK.pack(len(numbers), BIN_CHUNK) + numbers
        return _HEAD.pack(MAGIC, 2, _HEAD.size + len(chunks)) + chunks


def read_glb(path: str | Path) -> tuple[dict[str, Any], memoryview]:
    """Read a binary glTF file.

    Returns:
        The tree of the JSON chunk, and the bytes of the binary chunk (empty if there is none).

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If the file is not a valid binary glTF 2.0 file.
        LimitError: If the file is too large.
    """
    data = read_bytes(path, MAX_BYTES)
    if len(data) < _HEAD.size + _CHUNK.size or _HEAD.unpack_from(data)[:2] != (MAGIC, 2):
        raise DamagedFileError(path, "is not a valid binary glTF 2.0 file")
    chunks: dict[int, memoryview] = {}
    at, end = _HEAD.size, min(len(data), _HEAD.unpack_from(data)[2])
    while at + _CHUNK.size <= end:
        size, kind = _CHUNK.unpack_from(data, at)
        at += _CHUNK.size
        if size > end - at:
            raise DamagedFileError(path, f"declares a chunk of {size:,} bytes but contains fewer")
        chunks.setdefault(kind, memoryview(data)[at : at + size])
        at += size
    nothing = memoryview(b"")
    return _tree_of(chunks.get(JSON_CHUNK, nothing), path), chunks.get(BIN_CHUNK, nothing)


def view_bytes(tree: dict[str, Any], numbers: memoryview, index: Any, path: str | Path) -> bytes:
    """Return the bytes of a buffer view.

    Raises:
        DamagedFileError: If the buffer view does not exist or extends beyond the binary chunk.
    """
    try:
        view = tree["bufferViews"][int(index)]
        start, size = int(view.get("byteOffset", 0)), int(view["byteLength"])
        if int(index) < 0 or int(view["buffer"]) != 0:
            raise ValueError("the buffer view is in another file")
    except MALFORMED as error:
        raise DamagedFileError(path, f"does not contain buffer view {str(index)[:20]}") from error
    if start < 0 or size < 0 or start + size > len(numbers):
        raise DamagedFileError(path, f"buffer view {index} extends beyond the binary chunk")
    return bytes(numbers[start : start + size])


def _tree_of(text: memoryview, path: str | Path) -> dict[str, Any]:
    if len(text) > MAX_JSON_BYTES:
        raise LimitError(path, f"has {len(text):,} bytes of JSON; the limit is {MAX_JSON_BYTES:,}")
    try:
        tree = json.loads(bytes(text))
    except (ValueError, RecursionError) as error:
        raise DamagedFileError(path, f"the JSON chunk is not valid JSON ({error})") from error
    if not isinstance(tree, dict):
        raise DamagedFileError(path, "the JSON chunk is not an object")
    return tree


def pack_volume(volume: BlockVolume) -> bytes:
    """Return a volume as bytes. Equal volumes give identical bytes.

    Raises:
        UsageError: If the volume is too large to be read back.
    """
    if volume.states.size > MAX_CELLS:
        raise UsageError(
            f"a .glb file can store at most {MAX_CELLS:,} blocks, got {volume.states.size:,}"
        )
    tree: dict[str, Any] = {
        "format": 1,
        "size": np.array(volume.states.shape, np.int32),
        "corner": np.array(volume.corner, np.int32),
        "block_to_room": volume.block_to_room.ravel().tolist(),
        "palette": list(volume.palette),
        "block_entities": [
            {"pos": np.array(e.block_pos, np.int32), "id": e.id, "nbt": dict(e.nbt)}
            for e in volume.block_entities
        ],
        "entities": [
            {
                "pos": [float(value) for value in e.position],
                "id": e.id,
                "nbt": dict(e.nbt),
                "class": e.class_id,
                "instance": e.instance,
            }
            for e in volume.entities
        ],
    }
    for name, kind in _ARRAYS:
        values = np.ascontiguousarray(getattr(volume, name)).astype(
            np.dtype(kind).newbyteorder("<")
        )
        tree[name] = np.frombuffer(values.tobytes(), np.int8)
    return pack_gzip(write_nbt(tree))


def unpack_volume(data: bytes, path: str | Path) -> BlockVolume:
    """Parse a volume written by ``pack_volume``.

    Raises:
        DamagedFileError: If the bytes are not a valid volume.
        LimitError: If the volume is too large.
    """
    _, tree = read_nbt(unpack(data, path, LIMITS.bytes), path, LIMITS)
    try:
        if tree["format"] != 1:
            raise ValueError(f"block format must be 1, got {tree['format']}")
        x, y, z = (int(side) for side in tree["size"])
        if min(x, y, z) < 0 or x * y * z > MAX_CELLS:
            raise LimitError(path, f"declares {x} x {y} x {z} blocks; the limit is {MAX_CELLS:,}")
        east, up, south = (int(value) for value in tree["corner"])
        return BlockVolume(
            **{name: _array(tree[name], kind, (x, y, z)) for name, kind in _ARRAYS},
            palette=tuple(str(state) for state in tree["palette"]),
            corner=(east, up, south),
            block_to_room=np.array(tree["block_to_room"], np.float64).reshape(4, 4),
            block_entities=tuple(map(_block_entity, tree["block_entities"])),
            entities=tuple(map(_entity, tree["entities"])),
        )
    except MALFORMED as error:
        raise DamagedFileError(path, f"does not contain a valid block volume ({error})") from error


def _array(raw: np.ndarray, kind: type, shape: tuple[int, int, int]) -> np.ndarray:
    return raw.view(np.dtype(kind).newbyteorder("<")).reshape(shape).astype(kind, copy=False)


def _block_entity(row: dict[str, Any]) -> BlockEntity:
    x, y, z = (int(value) for value in row["pos"])
    return BlockEntity((x, y, z), str(row["id"]), dict(row["nbt"]))


def _entity(row: dict[str, Any]) -> Entity:
    x, y, z = (float(value) for value in row["pos"])
    return Entity(
        (x, y, z), str(row["id"]), dict(row["nbt"]), int(row["class"]), int(row["instance"])
    )


def write_gltf(
    volume: BlockVolume,
    path: str | Path,
    *,
    templates: Mapping[int, str] | None = None,
    names: Mapping[int, str] | None = None,
    keep_blocks: bool = True,
) -> None:
    """Write a volume as a ``.glb`` file.

    Args:
        volume: Blocks to write. If they have labels, each object becomes a mesh.
        path: Output file.
        templates: Furniture template of each object by id, which is written to the extras.
        names: Name of each object by id, such as ``office chair``. Others have that of their class.
        keep_blocks: Whether to store the blocks in the file so that it can be read again.

    Raises:
        UsageError: If the volume contains no visible blocks.
        OutputError: If the file cannot be written.
    """
    details = {"templates": templates, "names": names}
    write_bytes(path, gltf_bytes(volume, **details, keep_blocks=keep_blocks))


def gltf_bytes(
    volume: BlockVolume,
    *,
    templates: Mapping[int, str] | None = None,
    names: Mapping[int, str] | None = None,
    keep_blocks: bool = True,
) -> bytes:
    """Return the contents of the file that ``write_gltf`` writes.

    Raises:
        UsageError: If the volume contains no visible blocks.
    """
    meshes, looks = volume_meshes(volume, names)
    if not meshes:
        raise UsageError("the volume contains no visible blocks, which glTF requires for a mesh")
    writer = GlbWriter(f"World2Minecraft {__version__}")
    _put_materials(writer, looks)
    side = texture_side(len(looks))
    nodes = [
        writer.add("nodes", _node(writer, mesh, looks, side, (templates or {}).get(mesh.instance)))
        for mesh in meshes
    ]
    add_default_scene(writer, nodes)
    extras: dict[str, Any] = {"metres_per_block": 1 / volume.blocks_per_metre}
    if keep_blocks:
        extras["blocks"] = writer.view(pack_volume(volume))
    writer.tree["extras"] = {EXTRAS_KEY: extras}
    return writer.to_bytes()


def read_gltf(path: str | Path) -> BlockVolume:
    """Read a volume that was stored by ``write_gltf``.

    Raises:
        InputError: If the file does not exist or contains no blocks.
        DamagedFileError: If the file is not a valid ``.glb`` file.
        LimitError: If the file is too large.
    """
    tree, numbers = read_glb(path)
    held = tree.get("extras")
    ours = held.get(EXTRAS_KEY) if isinstance(held, dict) else None
    if not isinstance(ours, dict) or "blocks" not in ours:
        reason = "contains no blocks; only .glb files written by this program can be read"
        raise InputError(path, reason)
    return unpack_volume(view_bytes(tree, numbers, ours["blocks"], path), path)


def body_extras(mesh: BlockMesh, template: str | None = None) -> dict[str, Any]:
    """Return the properties of a mesh, which become the ``extras`` of its node."""
    low, high = mesh.bounds
    extras: dict[str, Any] = {
        "class": mesh.class_id,
        "class_name": CLASS_NAMES[mesh.class_id] if mesh.class_id else "unknown",
        "name": mesh.title,
        "instance": mesh.instance,
        "size_m": np.round(high - low, 6).tolist(),
    }
    if mesh.class_id:
        extras["nyu40"] = nyu40_of(mesh.object_name, mesh.class_id)
    return extras | ({"template": template} if template else {})


def base_center(mesh: BlockMesh) -> np.ndarray:
    """Return the centre of a mesh's underside, the origin of its node, float64 [3]."""
    low, high = mesh.bounds
    return np.round([(low[0] + high[0]) / 2, low[1], (low[2] + high[2]) / 2], 6)


def add_default_scene(writer: GlbWriter, nodes: Sequence[int]) -> None:
    """Add a scene with the given nodes, and make it the default scene."""
    writer.add("scenes", {"name": "room", "nodes": list(nodes)})
    writer.tree["scene"] = 0


def add_vertices(writer: GlbWriter, mesh: BlockMesh, rows: np.ndarray) -> dict[str, int]:
    """Add positions, relative to the mesh's base, and normals of faces.

    Returns the accessors by attribute name.
    """
    positions = (mesh.corners[rows].reshape(-1, 3) - base_center(mesh)).astype(np.float32)
    normals = np.repeat(mesh.normals[rows], 4, axis=0).astype(np.float32)
    return {
        "POSITION": writer.accessor(positions, "vertices"),
        "NORMAL": writer.accessor(normals + np.float32(0), "vertices"),
    }


def add_triangles(writer: GlbWriter, count: int) -> int:
    """Add the triangles of ``count`` rectangles and return their accessor."""
    corners = np.arange(count)[:, None] * 4 + TRIANGLES
    dtype = np.uint16 if count * 4 < 0xFFFF else np.uint32
    return writer.accessor(corners.ravel().astype(dtype), "indices")


def texture_side(count: int) -> int:
    """Return the side, a power of two, of the smallest square texture for a number of colours.

    Example:
        >>> texture_side(26)
        8
    """
    return 1 << max(0, int(np.ceil(np.log2(max(count, 1)) / 2)))


def _node(
    writer: GlbWriter, mesh: BlockMesh, looks: Sequence[Look], side: int, template: str | None
) -> dict[str, Any]:
    is_clear = np.array([look.is_clear for look in looks])[mesh.looks]
    primitives = [
        _primitive(writer, mesh, np.flatnonzero(is_clear == (material == CLEAR)), side, material)
        for material in (OPAQUE, CLEAR)
        if (is_clear == (material == CLEAR)).any()
    ]
    return {
        "name": mesh.name,
        "mesh": writer.add("meshes", {"name": mesh.name, "primitives": primitives}),
        "translation": base_center(mesh).tolist(),
        "extras": body_extras(mesh, template),
    }


def _primitive(
    writer: GlbWriter, mesh: BlockMesh, rows: np.ndarray, side: int, material: int
) -> dict[str, Any]:
    row, column = np.divmod(np.repeat(mesh.looks[rows], 4), side)
    texels = ((np.column_stack([column, row]) + 0.5) / side).astype(np.float32)
    attributes = add_vertices(writer, mesh, rows)
    attributes["TEXCOORD_0"] = writer.accessor(texels, "vertices")
    return {
        "attributes": attributes,
        "indices": add_triangles(writer, len(rows)),
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
