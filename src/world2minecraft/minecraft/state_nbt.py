"""Conversion between block states and NBT palette entries of chunks, structures and schematics."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import MALFORMED, DamagedFileError, UsageError
from world2minecraft.minecraft.block_renames import read_state, write_state
from world2minecraft.minecraft.block_states import MAX_TEXT, BlockState, parse_state


def state_entry(state: str, data_version: int) -> dict[str, Any]:
    """Return the NBT palette entry of a block state, with the block names of a game version.

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
    """Return the canonical text of an NBT palette entry with ``Name`` and ``Properties``.

    Raises:
        UsageError: If the entry is not a valid block state.
    """
    name, properties = entry.get("Name"), entry.get("Properties", {})
    texts = isinstance(properties, dict) and all(isinstance(v, str) for v in properties.values())
    if not isinstance(name, str) or not texts:
        raise UsageError("a block state must have a name and text properties")
    text = str(BlockState(name, properties))
    if len(text) > MAX_TEXT:
        shown = text[:60] + "..."
        raise UsageError(f"block state {shown!r} exceeds the limit of {MAX_TEXT:,} characters")
    return text


def palette_texts(entries: Any, data_version: Any, path: str | Path) -> list[str]:
    """Convert a whole NBT palette to block states with the names of 1.20.1.

    Args:
        entries: The list of palette entries.
        data_version: The data version stored in the file.
        path: The file path for error messages.

    Raises:
        DamagedFileError: If an entry is not a valid block state.
    """
    try:
        return [read_state(state_text(entry), int(data_version)) for entry in entries]
    except (*MALFORMED, UsageError) as error:
        raise DamagedFileError(path, f"contains an invalid palette entry: {error}") from error
