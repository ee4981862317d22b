"""Reading and validation of furniture design files in JSON.

Users write these files by hand, so every key is checked. Error messages state the expected and the
given value on one line.
"""

import json
import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from world2minecraft.core.classes import CLASS_NAMES, OBJECT_CLASSES
from world2minecraft.core.errors import InputError, UnknownNameError
from world2minecraft.core.files import read_json
from world2minecraft.furniture.family import FAMILIES, Family
from world2minecraft.furniture.materials import Material
from world2minecraft.furniture.template import Span, Template

MAX_BYTES = 65_536  # A design has a thousand at most.
MAX_SIDE_M = 20.0
SIZES = ("depth", "width", "height")
CLEARANCES = ("front", "back", "side")
MOUNTS = ("floor", "wall", "ceiling", "any")
NEEDED = ("name", "title", "class", "family", "size_m", "front", "clearance_m", "materials")
OPTIONAL = ("mount", "turns", "parameters", "options", "match", "suits", "stands_for")


def read_design(path: Path) -> Template:
    """Read a design from a JSON file.

    Raises:
        InputError: If the file cannot be read or is not a valid design.
    """
    raw = read_json(path, MAX_BYTES)
    try:
        found = design_from_json(raw)
    except (ValueError, UnknownNameError) as error:
        raise InputError(path, str(error)) from error
    if found.name != path.stem:
        raise InputError(path, f"the design name must match the file name, got {found.name!r}")
    return found


def design_from_json(raw: Any) -> Template:
    """Return the template described by the contents of a design file.

    Raises:
        ValueError: If a key is missing, unknown or invalid.
        UnknownNameError: If the family is unknown.
    """
    known = _keys("a design", raw, NEEDED, OPTIONAL)
    family: Family = FAMILIES.load(_text("family", known["family"]))
    kind = _text("class", known["class"])
    if kind not in [CLASS_NAMES[number] for number in OBJECT_CLASSES]:
        listed = ", ".join(CLASS_NAMES[number] for number in OBJECT_CLASSES)
        raise ValueError(f"class must be one of {listed}, got {kind!r}")
    _text("front", known["front"])
    sizes = _keys("size_m", known["size_m"], SIZES)
    free = _keys("clearance_m", known["clearance_m"], CLEARANCES)
    return Template(
        name=_text("name", known["name"]),
        title=_text("title", known["title"]),
        class_id=CLASS_NAMES.index(kind),
        family=_matched_family(known),
        size_m=(_size("depth", sizes), _size("width", sizes), _size("height", sizes)),
        build=family.build,
        design=family.design,
        parameters=_parameters(family, known.get("parameters", {})),
        options=_options(family, known.get("options", {})),
        materials=_materials(family, known["materials"]),
        turns=_one_of("turns", known.get("turns", 4), (1, 2, 4)),
        mount=_one_of("mount", known.get("mount", "floor"), MOUNTS),
        clearance_m=tuple(_number(key, free[key], 0.0) for key in CLEARANCES),  # pyright: ignore
        matched=_one_of("match", known.get("match", False), (True, False)),
        suits=tuple(_colour(one) for one in _list("suits", known.get("suits", []))),
    )


def _matched_family(known: Mapping[str, Any]) -> str:
    """Return the family whose matches a design may replace, by default its own."""
    stood = _text("stands_for", known.get("stands_for", known["family"]))
    FAMILIES.load(stood)
    return stood


def _keys(
    what: str, raw: Any, needed: Iterable[str], optional: Iterable[str] = ()
) -> dict[str, Any]:
    if not isinstance(raw, dict):
        raise ValueError(f"{what} must be a JSON object, got {_short(raw)}")
    missing = [key for key in needed if key not in raw]
    if missing:
        raise ValueError(f"{what} does not contain the key {missing[0]!r}")
    known = (*needed, *optional)
    strange = [key for key in raw if key not in known]
    if strange:
        raise ValueError(
            f"{what} contains the unknown key {_short(strange[0])}; keys: {', '.join(known)}"
        )
    return raw


def _text(key: str, value: Any) -> str:
    if not isinstance(value, str) or not 0 < len(value) <= 200:
        raise ValueError(f"{key} must be a string of 1 to 200 characters, got {_short(value)}")
    return value


def _list(key: str, value: Any) -> list:
    if not isinstance(value, list) or len(value) > 16:
        raise ValueError(f"{key} must be a list of at most 16 items, got {_short(value)}")
    return value


def _one_of(key: str, value: Any, choices: tuple) -> Any:
    if not any(value == one and type(value) is type(one) for one in choices):
        listed = ", ".join(json.dumps(one) for one in choices)
        raise ValueError(f"{key} must be one of {listed}, got {_short(value)}")
    return value


def _number(key: str, value: Any, least: float = -math.inf, most: float = MAX_SIDE_M) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ValueError(f"{key} must be a number, got {_short(value)}")
    if not (math.isfinite(value) and least <= value <= most):
        raise ValueError(f"{key} must be between {max(least, -most):g} and {most:g}, got {value}")
    return float(value)


def _span(key: str, value: Any, least: float = -math.inf) -> Span:
    if not isinstance(value, list) or len(value) != 3:
        raise ValueError(f"{key} must be [minimum, typical, maximum], got {_short(value)}")
    span = Span(*(_number(key, one, least) for one in value))
    if not span.minimum <= span.typical <= span.maximum:
        raise ValueError(f"{key} must increase from minimum to maximum, got {_short(value)}")
    return span


def _size(key: str, sizes: Mapping[str, Any]) -> Span:
    return _span(key, sizes[key], 0.01)


def _parameters(family: Family, raw: Any) -> dict[str, Span]:
    given = _keys("parameters", raw, (), family.parameters)
    return dict(family.parameters) | {key: _span(key, value) for key, value in given.items()}


def _options(family: Family, raw: Any) -> dict[str, str]:
    given = _keys("options", raw, (), family.options)
    return {
        key: _one_of(key, given.get(key, choices[0]), choices)
        for key, choices in family.options.items()
    }


def _materials(family: Family, raw: Any) -> dict[str, Material]:
    given = _keys("materials", raw, family.roles)
    return {role: _material(role, given[role]) for role in sorted(family.roles)}


def _material(role: str, raw: Any) -> Material:
    known = _keys(f"the material of {role}", raw, ("kind", "of"), ("colour", "shapes"))
    shapes = _keys(f"the shapes of {role}", known.get("shapes", {}), (), known.get("shapes", {}))
    colour = _one_of("colour", known.get("colour", "own"), ("own", "object"))
    return Material(
        _text("kind", known["kind"]),
        _text("of", known["of"]),
        colour == "object",
        tuple(sorted((shape, _text(shape, block)) for shape, block in shapes.items())),
    )


def _colour(value: Any) -> tuple[int, int, int]:
    text = _text("a colour of suits", value)
    digits = text.removeprefix("#")
    if len(digits) != 6 or text == digits or not all(c in "0123456789abcdef" for c in digits):
        raise ValueError(f"a colour of suits must have the form #8a3b2c, got {_short(value)}")
    red, green, blue = (int(digits[at : at + 2], 16) for at in (0, 2, 4))
    return red, green, blue


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
