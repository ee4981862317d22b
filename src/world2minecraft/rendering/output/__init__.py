"""Pictures as files: colour, depth, ids, and moving pictures."""

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
    "LAYERS",
    "ANIMATION_SUFFIXES",
    "FileFormats",
    "colour_bytes",
    "depth_bytes",
    "exr_bytes",
    "file_name",
    "index_bytes",
    "parse_layers",
    "animation_writer",
    "required_outputs",
    "number_bytes",
    "id_names",
]
