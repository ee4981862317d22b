"""Pictures as files: colour, depth, ids, and moving pictures."""

from world2minecraft.rendering.output.animation import MOVING_SUFFIXES, moving_picture
from world2minecraft.rendering.output.exr import exr_bytes
from world2minecraft.rendering.output.images import (
    colour_bytes,
    depth_bytes,
    index_bytes,
    number_bytes,
)
from world2minecraft.rendering.output.layers import (
    LAYERS,
    FileChoice,
    file_name,
    layers_named,
    needs_of,
    table_of_names,
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
    "table_of_names",
]
