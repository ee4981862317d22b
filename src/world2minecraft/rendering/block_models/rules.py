"""Block appearance as data: which blocks have which textures on which faces, and which boxes.

The rules are read from ``data/``. The first rule that matches the block's name is used, then the
rule of the block's material, then a rule of the last file. Keys of a rule:

- ``blocks``: Name patterns without namespace. ``needs``: Properties that must be present.
- ``skin``: A texture description (``texture_recipes.py``), a key of ``skins``, or a table of faces:
  all, side, end, up, down, north, south, west, east. null omits the face.
- ``turn``, ``point``, ``axis``, ``rotation``, ``head``: The property that rotates the model. The
  model is written facing north, pointing up, along y, as a sign facing north, or as a head. Without
  ``parts`` it is a full cube, to which ``uv`` and ``spin`` then apply.
- ``parts``: See ``models.py``, or a key of ``models``. Rules without parts or skin use the visible
  boxes (``minecraft.visual_shapes``).
- ``glow``: The block is rendered as luminous.
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
    """The appearance of some blocks. The fields are explained in the module docstring."""

    blocks: tuple[str, ...]
    needs: tuple[str, ...]
    skin: str | Mapping[str, Any] | None
    skins: Mapping[str, Any]
    turns: tuple[tuple[str, str], ...]
    parts: tuple[Mapping[str, Any], ...] | None
    glow: bool


def rule_for(state: BlockState) -> ModelRule | None:
    """Return the rule of a complete block state, or None if no rule matches."""
    return _rule(state.name, tuple(key for key, _ in state.properties))


def material_of(name: str) -> str:
    """Return the block that another block is made from, such as the full block of stairs.

    A block without such a material is returned itself.

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
    """Load the rule files, once: the rules of known blocks, then those by parts of names."""
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
