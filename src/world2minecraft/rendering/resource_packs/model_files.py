"""A model's file and its parents become one: elements, textures, and whether corners darken."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from world2minecraft.rendering.resource_packs.json_checks import listing, mapping, resource, text
from world2minecraft.rendering.resource_packs.resources import Resources

MOST_PARENTS = 32  # The game's deepest chain has 5.
MOST_ELEMENTS = 2048  # Of one model; large furniture of mods has some hundred.
_CURE = "give the client jar of the game before the pack"


@dataclass(frozen=True, eq=False)
class FlatModel:
    """A model with its parents' values: raw elements, and texture names by their keys.

    ``in_code`` says that the game draws it in code, as it does chests and beds.
    """

    elements: tuple[Mapping[str, Any], ...]
    textures: Mapping[str, Any]
    ambient_occlusion: bool
    in_code: bool


def flatten(name: str, resources: Resources) -> FlatModel:
    """Return the model of a name such as ``minecraft:block/stone`` merged with its parents.

    The child's elements replace the parents'; textures merge, the child's first.

    Raises:
        ValueError: it or a parent is missing, is its own parent, or is not as the format says.
    """
    chain = _chain(name, resources)
    textures: dict[str, Any] = {}
    elements: Any = None
    occlusion: Any = None
    for model in chain:
        for key, value in mapping(model.get("textures", {}), "textures").items():
            textures.setdefault(key, value)
        elements = model.get("elements") if elements is None else elements
        occlusion = model.get("ambientocclusion") if occlusion is None else occlusion
        if "loader" in model:
            raise ValueError(f"model {name} is in a mod's own format, which is not read")
    if not elements:
        return FlatModel((), textures, True, in_code=True)
    boxes = [mapping(one, "an element") for one in listing(elements, "elements", MOST_ELEMENTS)]
    return FlatModel(tuple(boxes), textures, occlusion is not False, in_code=False)


def _chain(name: str, resources: Resources) -> list[dict[str, Any]]:
    """Return the objects of a model and its parents, the child first."""
    chain: list[dict[str, Any]] = []
    seen: set[tuple[str, str]] = set()
    at: str | None = name
    while at is not None:
        space, path = resource(at, "model")
        if path.startswith("builtin/"):  # What the game draws in code; there is no file.
            return chain
        if (space, path) in seen:
            raise ValueError(f"model {name} is its own parent")
        if len(seen) == MOST_PARENTS:
            raise ValueError(f"model {name} has more than {MOST_PARENTS} parents")
        seen.add((space, path))
        model = resources.object(f"assets/{space}/models/{path}.json")
        if model is None:
            which = f"{name}: its parent {space}:{path}" if chain else f"{space}:{path}"
            raise ValueError(f"model {which} is in none of the packs, or cannot be read; {_CURE}")
        chain.append(model)
        at = None if model.get("parent") is None else text(model["parent"], "parent")
    return chain


def texture_of(face: str, textures: Mapping[str, Any]) -> str:
    """Return the name ``namespace:path`` of the texture that a face names, through its keys.

    Newer files hold an object with a ``sprite`` in place of a name.

    Raises:
        ValueError: no texture is there, or the keys lead in a circle.
    """
    key, seen = face.removeprefix("#"), set()
    if not face.startswith("#") and key not in textures:
        return ":".join(resource(key, "texture"))
    while key not in seen:
        seen.add(key)
        value = textures.get(key)
        if isinstance(value, dict):
            value = value.get("sprite")
        if value is None:
            raise ValueError(f"texture #{key[:40]} is not set")
        value = text(value, f"texture {key[:40]}")
        if not value.startswith("#"):
            return ":".join(resource(value, "texture"))
        key = value[1:]
    raise ValueError(f"texture #{key[:40]} leads back to itself")
