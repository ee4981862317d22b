"""Stage 7: build blocks in the room's real colours from its structure, furniture and objects."""

from typing import TYPE_CHECKING, Any

from world2minecraft.construction.parameters import BuildParameters

if TYPE_CHECKING:
    from world2minecraft.construction.build_files import WORLD_NAME, write_build
    from world2minecraft.construction.door_leaves import with_hinges
    from world2minecraft.construction.spawn import Spawn, find_spawn
    from world2minecraft.construction.volume_builder import build_volume

__all__ = [
    "WORLD_NAME",
    "BuildParameters",
    "Spawn",
    "build_volume",
    "find_spawn",
    "with_hinges",
    "write_build",
]

_HOMES = {
    "WORLD_NAME": "build_files",
    "Spawn": "spawn",
    "build_volume": "volume_builder",
    "find_spawn": "spawn",
    "with_hinges": "door_leaves",
    "write_build": "build_files",
}


def __getattr__(name: str) -> Any:
    """Import the builder on first use, so that importing the parameters alone is fast."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module  # noqa: PLC0415

    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
