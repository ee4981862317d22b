"""The output layers of an image, by the names used in commands and files.

A layer defines the renderer output that it requires and the file that it is written to.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.core.errors import UnknownNameError
from world2minecraft.core.types import BlockVolume
from world2minecraft.rendering.output.images import (
    PER_METRE,
    QUALITY,
    colour_bytes,
    depth_bytes,
    index_bytes,
    normal_bytes,
    number_bytes,
)
from world2minecraft.rendering.picture import Picture


@dataclass(frozen=True)
class FileFormats:
    """The file formats of layers: suffixes, quality and the scale of 16-bit depth."""

    colour_suffix: str = ".png"
    depth_suffix: str = ".png"
    quality: int = QUALITY
    per_metre: int = PER_METRE


@dataclass(frozen=True)
class Layer:
    """An output layer: its renderer output, its file and its contents."""

    title: str
    needs: str | None
    make: Callable[[Picture, BlockVolume, FileFormats], bytes]
    suffix: Callable[[FileFormats], str]


def _state(picture: Picture, volume: BlockVolume, choice: FileFormats) -> bytes:
    index = picture.block_index
    rows = volume.states.reshape(-1)[np.maximum(index, 0)]
    return number_bytes(np.where(index >= 0, rows, 0).astype(np.uint16))


def _png(choice: FileFormats) -> str:
    return ".png"


LAYERS: dict[str, Layer] = {
    "rgb": Layer(
        "colour",
        "colour",
        lambda picture, _, choice: colour_bytes(
            _there(picture.colour), choice.colour_suffix, choice.quality
        ),
        lambda choice: choice.colour_suffix,
    ),
    "depth": Layer(
        "distance along the camera's z axis",
        "depth",
        lambda picture, _, choice: depth_bytes(
            picture.depth_m, choice.depth_suffix, choice.per_metre
        ),
        lambda choice: choice.depth_suffix,
    ),
    "range": Layer(
        "distance along the ray",
        "depth",
        lambda picture, _, choice: depth_bytes(
            picture.range_m, choice.depth_suffix, choice.per_metre
        ),
        lambda choice: choice.depth_suffix,
    ),
    "block": Layer(
        "index of the block in the volume, RGBA",
        None,
        lambda picture, *_: index_bytes(picture.block_index),
        _png,
    ),
    "state": Layer("index of the block state, 16 bits", None, _state, _png),
    "class": Layer(
        "semantic class, 8 bits",
        "semantic",
        lambda picture, *_: number_bytes(_there(picture.semantic)),
        _png,
    ),
    "instance": Layer(
        "object id, 16 bits",
        "instance",
        lambda picture, *_: number_bytes(_there(picture.instance)),
        _png,
    ),
    "face": Layer(
        "side of the block (0 to 5 for -x +x -y +y -z +z, 255 for none)",
        None,
        lambda picture, *_: number_bytes(picture.face),
        _png,
    ),
    "normal": Layer(
        "surface normal in block axes (red x, green y, blue z; 128 is zero)",
        "normal",
        lambda picture, *_: normal_bytes(_there(picture.normal)),
        _png,
    ),
    "opaque": Layer(
        "index of the first block behind glass, RGBA",
        "opaque",
        lambda picture, *_: index_bytes(_there(picture.opaque_index)),
        _png,
    ),
    "opaque_depth": Layer(
        "depth of the first surface behind glass",
        "opaque",
        lambda picture, _, choice: depth_bytes(
            _there(picture.opaque_depth_m), choice.depth_suffix, choice.per_metre
        ),
        lambda choice: choice.depth_suffix,
    ),
}
GROUPS = {"id": ("state", "class", "instance"), "all": tuple(LAYERS)}


def parse_layers(text: str) -> tuple[str, ...]:
    """Return the layers named in a list such as ``rgb,depth,id``, in order and without repeats.

    Raises:
        UnknownNameError: If a layer is unknown.
    """
    names: list[str] = []
    for word in [part.strip().lower() for part in text.split(",") if part.strip()]:
        if word not in LAYERS and word not in GROUPS:
            raise UnknownNameError("output", word, [*LAYERS, *GROUPS])
        names += [name for name in GROUPS.get(word, (word,)) if name not in names]
    if not names:
        raise UnknownNameError("output", text, [*LAYERS, *GROUPS])
    return tuple(names)


def required_outputs(names: Iterable[str]) -> tuple[str, ...]:
    """Return the renderer outputs that layers require."""
    return tuple(sorted({need for name in names if (need := LAYERS[name].needs)}))


def file_name(stem: str, name: str, choice: FileFormats) -> str:
    """Return the file name of a layer: ``STEM.png`` for colour, ``STEM.depth.png`` for depth."""
    suffix = LAYERS[name].suffix(choice)
    return f"{stem}{suffix}" if name == "rgb" else f"{stem}.{name}{suffix}"


def id_names(volume: BlockVolume) -> dict[str, Any]:
    """Return the meaning of the numbers in id layers, as written to ``names.json``."""
    return {
        "state": {str(n): state for n, state in enumerate(volume.palette)},
        "class": {str(n): name for n, name in enumerate(CLASS_NAMES)},
        "face": {str(n): name for n, name in enumerate(("-x", "+x", "-y", "+y", "-z", "+z"))},
        "block": {
            "corner": list(volume.corner),
            "size": list(volume.states.shape),
            "packing": "red + 256 green + 65536 blue + 16777216 alpha - 1; -1 for none",
            "order": "number = (x * size_y + y) * size_z + z, relative to the corner",
        },
        "block_to_room": volume.block_to_room.tolist(),
    }


def _there(values: np.ndarray | None) -> np.ndarray:
    if values is None:
        raise ValueError(
            "the image does not contain a requested layer; render it with required_outputs(layers)"
        )
    return values
