"""Block states as NBT: the entries of the palettes of chunks, structures and Litematica."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import DamagedFileError, UsageError
from world2minecraft.minecraft.block_renames import read_state, write_state
from world2minecraft.minecraft.block_states import MAX_TEXT, BlockState, parse_state


def state_entry(state: str, data_version: int) -> dict[str, Any]:
    """Return a palette entry of NBT, its block named as the game of ``data_version`` does.

    Example:
        >>> state_entry("minecraft:oak_log[axis=y]", 3465)
        {'Name': 'minecraft:oak_log', 'Properties': {'axis': 'y'}}
    """
    parsed = parse_state(write_state(state, data_version))
    entry: dict[str, Any] = {"Name": parsed.name}
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
    text = str(BlockState(name, properties))
    if len(text) > MAX_TEXT:
        raise UsageError(f"block state {text[:60] + '...'!r} of more than {MAX_TEXT:,} letters")
    return text


def palette_texts(entries: Any, data_version: Any, path: str | Path) -> list[str]:
    """Return the states of a whole palette of NBT, as 1.20.1 calls them.

    Args:
        entries: the list of compounds.
        data_version: what the file says of the game that wrote it.
        path: the file that errors name.

    Raises:
        DamagedFileError: it is no list of block states.
    """
    try:
        return [read_state(state_text(entry), int(data_version)) for entry in entries]
    except (UsageError, AttributeError, TypeError, ValueError, IndexError) as error:
        raise DamagedFileError(path, f"has a palette with {error}") from error
