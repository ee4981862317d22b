"""A sample as the members of a shard, and back.

``KEY.jpg`` (or png, webp), ``KEY.depth.png``, ``KEY.occ.npz`` and, last, ``KEY.json``, which holds
the checksums of the others: a sample is complete where its JSON is there and its checksums match.
Without images (labels only) the first two are left out.

Depth is a grey PNG of 16 bits in whole millimetres, 0 for no depth, 65535 for all that is farther.
It is compressed here and not by Pillow, which tries five filters on every row: a quarter of the
time.
"""

import hashlib
import io
import json
import struct
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from world2minecraft.core.classes import CLASS_COUNT
from world2minecraft.core.coordinates import carry_camera, invert
from world2minecraft.core.errors import DamagedFileError, UsageError
from world2minecraft.core.files import pack_npz, read_npz_bytes
from world2minecraft.core.types import Camera
from world2minecraft.minecraftocc.types import FineClass, LabelRegion, OccLabels, OccSample
from world2minecraft.rendering.output.images import PER_METRE, colour_bytes, depth_numbers

IMAGE_FORMATS = ("jpg", "png", "webp")
QUALITY = 95  # Of JPEG and WebP: the eye sees no loss, and edges of blocks stay sharp.
_UP = 2  # The filter of every row: the difference to the row above, for planes small and regular.
_GREY = 0
FORMAT = 1
DEPTH, LABELS, FACTS = "depth.png", "occ.npz", "json"
WHOLE_ARRAYS = ("labels", "fine", "instance", "hits")
BIT_ARRAYS = ("in_frustum", "free")  # Eight cells a byte; np.unpackbits(..., count=cells).
MAX_CELLS = 16 << 20
MAX_FACTS_BYTES = 1 << 20
CAMERA_KEYS = ("width_px", "height_px", "fx_px", "fy_px", "cx_px", "cy_px")


def encode_colour(colour: np.ndarray, kind: str, quality: int = QUALITY) -> bytes:
    """Return colour, uint8 [H, W, 3], as a file of a kind of ``IMAGE_FORMATS``."""
    return colour_bytes(colour, f".{kind}", quality)


def encode_depth(depth_m: np.ndarray) -> bytes:
    """Return depth, float32 [H, W] in metres, as a PNG of 16 bits at deflate level 1."""
    numbers = depth_numbers(depth_m, PER_METRE)
    height, width = numbers.shape
    rows = np.zeros((height, 1 + 2 * width), np.uint8)
    rows[:, 0] = _UP
    raw = numbers.astype(">u2").view(np.uint8)
    rows[0, 1:] = raw[0]
    np.subtract(raw[1:], raw[:-1], out=rows[1:, 1:])
    header = struct.pack(">IIBBBBB", width, height, 16, _GREY, 0, 0, 0)
    parts = ((b"IHDR", header), (b"IDAT", zlib.compress(rows.tobytes(), 1)), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(kind, data) for kind, data in parts)


def decode_colour(data: bytes, camera: Camera, source: str | Path) -> np.ndarray:
    """Return the colours, uint8 [H, W, 3], of a file that is as large as its camera says.

    Raises:
        DamagedFileError: it is no such picture.
    """
    return np.array(_open_image(data, camera, source, ("JPEG", "PNG", "WEBP")).convert("RGB"))


def decode_depth(data: bytes, camera: Camera, source: str | Path) -> np.ndarray:
    """Return the depth, float32 [H, W] in metres, of a PNG of ``encode_depth``. Raises as above."""
    numbers = np.asarray(_open_image(data, camera, source, ("PNG",)))
    if numbers.ndim != 2:
        raise DamagedFileError(source, "its depth is no grey picture")
    return numbers.astype(np.float32) / np.float32(PER_METRE)


def _open_image(
    data: bytes, camera: Camera, source: str | Path, formats: tuple[str, ...]
) -> Image.Image:
    """Decode a picture, its size compared before any memory is taken."""
    size = (camera.width_px, camera.height_px)
    try:
        image = Image.open(io.BytesIO(data), formats=formats)
        if image.size != size:
            actual = "x".join(map(str, image.size))
            raise DamagedFileError(source, f"a picture is {actual}, not {size[0]}x{size[1]}")
        image.load()
    except (OSError, ValueError, SyntaxError, struct.error, Image.DecompressionBombError) as error:
        raise DamagedFileError(source, f"a picture cannot be read ({error})") from error
    return image


