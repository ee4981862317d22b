"""Block states as NBT: the entries of the palettes of chunks, structures and Litematica."""

from collections.abc import Mapping
from typing import Any

from world2minecraft.errors import DamagedFileError, UsageError
from world2minecraft.minecraft.states import BlockState, parse_state
from world2minecraft.minecraft.versions import name_in_version


def state_entry(state: str, data_version: int) -> dict[str, Any]:
    """Return a palette entry of NBT, its block named as the game of ``data_version`` does.

    Example:
        >>> state_entry("minecraft:oak_log[axis=y]", 3465)
        {'Name': 'minecraft:oak_log', 'Properties': {'axis': 'y'}}
    """
    parsed = parse_state(state)
    entry: dict[str, Any] = {"Name": name_in_version(parsed.name, data_version)}
    if parsed.properties:
        entry["Properties"] = dict(parsed.properties)
    return entry


def state_text(entry: Mapping[str, Any]) -> str:
    """Return the canonical text of a palette entry of NBT, with Name and Properties.

    Raises:
        UsageError: the entry names no block state.
    """
    name, properties = entry.get("Name"), entry.get("Properties", {})
    texts = isinstance(properties, dict) and all(isinstance(v, str) for v in properties.values())
    if not isinstance(name, str) or not texts:
        raise UsageError("a block state without a name, or with properties that are no text")
    return str(BlockState(name, properties))


def palette_texts(entries: Any, path: Any) -> list[str]:
    """Return the texts of a whole palette of NBT.

    Raises:
        DamagedFileError: it is no list of block states.
    """
    try:
        return [state_text(entry) for entry in entries]
    except (UsageError, AttributeError, TypeError) as error:
        raise DamagedFileError(path, f"has a palette with {error}") from error
