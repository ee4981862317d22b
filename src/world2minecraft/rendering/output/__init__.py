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
    "MOVING_SUFFIXES",
    "FileChoice",
    "colour_bytes",
    "depth_bytes",
    "exr_bytes",
    "file_name",
    "index_bytes",
    "layers_named",
    "moving_picture",
    "needs_of",
    "number_bytes",
    "id_names",
]
