"""The game versions that the program supports."""

from dataclasses import dataclass
from functools import cache
from typing import Any

from world2minecraft.core.errors import UnknownNameError
from world2minecraft.minecraft.data_files import read_data

DEFAULT_VERSION = "1.20.1"

# The last game whose level.dat this program knows in every part: 1.21.9 moved the spawn point,
# 1.21.11 the game rules, 26.1 the folders. Newer games upgrade the older layout on opening.
LAST_LEVEL_VERSION = "1.21.8"


@dataclass(frozen=True)
class GameVersion:
    """A release of Minecraft Java Edition.

    ``data_version`` is the version number in the game's files. ``pack_format`` is the format number
    of data packs, with ``pack_minor`` since 1.21.9. ``min_y`` and ``max_y`` are the lowest and
    highest block layers of the overworld.
    """

    name: str
    data_version: int
    pack_format: int
    pack_minor: int = 0
    min_y: int = -64
    max_y: int = 319

    @property
    def level_data_version(self) -> int:
        """The data version of worlds written for this game."""
        return min(self.data_version, game_version(LAST_LEVEL_VERSION).data_version)


@cache
def game_versions() -> tuple[GameVersion, ...]:
    """Return the versions that all formats support (1.20 and later), oldest first."""
    return tuple(GameVersion(name, *numbers) for name, *numbers in _table()["versions"])


@cache
def old_versions() -> tuple[GameVersion, ...]:
    """Return the older versions (1.13 and later) that all formats but data packs support."""
    return tuple(GameVersion(name, *numbers) for name, *numbers in _table()["old_versions"])


def game_version(name: str = DEFAULT_VERSION) -> GameVersion:
    """Return a game version by name, such as ``1.20.1``.

    Raises:
        UnknownNameError: If the version is unknown. The message suggests the nearest name.
    """
    known = (*old_versions(), *game_versions())
    for version in known:
        if version.name == name:
            return version
    raise UnknownNameError("Minecraft version", name, [v.name for v in known])


def name_in_version(state_name: str, data_version: int) -> str:
    """Return the name of a block in a game version, given its name in 1.20.1.

    Example:
        >>> name_in_version("minecraft:grass", 3698)
        'minecraft:short_grass'
    """
    since, name = _renamed().get(state_name, (data_version + 1, state_name))
    return name if data_version >= since else state_name


@cache
def new_names() -> dict[str, str]:
    """Return the blocks renamed since 1.20.1, as a mapping from the newer to the older name."""
    return {new: old for old, (_, new) in _renamed().items()}


@cache
def _renamed() -> dict[str, tuple[int, str]]:
    return {old: (since, new) for since, old, new in _table()["renamed_blocks"]}


@cache
def _table() -> dict[str, Any]:
    return read_data("versions.json")
