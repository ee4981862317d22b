"""The looks of blocks as data: which blocks, which textures on which faces, which boxes.

In: the files of ``data/``. Out: the rule of a block state. The first rule that fits the block's
name counts, else that of what it is cut from, else one of the last file. Keys of a rule:

- ``blocks``: patterns of names without namespace; ``needs``: properties that must be there.
- ``skin``: words of a recipe (``texture_recipes.py``) or one of ``skins``, or a table of faces:
  all, side, end, up, down, north, south, west, east; null leaves the face away.
- ``turn``, ``point``, ``axis``, ``rotation``, ``head``: the property that turns the model, which is
  written for north, for up, along y, for a sign's front to north, for a head's. With none of
  ``parts`` it is a full cube; ``uv`` and ``spin`` are then those of that part.
- ``parts``: see ``models.py``, or the name of one of ``models``; a rule with neither draws the
  boxes that are seen (``minecraft.visual_shapes``).
- ``glow``: it is seen by its own light.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import cache, lru_cache
from importlib.resources import files
from typing import Any

from world2minecraft.minecraft.block_states import BlockState
from world2minecraft.minecraft.block_table import block_table

FILES = (
    "cubes.json",
    "wooden.json",
    "furniture.json",
    "lights.json",
    "plants.json",
    "redstone.json",
    "liquids.json",
    "mods.json",
)
TURNS = ("turn", "point", "axis", "rotation", "head")

# A shape and the endings that the block it is cut from may have.
SHAPES = (
    "_stairs",
    "_slab",
    "_wall",
    "_fence_gate",
    "_fence",
    "_button",
    "_pressure_plate",
    "_carpet",
    "_pane",
)
ENDINGS = ("_planks", "", "s", "_block", "_wool")  # Bamboo slabs are of planks, not of the plant.
PREFIXES = ("waxed_", "infested_", "petrified_")


@dataclass(frozen=True, eq=False)
class ModelRule:
    """How some blocks look; the keys are explained above."""

    blocks: tuple[str, ...]
    needs: tuple[str, ...]
    skin: str | Mapping[str, Any] | None
    skins: Mapping[str, Any]
    turns: tuple[tuple[str, str], ...]
    parts: tuple[Mapping[str, Any], ...] | None
    glow: bool


def rule_for(state: BlockState) -> ModelRule | None:
    """Return the rule of a complete state, or None where none fits."""
    return _rule(state.name, tuple(key for key, _ in state.properties))


def material_of(name: str) -> str:
    """Return the name of the block that another is cut from, or its own.

    Example:
        >>> material_of("minecraft:waxed_cut_copper_stairs")
        'minecraft:cut_copper'
    """
    namespace, _, plain = name.rpartition(":")
    for prefix in PREFIXES:
        plain = plain.removeprefix(prefix)
    for shape in SHAPES:
        if plain.endswith(shape):
            stem = plain.removesuffix(shape)
            for ending in ENDINGS:
                if f"minecraft:{stem}{ending}" in block_table().blocks:
                    return f"minecraft:{stem}{ending}"
            return f"{namespace}:{stem}"
    return f"{namespace}:{plain}"


@lru_cache(maxsize=1 << 14)
def _rule(name: str, properties: tuple[str, ...]) -> ModelRule | None:
    names = [one.partition(":")[2] for one in dict.fromkeys((name, material_of(name)))]
    for rules in model_rules():
        for plain in names:
            for rule in rules:
                if all(key in properties for key in rule.needs) and any(
                    fnmatchcase(plain, pattern) for pattern in rule.blocks
                ):
                    return rule
    return None


@cache
def model_rules() -> tuple[tuple[ModelRule, ...], tuple[ModelRule, ...]]:
    """Read the shipped files, once: the rules of known blocks, then those by words of names."""
    folder = files("world2minecraft.rendering.block_models").joinpath("data")
    raw = [json.loads(folder.joinpath(name).read_text("utf-8")) for name in FILES]
    shared: dict[str, Any] = {}
    models: dict[str, Any] = {}
    for one in raw:
        shared |= one.get("skins", {})
        models |= one.get("models", {})
    rules = [[_read_rule(entry, shared, models) for entry in one["rules"]] for one in raw]
    return tuple(rule for one in rules[:-1] for rule in one), tuple(rules[-1])


def _read_rule(
    entry: Mapping[str, Any], shared: Mapping[str, Any], models: Mapping[str, Any]
) -> ModelRule:
    turns = tuple((key, entry[key]) for key in TURNS if key in entry)
    parts = entry.get("parts")
    if isinstance(parts, str):
        parts = models[parts]
    if parts is None and turns:
        painted = {key: entry[key] for key in ("uv", "spin") if key in entry}
        parts = [{"boxes": [[0, 0, 0, 16, 16, 16]], **painted}]
    return ModelRule(
        blocks=tuple(entry["blocks"]),
        needs=(*entry.get("needs", ()), *(value for _, value in turns)),
        skin=entry.get("skin"),
        skins={**shared, **entry.get("skins", {})},
        turns=turns,
        parts=None if parts is None else tuple(parts),
        glow=bool(entry.get("glow", False)),
    )
