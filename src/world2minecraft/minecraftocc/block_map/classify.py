"""From blocks to classes by a block map: by their names, then by where they are."""

from dataclasses import replace

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES, OBJECT_CLASSES
from world2minecraft.core.types import BlockVolume, Entity
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.minecraftocc.block_map.context import Context
from world2minecraft.minecraftocc.block_map.rules import BlockMap, matches

MOST_OBJECTS = 65_535
EMPTY = CLASS_NAMES[0]


def classify(volume: BlockVolume, rules: BlockMap) -> BlockVolume:
    """Return a volume with the class of every block, and its objects numbered.

    What the volume knew of classes and objects is not asked. Blocks of one class of objects that
    touch by a face are one object.

    Args:
        volume: the blocks; their scale says how high a person stands.
        rules: the block map.
    """
    semantic = classes_of(volume, rules)
    return replace(
        volume,
        semantic=semantic,
        instance=_instances(semantic),
        entities=tuple(replace(one, class_id=_entity(one, rules)) for one in volume.entities),
    )


def classes_of(volume: BlockVolume, rules: BlockMap) -> np.ndarray:
    """Return the class of every block by a map, uint8 [X, Y, Z]."""
    meanings = [EMPTY, *(rules.meaning(state) for state in volume.palette[1:])]
    names = tuple(dict.fromkeys([EMPTY, *meanings]))
    number_of = {name: number for number, name in enumerate(names)}
    table = np.array([number_of[name] for name in meanings], np.uint16)
    kinds = table[volume.states]
    classes = np.array([CLASS_NAMES.index(n) if n in CLASS_NAMES else 0 for n in names], np.uint8)
    semantic = classes[kinds]
    asked = [name for name in names if name not in CLASS_NAMES]
    if not asked:
        return semantic
    turned = np.array(["half=top" in state or "type=top" in state for state in volume.palette])
    scale = volume.blocks_per_metre
    ids = [state.partition("[")[0] for state in volume.palette]
    blocks = np.unique(ids, return_inverse=True)[1][volume.states]
    context = Context(kinds, names, rules, blocks, turned[volume.states], scale)
    flat = semantic.reshape(-1)
    for name in asked:
        left = np.flatnonzero(kinds == number_of[name])
        for rule in rules.rules[name]:
            holds = context.holds(rule, left) if not rule.always else np.ones(len(left), bool)
            flat[left[holds]] = CLASS_NAMES.index(rule.class_name)
            left = left[~holds]
    return semantic


def _instances(semantic: np.ndarray) -> np.ndarray:
    instance = np.zeros(semantic.shape, np.uint16)
    following = 0
    for number in OBJECT_CLASSES:
        parts, count = label_components(semantic == number, corners=False)
        if following + count > MOST_OBJECTS:
            break
        instance[parts > 0] = (parts[parts > 0] + following).astype(np.uint16)
        following += count
    return instance


def _entity(entity: Entity, rules: BlockMap) -> int:
    name = entity.id.partition(":")[2] or entity.id
    for pattern, class_name in rules.entities:
        if matches(pattern, entity.id, name, frozenset()):
            return CLASS_NAMES.index(class_name)
    return entity.class_id
