"""Block maps: from the blocks of any world to the 12 classes, by name and by place.

``load_block_map`` gives a shipped map or one of a YAML file, ``classify`` labels a volume by it,
and ``remap_labels`` gives what is labelled already other classes.
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
