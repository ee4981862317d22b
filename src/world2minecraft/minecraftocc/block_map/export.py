"""A block map as JSON: what each block of the game stands for, for programs that read no YAML."""

from typing import Any

from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.minecraft.block_states import known_blocks
from world2minecraft.minecraftocc.block_map.rules import BlockMap, Rule


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
        "kinds": {kind: [_rule(rule) for rule in rules.rules[kind]] for kind in rules.rules},
        "words": [
            {"namespaces": list(words.namespaces), "words": dict(words.meanings)}
            for words in rules.words
        ],
        "designs": {pattern.text: name for pattern, name in rules.designs},
        "entities": {pattern.text: name for pattern, name in rules.entities},
    }


def _rule(rule: Rule) -> dict[str, Any]:
    found: dict[str, Any] = {"class": rule.class_name}
    if rule.where:
        found["where"] = list(rule.where)
    found.update({name: list(span) for name, span in rule.spans.items()})
    if rule.shares:
        found["share"] = {name: list(span) for name, span in rule.shares.items()}
    return found
