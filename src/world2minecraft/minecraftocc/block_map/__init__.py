"""Block maps, which assign the blocks of any world to the 12 classes by block name and position.

``load_block_map`` loads a shipped map or a YAML file, ``classify`` labels a volume with a map, and
``remap_labels`` applies a different map to existing labels.
"""

from world2minecraft.minecraftocc.block_map.classification import (
    block_map_json,
    class_of_fine,
    classify,
    remap_labels,
)
from world2minecraft.minecraftocc.block_map.parser import (
    MAPS,
    load_block_map,
    parse_block_map,
    read_block_map,
)
from world2minecraft.minecraftocc.block_map.rules import BlockMap

__all__ = [
    "MAPS",
    "BlockMap",
    "block_map_json",
    "class_of_fine",
    "classify",
    "load_block_map",
    "parse_block_map",
    "read_block_map",
    "remap_labels",
]
