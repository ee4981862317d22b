"""Block state files and model files: the models of a state, each merged with its parents.

If a file leaves the choice to chance (a weighted list), the first model with the highest weight is
used, because a model here depends on the state and not on the position.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from world2minecraft.rendering.resource_packs.json_validation import (
    as_list,
    as_number,
    as_object,
    as_quarter_turn,
    as_text,
    describe_value,
    parse_resource_name,
)
from world2minecraft.rendering.resource_packs.pack_files import PackStack

MAX_CASES = 4096  # Maximum cases of a multipart model; redstone wire has about 20.
MAX_CONDITION_DEPTH = 16  # Maximum depth of nested conditions.
MAX_PARENTS = 32  # The game's deepest chain has 5.
MAX_ELEMENTS = 2048  # Maximum elements of a model; large furniture of mods has hundreds.
_CURE = "pass the game's client jar before the pack"


@dataclass(frozen=True)
class ModelPart:
    """A model with its rotation in degrees, about x first, then y, then z."""

    model: str
    x_deg: int = 0
    y_deg: int = 0
    z_deg: int = 0
    uv_lock: bool = False


def select_parts(root: Mapping[str, Any], properties: Mapping[str, str]) -> tuple[ModelPart, ...]:
    """Return the parts that a state is rendered with, which may be none for a multipart file.

    Args:
        root: JSON object of ``assets/NAMESPACE/blockstates/BLOCK.json``.
        properties: All properties of the state. A missing property matches any value.

    Raises:
        ValueError: If the file is invalid, or if no variant matches the properties.
    """
    parts: list[ModelPart] = []
    if "variants" in root:
        parts.append(_heaviest(_variant(as_object(root["variants"], "variants"), properties)))
    for one in as_list(root.get("multipart", []), "multipart", MAX_CASES):
        case = as_object(one, "a case of multipart")
        if "when" not in case or _holds(case["when"], properties, 0):
            parts.append(_heaviest(case.get("apply")))
    if "variants" not in root and "multipart" not in root:
        raise ValueError("contains neither variants nor multipart")
    return tuple(parts)


def _variant(variants: dict[str, Any], properties: Mapping[str, str]) -> Any:
    for key, value in variants.items():
        if all(_agrees(pair, properties) for pair in key.split(",")):
            return value
    listed = ",".join(f"{key}={value}" for key, value in sorted(properties.items()))
    raise ValueError(f"has no variant for {describe_value(listed)}")


def _agrees(pair: str, properties: Mapping[str, str]) -> bool:
    """Return whether ``facing=east`` holds; "" and old packs' "normal" stand for all states."""
    key, equals, value = pair.strip().partition("=")
    return not equals or properties.get(key, value) == value


def _holds(when: Any, properties: Mapping[str, str], depth: int) -> bool:
    """Return whether a condition holds: properties, ``OR`` and ``AND`` lists, one in another."""
    if depth > MAX_CONDITION_DEPTH:
        raise ValueError("conditions are nested too deeply")
    for key, wanted in as_object(when, "when").items():
        if key in ("OR", "AND"):
            several = [
                _holds(one, properties, depth + 1) for one in as_list(wanted, key, MAX_CASES)
            ]
            if not (any(several) if key == "OR" else all(several)):
                return False
        elif not _is_one_of(wanted, properties.get(key)):
            return False
    return True


def _is_one_of(wanted: Any, value: str | None) -> bool:
    """Return whether a value is among ``a|b``, or not among ``!a|b``."""
    if isinstance(wanted, bool):
        wanted = "true" if wanted else "false"
    if isinstance(wanted, int):
        wanted = str(wanted)
    words = as_text(wanted, "a value in when")
    if words.startswith("!"):
        return value not in words[1:].split("|")
    return value in words.split("|")


