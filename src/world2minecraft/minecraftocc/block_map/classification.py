"""Classify blocks with a block map, by their names and by their positions.

``classify`` labels a volume. ``remap_labels`` applies another map to cells that are already
labelled. A stored sample contains the block and the design of each cell, but not its position in
the house, so a class that depends on the position (planks can be floor, wall or ceiling) is left
unchanged. ``block_map_json`` exports a map as JSON for programs that cannot read YAML.
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
    """Return the class of a fine class, or None if the class depends on the position of the block.

    The design takes precedence over the block.

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
    """Apply another block map to existing labels.

    Args:
        labels: Class of each cell (0 to 11, or 255 for unknown), uint8 of any shape. Empty and
            unknown cells are not changed.
        fine: Index into ``classes`` for each cell, uint16 in the same shape.
        classes: The fine classes; the first one stands for empty cells.
        rules: Block map to apply.

    Raises:
        UsageError: If the shapes differ, or if ``fine`` contains an index outside ``classes``.
    """
    if labels.shape != fine.shape:
        raise UsageError(
            f"labels and fine must have the same shape, got {labels.shape} and {fine.shape}"
        )
    if fine.size and int(fine.max()) >= len(classes):
        raise UsageError(
            f"fine must contain indices below {len(classes)}, the number of classes; got "
            f"{fine.max()}"
        )
    mapped = [None if n == 0 else class_of_fine(one, rules) for n, one in enumerate(classes)]
    is_mapped = np.array([one is not None for one in mapped])
    values = np.array([one or 0 for one in mapped], np.uint8)
    changed = is_mapped[fine] & (labels != 0) & (labels != UNKNOWN)
    return np.where(changed, values[fine], labels).astype(np.uint8)


def block_map_json(rules: BlockMap) -> dict[str, Any]:
    """Return a block map as nested dicts and lists for JSON.

    ``blocks`` assigns a class to each block of the game, or the kind whose rules decide its class.
    ``words`` assigns classes or kinds to words in the block names of mods.
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
    """Classify each block of a volume and number the objects.

    Existing classes and object numbers are ignored. Blocks of the same object class that share a
    face form one object.

    Args:
        volume: Volume to classify. Its scale determines sizes in metres, such as headroom.
        rules: Block map to apply.

    Returns:
        A copy of the volume with new classes and object numbers.
    """
    semantic = classify_blocks(volume, rules)
    return replace(
        volume,
        semantic=semantic,
        instance=_number_objects(semantic),
        entities=tuple(replace(one, class_id=_entity_class(one, rules)) for one in volume.entities),
    )


def classify_blocks(volume: BlockVolume, rules: BlockMap) -> np.ndarray:
    """Return the class of each block according to a block map, uint8 [X, Y, Z]."""
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
