"""Image files: colour, depth, ids and animations."""

from world2minecraft.rendering.output.animation import ANIMATION_SUFFIXES, animation_writer
from world2minecraft.rendering.output.exr import exr_bytes
from world2minecraft.rendering.output.images import (
    colour_bytes,
    depth_bytes,
    index_bytes,
    number_bytes,
)
from world2minecraft.rendering.output.layers import (
    LAYERS,
    FileFormats,
    file_name,
    id_names,
    parse_layers,
    required_outputs,
)

__all__ = [
    "ANIMATION_SUFFIXES",
    "LAYERS",
    "FileFormats",
    "animation_writer",
    "colour_bytes",
    "depth_bytes",
    "exr_bytes",
    "file_name",
    "id_names",
    "index_bytes",
    "number_bytes",
    "parse_layers",
    "required_outputs",
]
