"""A blockstates file and a block's properties become the models that are drawn, each turned.

Where a file leaves the choice to chance (a list with weights), the heaviest is taken, the first of
equals: a look belongs to a state here, not to a place, so that all blocks of a state look alike.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from world2minecraft.rendering.resource_packs.json_checks import (
    listing,
    mapping,
    number,
    quarter,
    shown,
    text,
)

MOST_CASES = 4096  # Of a multipart; a game's redstone wire has about 20.
MOST_DEPTH = 16  # Of conditions within conditions.


@dataclass(frozen=True)
class Part:
    """A model and how it is turned: degrees about x first, then y, then z."""

    model: str
    x_deg: int = 0
    y_deg: int = 0
    z_deg: int = 0
    uv_lock: bool = False


def parts_of(root: Mapping[str, Any], properties: Mapping[str, str]) -> tuple[Part, ...]:
    """Return the parts that a state is drawn as; none where a multipart has none for it.

    Args:
        root: the object of ``assets/NAMESPACE/blockstates/BLOCK.json``.
        properties: all properties of the state. One that is missing here counts as any value.

    Raises:
        ValueError: the file is not as the format says, or no variant is for these properties.
    """
    parts: list[Part] = []
    if "variants" in root:
        parts.append(_chosen(_variant(mapping(root["variants"], "variants"), properties)))
    for one in listing(root.get("multipart", []), "multipart", MOST_CASES):
        case = mapping(one, "a case of multipart")
        if "when" not in case or _holds(case["when"], properties, 0):
            parts.append(_chosen(case.get("apply")))
    if "variants" not in root and "multipart" not in root:
        raise ValueError("has neither variants nor multipart")
    return tuple(parts)


def _variant(variants: dict[str, Any], properties: Mapping[str, str]) -> Any:
    for key, value in variants.items():
        if all(_agrees(pair, properties) for pair in key.split(",")):
            return value
    said = ",".join(f"{key}={value}" for key, value in sorted(properties.items()))
    raise ValueError(f"has no variant for {shown(said)}")


def _agrees(pair: str, properties: Mapping[str, str]) -> bool:
    """Return whether ``facing=east`` holds; "" and old packs' "normal" stand for all states."""
    key, equals, value = pair.strip().partition("=")
    return not equals or properties.get(key, value) == value


def _holds(when: Any, properties: Mapping[str, str], depth: int) -> bool:
    """Return whether a condition holds: properties, ``OR`` and ``AND`` lists, one in another."""
    if depth > MOST_DEPTH:
        raise ValueError("its conditions are nested too deep")
    for key, wanted in mapping(when, "when").items():
        if key in ("OR", "AND"):
            several = [
                _holds(one, properties, depth + 1) for one in listing(wanted, key, MOST_CASES)
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
    words = text(wanted, "a value of when")
    if words.startswith("!"):
        return value not in words[1:].split("|")
    return value in words.split("|")


def _chosen(entry: Any) -> Part:
    """Return the heaviest entry of a list, the first of equals; or the only one."""
    if isinstance(entry, list):
        if not entry:
            raise ValueError("has an empty list of models")
        entries = [mapping(one, "a model of a list") for one in listing(entry, "models", 10_000)]
        weights = [number(one.get("weight", 1), "weight") for one in entries]
        entry = entries[weights.index(max(weights))]
    entry = mapping(entry, "a variant")
    return Part(
        text(entry.get("model"), "model"),
        *(quarter(entry.get(axis, 0), axis) for axis in "xyz"),
        uv_lock=entry.get("uvlock", False) is True,
    )
