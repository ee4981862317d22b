"""Classify blocks by a block map: by their names, then by where they are.

``classify`` labels a volume. ``remap_labels`` gives other classes to cells that are labelled
already: a stored sample keeps the block and the design of each cell, so another map can be applied
to it; where these alone do not decide (planks are floor, wall or ceiling), the known class stays.
``block_map_json`` writes a map for programs that read no YAML.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES, OBJECT_CLASSES, UNKNOWN
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import BlockVolume, Entity
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.minecraft.block_states import known_blocks
from world2minecraft.minecraftocc.block_map.block_conditions import Context
from world2minecraft.minecraftocc.block_map.rules import BlockMap, Rule, matches
from world2minecraft.minecraftocc.types import FineClass

MAX_OBJECTS = 65_535
EMPTY = CLASS_NAMES[0]


def class_of_fine(fine: FineClass, rules: BlockMap) -> int | None:
    """Return the class that a map gives a fine class wherever it is; None where it depends.

    A design counts for more than the blocks that it is made of.

    Example:
        >>> from world2minecraft.minecraftocc.block_map import load_block_map
        >>> class_of_fine(FineClass("minecraft:white_wool", "curtain"), load_block_map("paper"))
        0
    """
    if fine.design:
        for pattern, name in rules.designs:
            if matches(pattern, fine.design, fine.design, frozenset()):
                return CLASS_NAMES.index(name)
        return None
    meaning = rules.meaning(fine.block)
    candidates = rules.rules_of(meaning)
    if meaning in rules.unless_known or not candidates[0].always:
        return None
    return CLASS_NAMES.index(candidates[0].class_name)


def remap_labels(
    labels: np.ndarray, fine: np.ndarray, classes: Sequence[FineClass], rules: BlockMap
) -> np.ndarray:
    """Return labels by another map.

    Args:
        labels: uint8, any shape: 0 to 11 or 255. Cells that are empty or unknown stay so.
        fine: uint16 of the same shape, indices of ``classes``.
        classes: the fine classes; the first stands for empty cells.
        rules: the map.

    Raises:
        UsageError: the shapes differ, or a number is beyond the classes.
    """
    if labels.shape != fine.shape:
        raise UsageError(f"labels {labels.shape} and fine {fine.shape} must be of one shape")
    if fine.size and int(fine.max()) >= len(classes):
        raise UsageError(f"fine goes to {fine.max()}, there are {len(classes)} classes")
    mapped = [None if n == 0 else class_of_fine(one, rules) for n, one in enumerate(classes)]
    is_mapped = np.array([one is not None for one in mapped])
    values = np.array([one or 0 for one in mapped], np.uint8)
    changed = is_mapped[fine] & (labels != 0) & (labels != UNKNOWN)
    return np.where(changed, values[fine], labels).astype(np.uint8)


def block_map_json(rules: BlockMap) -> dict[str, Any]:
    """Return a map as a tree of plain values.

    ``blocks`` gives each block of the game a class, or the kind whose rules say which; ``words``
    says what words in names of mods mean.
    """
    blocks = {name: rules.meaning(name) for name in known_blocks()} | dict(rules.blocks)
    return {
        "name": rules.name,
        "about": " ".join(rules.about.split()),
        "classes": list(CLASS_NAMES),
        "blocks": dict(sorted(blocks.items())),
        "kinds": {kind: [_rule_json(rule) for rule in rules.rules[kind]] for kind in rules.rules},
        "words": [
            {"namespaces": list(words.namespaces), "words": dict(words.meanings)}
            for words in rules.words
        ],
        "designs": {pattern.text: name for pattern, name in rules.designs},
        "entities": {pattern.text: name for pattern, name in rules.entities},
    }


def _rule_json(rule: Rule) -> dict[str, Any]:
    found: dict[str, Any] = {"class": rule.class_name}
    if rule.where:
        found["where"] = list(rule.where)
    found.update({name: list(span) for name, span in rule.spans.items()})
    if rule.shares:
        found["share"] = {name: list(span) for name, span in rule.shares.items()}
    return found


def classify(volume: BlockVolume, rules: BlockMap) -> BlockVolume:
    """Return a volume with the class of every block, and its objects numbered.

    The classes and objects that the volume has are ignored. Blocks of one class of objects that
    touch by a face are one object.

    Args:
        volume: the blocks; their scale says how high a person stands.
        rules: the block map.
    """
    semantic = classify_blocks(volume, rules)
    return replace(
        volume,
        semantic=semantic,
        instance=_number_objects(semantic),
        entities=tuple(replace(one, class_id=_entity_class(one, rules)) for one in volume.entities),
    )


def classify_blocks(volume: BlockVolume, rules: BlockMap) -> np.ndarray:
    """Return the class of every block by a map, uint8 [X, Y, Z]."""
    meanings = [EMPTY, *(rules.meaning(state) for state in volume.palette[1:])]
    names = tuple(dict.fromkeys([EMPTY, *meanings]))
    number_of = {name: number for number, name in enumerate(names)}
    table = np.array([number_of[name] for name in meanings], np.uint16)
    kinds = table[volume.states]
    classes = np.array([CLASS_NAMES.index(n) if n in CLASS_NAMES else 0 for n in names], np.uint8)
    semantic = classes[kinds]
    undecided = [name for name in names if name not in CLASS_NAMES]
    if not undecided:
        return semantic
    turned = np.array(["half=top" in state or "type=top" in state for state in volume.palette])
    scale = volume.blocks_per_metre
    ids = [state.partition("[")[0] for state in volume.palette]
    blocks = np.unique(ids, return_inverse=True)[1][volume.states]
    context = Context(kinds, names, rules, blocks, turned[volume.states], scale)
    flat = semantic.reshape(-1)
    for name in undecided:
        left = np.flatnonzero(kinds == number_of[name])
        for rule in rules.rules[name]:
            holds = context.holds(rule, left) if not rule.always else np.ones(len(left), bool)
            flat[left[holds]] = CLASS_NAMES.index(rule.class_name)
            left = left[~holds]
    return semantic


def _number_objects(semantic: np.ndarray) -> np.ndarray:
    instance = np.zeros(semantic.shape, np.uint16)
    following = 0
    for number in OBJECT_CLASSES:
        parts, count = label_components(semantic == number, corners=False)
        if following + count > MAX_OBJECTS:
            break
        instance[parts > 0] = (parts[parts > 0] + following).astype(np.uint16)
        following += count
    return instance


def _entity_class(entity: Entity, rules: BlockMap) -> int:
    name = entity.id.partition(":")[2] or entity.id
    for pattern, class_name in rules.entities:
        if matches(pattern, entity.id, name, frozenset()):
            return CLASS_NAMES.index(class_name)
    return entity.class_id