def _heaviest(entry: Any) -> ModelPart:
    """Return the heaviest entry of a list, the first of equals; or the only one."""
    if isinstance(entry, list):
        if not entry:
            raise ValueError("contains an empty list of models")
        entries = [as_object(one, "a model in a list") for one in as_list(entry, "models", 10_000)]
        weights = [as_number(one.get("weight", 1), "weight") for one in entries]
        entry = entries[weights.index(max(weights))]
    entry = as_object(entry, "a variant")
    return ModelPart(
        as_text(entry.get("model"), "model"),
        *(as_quarter_turn(entry.get(axis, 0), axis) for axis in "xyz"),
        uv_lock=entry.get("uvlock", False) is True,
    )


@dataclass(frozen=True, eq=False)
class FlatModel:
    """A model merged with its parents: raw elements, and texture names by key.

    There are no elements if the game renders the block in code, as for chests and beds.
    """

    elements: tuple[Mapping[str, Any], ...]
    textures: Mapping[str, Any]
    ambient_occlusion: bool


def flatten_model(name: str, resources: PackStack) -> FlatModel:
    """Return the model of a name such as ``minecraft:block/stone``, merged with its parents.

    The child's elements replace those of its parents. Textures are merged, and the child's take
    precedence.

    Raises:
        ValueError: If the model or a parent is missing or invalid, or if a model is its own parent.
    """
    chain = _chain(name, resources)
    textures: dict[str, Any] = {}
    elements: Any = None
    occlusion: Any = None
    for model in chain:
        for key, value in as_object(model.get("textures", {}), "textures").items():
            textures.setdefault(key, value)
        elements = model.get("elements") if elements is None else elements
        occlusion = model.get("ambientocclusion") if occlusion is None else occlusion
        if "loader" in model:
            raise ValueError(f"model {name} uses a mod's own format, which is not supported")
    if not elements:
        return FlatModel((), textures, True)
    boxes = [as_object(one, "an element") for one in as_list(elements, "elements", MAX_ELEMENTS)]
    return FlatModel(tuple(boxes), textures, occlusion is not False)


def _chain(name: str, resources: PackStack) -> list[dict[str, Any]]:
    """Return the objects of a model and its parents, the child first."""
    chain: list[dict[str, Any]] = []
    seen: set[tuple[str, str]] = set()
    at: str | None = name
    while at is not None:
        space, path = parse_resource_name(at, "model")
        if path.startswith("builtin/"):  # What the game draws in code; there is no file.
            return chain
        if (space, path) in seen:
            raise ValueError(f"model {name} is its own parent")
        if len(seen) == MAX_PARENTS:
            raise ValueError(f"model {name} has more than {MAX_PARENTS} parents")
        seen.add((space, path))
        model = resources.object(f"assets/{space}/models/{path}.json")
        if model is None:
            which = f"{space}:{path} (parent of {name})" if chain else f"{space}:{path}"
            raise ValueError(f"model {which} not found in the packs or not readable; {_CURE}")
        chain.append(model)
        at = None if model.get("parent") is None else as_text(model["parent"], "parent")
    return chain


def texture_of(face: str, textures: Mapping[str, Any]) -> str:
    """Return the name ``namespace:path`` of the texture of a face, resolving its keys.

    Newer files contain an object with a ``sprite`` instead of a name.

    Raises:
        ValueError: If the texture is not set, or if the keys form a cycle.
    """
    key, seen = face.removeprefix("#"), set()
    if not face.startswith("#") and key not in textures:
        return ":".join(parse_resource_name(key, "texture"))
    while key not in seen:
        seen.add(key)
        value = textures.get(key)
        if isinstance(value, dict):
            value = value.get("sprite")
        if value is None:
            raise ValueError(f"texture #{key[:40]} is not set")
        value = as_text(value, f"texture {key[:40]}")
        if not value.startswith("#"):
            return ":".join(parse_resource_name(value, "texture"))
        key = value[1:]
    raise ValueError(f"texture #{key[:40]} refers to itself")
