"""Conversion of a sample to the members of a shard, and back.

The members are ``KEY.jpg`` (or png, webp), ``KEY.depth.png``, ``KEY.occ.npz`` and finally
``KEY.json``, which contains the checksums of the others. A sample is complete if its JSON exists
and the checksums match. Samples with labels only do not have the first two members.

Depth is stored as a 16-bit grey PNG in whole millimetres, with 0 for no depth and 65535 for larger
depths. It is compressed here instead of by Pillow, which tries five filters for each row and takes
four times as long.
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
QUALITY = 95  # Of JPEG and WebP, without visible loss at the edges of blocks.
_UP = 2  # The PNG filter that stores the difference to the row above, which is small for planes.
_GREY = 0
FORMAT = 1
DEPTH, LABELS, FACTS = "depth.png", "occ.npz", "json"
WHOLE_ARRAYS = ("labels", "fine", "instance", "hits")
BIT_ARRAYS = ("in_frustum", "free")  # Eight cells a byte; np.unpackbits(..., count=cells).
MAX_CELLS = 16 << 20
MAX_FACTS_BYTES = 1 << 20
CAMERA_KEYS = ("width_px", "height_px", "fx_px", "fy_px", "cx_px", "cy_px")


def encode_colour(colour: np.ndarray, kind: str, quality: int = QUALITY) -> bytes:
    """Encode a colour image, uint8 [H, W, 3], in one of ``IMAGE_FORMATS``."""
    return colour_bytes(colour, f".{kind}", quality)


def encode_depth(depth_m: np.ndarray) -> bytes:
    """Encode a depth map in metres, float32 [H, W], as a 16-bit PNG with fast compression."""
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
    """Decode a colour image to uint8 [H, W, 3].

    Args:
        data: Content of the image file.
        camera: Camera of the image, which defines the expected size.
        source: Name for error messages.

    Raises:
        DamagedFileError: If the data is not an image of this size.
    """
    return np.array(_open_image(data, camera, source, ("JPEG", "PNG", "WEBP")).convert("RGB"))


def decode_depth(data: bytes, camera: Camera, source: str | Path) -> np.ndarray:
    """Decode a PNG written by ``encode_depth`` to depth in metres, float32 [H, W].

    Args:
        data: Content of the PNG file.
        camera: Camera of the image, which defines the expected size.
        source: Name for error messages.

    Raises:
        DamagedFileError: If the data is not a depth PNG of this size.
    """
    numbers = np.asarray(_open_image(data, camera, source, ("PNG",)))
    if numbers.ndim != 2:
        raise DamagedFileError(source, "the depth image must be a grey PNG")
    return numbers.astype(np.float32) / np.float32(PER_METRE)


def _open_image(
    data: bytes, camera: Camera, source: str | Path, formats: tuple[str, ...]
) -> Image.Image:
    """Decode an image, checking its size before its pixels are decoded."""
    size = (camera.width_px, camera.height_px)
    try:
        image = Image.open(io.BytesIO(data), formats=formats)
        if image.size != size:
            actual = "x".join(map(str, image.size))
            raise DamagedFileError(
                source, f"an image has {actual} pixels, expected {size[0]}x{size[1]}"
            )
        image.load()
    except (OSError, ValueError, SyntaxError, struct.error, Image.DecompressionBombError) as error:
        raise DamagedFileError(source, f"an image cannot be read ({error})") from error
    return image


def _chunk(kind: bytes, data: bytes) -> bytes:
    checksum = zlib.crc32(data, zlib.crc32(kind))
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", checksum)


@dataclass(frozen=True)
class SampleFiles:
    """The file formats of a sample.

    Attributes:
        image_format: ``jpg``, ``png`` or ``webp``.
        quality: JPEG and WebP quality from 1 to 100.
    """

    image_format: str = "jpg"
    quality: int = QUALITY

    def __post_init__(self):
        if self.image_format not in IMAGE_FORMATS:
            raise UsageError(
                f"image format must be one of {', '.join(IMAGE_FORMATS)}, got {self.image_format!r}"
            )
        if not 1 <= self.quality <= 100:
            raise UsageError(f"quality must be from 1 to 100, got {self.quality}")


@dataclass(frozen=True, eq=False)
class FineTable:
    """The numbered fine classes of a complete data set."""

    classes: tuple[FineClass, ...]
    _numbers: dict[FineClass, int] = field(init=False, repr=False)

    def __post_init__(self):
        object.__setattr__(self, "classes", tuple(self.classes))
        object.__setattr__(self, "_numbers", {one: n for n, one in enumerate(self.classes)})

    def numbers_of(self, classes: tuple[FineClass, ...]) -> np.ndarray:
        """Return the numbers in this table for the fine classes of a scene, uint16 [N].

        Raises:
            KeyError: If the table does not contain one of the classes.
        """
        return np.array([self._numbers[one] for one in classes], np.uint16)


def pack_sample(sample: OccSample, table: FineTable, files: SampleFiles) -> dict[str, bytes]:
    """Encode a sample as the ordered members of a shard, by kind.

    Args:
        sample: Sample to encode. The table must contain its fine classes.
        table: Fine classes of the data set, to which ``fine`` is converted.
        files: File formats to use.
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
    """Return the JSON content for a sample, without checksums."""
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
    """Decode a sample from its shard members. Missing images become None.

    Args:
        members: Content of each member by kind, including ``json`` and ``occ.npz``.
        table: Fine classes of the data set.
        source: Name for error messages.
        facts: Content of the JSON, if already parsed.

    Raises:
        DamagedFileError: If a member is not valid.
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
        raise DamagedFileError(source, f"not a valid sample ({error!r})") from error


def read_facts(data: bytes, source: str | Path) -> dict[str, Any]:
    """Parse the JSON of a sample.

    Raises:
        DamagedFileError: If the JSON is not valid.
    """
    try:
        facts = json.loads(data) if len(data) <= MAX_FACTS_BYTES else None
    except (ValueError, RecursionError) as error:
        raise DamagedFileError(source, f"not valid JSON ({error})") from error
    if not isinstance(facts, dict) or facts.get("format") != FORMAT:
        raise DamagedFileError(source, f"not the JSON of a sample in format {FORMAT}")
    return facts


def _unpack_labels(data: bytes, meta: Any, fine_count: int, source: str | Path) -> OccLabels:
    shape = tuple(int(side) for side in meta["shape"])
    cells = int(np.prod(np.array(shape, np.float64)))
    if not 0 < cells <= MAX_CELLS:
        raise ValueError(f"a region must have from 1 to {MAX_CELLS:,} cells, got shape {shape}")
    to_room = np.array(meta["region_to_room"], np.float64)
    region = LabelRegion((shape[0], shape[1], shape[2]), meta["voxel_m"], to_room, meta["kind"])
    limit = 4 * cells + 1024
    arrays = read_npz_bytes(data, (*WHOLE_ARRAYS, *BIT_ARRAYS), source, limit)
    for name in BIT_ARRAYS:
        bits = arrays[name]
        if bits.dtype != np.uint8 or bits.shape != (-(-cells // 8),):
            raise ValueError(
                f"{name} must contain the packed bits of {cells} cells, got {bits.dtype} "
                f"{bits.shape}"
            )
        arrays[name] = np.unpackbits(bits, count=cells).astype(bool).reshape(shape)
    if arrays["fine"].size and int(arrays["fine"].max()) >= fine_count:
        raise ValueError(
            f"fine must contain indices below {fine_count}, got {arrays['fine'].max()}"
        )
    return OccLabels(region, **arrays)


def _count_cells(occ: OccLabels) -> dict[str, int]:
    """Return the number of cells of each kind; see ``OccLabels``."""
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