def _chunk(kind: bytes, data: bytes) -> bytes:
    checksum = zlib.crc32(data, zlib.crc32(kind))
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", checksum)


@dataclass(frozen=True)
class SampleFiles:
    """How samples become files."""

    image_format: str = "jpg"
    quality: int = QUALITY

    def __post_init__(self):
        if self.image_format not in IMAGE_FORMATS:
            raise UsageError(f"pictures are {', '.join(IMAGE_FORMATS)}, not {self.image_format!r}")
        if not 1 <= self.quality <= 100:
            raise UsageError(f"a quality is 1 to 100, not {self.quality}")


@dataclass(frozen=True, eq=False)
class FineTable:
    """The fine classes of a whole data set, in the order of their numbers."""

    classes: tuple[FineClass, ...]
    _numbers: dict[FineClass, int] = field(init=False, repr=False)

    def __post_init__(self):
        object.__setattr__(self, "classes", tuple(self.classes))
        object.__setattr__(self, "_numbers", {one: n for n, one in enumerate(self.classes)})

    def numbers_of(self, classes: tuple[FineClass, ...]) -> np.ndarray:
        """Return the numbers here of the classes of a scene, uint16 [N]. Raises KeyError."""
        return np.array([self._numbers[one] for one in classes], np.uint16)


def pack_sample(sample: OccSample, table: FineTable, files: SampleFiles) -> dict[str, bytes]:
    """Return the members of a sample by their kinds, in their order.

    Args:
        sample: with any fine classes that the table holds.
        table: what ``fine`` counts in afterwards.
        files: how pictures are packed.
    """
    members: dict[str, bytes] = {}
    if sample.colour is not None:
        members[files.image_format] = encode_colour(
            sample.colour, files.image_format, files.quality
        )
    if sample.depth_m is not None:
        members[DEPTH] = encode_depth(sample.depth_m)
    occ = sample.occ
    arrays = {name: getattr(occ, name) for name in WHOLE_ARRAYS}
    if sample.fine_classes != table.classes:
        arrays["fine"] = table.numbers_of(sample.fine_classes)[occ.fine]
    arrays |= {name: np.packbits(getattr(occ, name)) for name in BIT_ARRAYS}
    members[LABELS] = pack_npz(arrays)
    sums = {kind: hashlib.sha256(data).hexdigest() for kind, data in members.items()}
    facts = {**sample_facts(sample), "sha256": sums}
    members[FACTS] = json.dumps(facts, sort_keys=True, allow_nan=False).encode() + b"\n"
    return members


def sample_facts(sample: OccSample) -> dict[str, Any]:
    """Return what the JSON of a sample tells, but for the sums."""
    occ, region = sample.occ, sample.occ.region
    facts = {
        "format": FORMAT,
        "key": sample.key,
        "scene_id": sample.scene_id,
        "tour_id": sample.tour_id,
        "frame": sample.frame,
        "split": sample.split,
        "camera": {name: getattr(sample.camera, name) for name in CAMERA_KEYS}
        | {"K": np.asarray(sample.camera.matrix, np.float64).tolist()},
        "camera_to_room": sample.camera_to_room.tolist(),
        "depth_per_metre": PER_METRE,
        "region": {
            "shape": list(region.shape),
            "voxel_m": region.voxel_m,
            "region_to_room": region.region_to_room.tolist(),
            "kind": region.kind,
        },
        "cells": _count_cells(occ),
        "cells_by_class": _count_classes(occ.labels),
        "visible_by_class": _count_classes(occ.labels[occ.visible]),
        **({"facts": sample.facts} if sample.facts else {}),
    }
    if "block_to_room" in sample.facts:
        room_to_block = invert(np.array(sample.facts["block_to_room"], np.float64))
        facts["camera_to_block"] = carry_camera(sample.camera_to_room, room_to_block).tolist()
    return facts


def unpack_sample(
    members: Mapping[str, bytes],
    table: FineTable,
    source: str | Path,
    facts: dict[str, Any] | None = None,
) -> OccSample:
    """Return the sample that members hold; pictures that are left out are None.

    Args:
        members: bytes by kind, ``json`` and ``occ.npz`` among them.
        table: the data set's fine classes.
        source: what errors name.
        facts: of the JSON, where it is parsed already.

    Raises:
        DamagedFileError: a member is not what it should be.
    """
    meta = read_facts(members[FACTS], source) if facts is None else facts
    try:
        camera = Camera(**{name: meta["camera"][name] for name in CAMERA_KEYS})
        occ = _unpack_labels(members[LABELS], meta["region"], len(table.classes), source)
        images = [members[kind] for kind in IMAGE_FORMATS if kind in members]
        return OccSample(
            key=str(meta["key"]),
            scene_id=str(meta["scene_id"]),
            tour_id=str(meta["tour_id"]),
            frame=int(meta["frame"]),
            camera=camera,
            camera_to_room=np.array(meta["camera_to_room"], np.float64),
            occ=occ,
            fine_classes=table.classes,
            colour=decode_colour(images[0], camera, source) if images else None,
            depth_m=decode_depth(members[DEPTH], camera, source) if DEPTH in members else None,
            split=str(meta["split"]),
            facts=dict(meta.get("facts", {})),
        )
    except (KeyError, TypeError, ValueError, OverflowError, AttributeError) as error:
        raise DamagedFileError(source, f"is no sample ({error!r})") from error


def read_facts(data: bytes, source: str | Path) -> dict[str, Any]:
    """Return what a sample's JSON tells. Raises DamagedFileError."""
    try:
        facts = json.loads(data) if len(data) <= MAX_FACTS_BYTES else None
    except (ValueError, RecursionError) as error:
        raise DamagedFileError(source, f"is not JSON ({error})") from error
    if not isinstance(facts, dict) or facts.get("format") != FORMAT:
        raise DamagedFileError(source, f"is no JSON of a sample of format {FORMAT}")
    return facts


def _unpack_labels(data: bytes, meta: Any, fine_count: int, source: str | Path) -> OccLabels:
    shape = tuple(int(side) for side in meta["shape"])
    cells = int(np.prod(np.array(shape, np.float64)))
    if not 0 < cells <= MAX_CELLS:
        raise ValueError(f"a region has 1 to {MAX_CELLS:,} cells, not {shape}")
    to_room = np.array(meta["region_to_room"], np.float64)
    region = LabelRegion((shape[0], shape[1], shape[2]), meta["voxel_m"], to_room, meta["kind"])
    limit = 4 * cells + 1024
    arrays = read_npz_bytes(data, (*WHOLE_ARRAYS, *BIT_ARRAYS), source, limit)
    for name in BIT_ARRAYS:
        bits = arrays[name]
        if bits.dtype != np.uint8 or bits.shape != (-(-cells // 8),):
            raise ValueError(f"{name} is {bits.dtype} {bits.shape}, not the bits of {cells} cells")
        arrays[name] = np.unpackbits(bits, count=cells).astype(bool).reshape(shape)
    if arrays["fine"].size and int(arrays["fine"].max()) >= fine_count:
        raise ValueError(f"fine goes to {arrays['fine'].max()} of {fine_count} classes")
    return OccLabels(region, **arrays)


def _count_cells(occ: OccLabels) -> dict[str, int]:
    """Return how many cells are what; see ``OccLabels``."""
    inside = occ.in_frustum
    occluded = inside & occ.occupied & ~occ.visible
    known = occ.occupied | occ.free | occ.visible
    masks = {
        "occupied": occ.occupied,
        "visible": occ.visible,
        "free": occ.free,
        "in_frustum": inside,
        "occluded": occluded,
        "unknown": inside & ~known,
    }
    return {name: int(np.count_nonzero(mask)) for name, mask in masks.items()} | {
        "hits": int(occ.hits.sum(dtype=np.int64)),
        "fine": len(np.unique(occ.fine)),
    }


def _count_classes(labels: np.ndarray) -> list[int]:
    return np.bincount(labels.reshape(-1), minlength=256)[:CLASS_COUNT].tolist()
