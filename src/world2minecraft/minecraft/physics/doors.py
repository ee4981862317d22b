"""Doors and gates that a player opens on the way: shut ones count as open for walking.

Iron doors open only by a button or the like, so they stay as they are.
"""

from dataclasses import replace

from world2minecraft.core.types import BlockVolume

_OPENED = ("_door", "_fence_gate")
_LOCKED = ("minecraft:iron_door",)


def is_door(state: str) -> bool:
    """Whether a block state is a door or a gate, of any kind, open or shut."""
    return state.partition("[")[0].endswith(_OPENED)


def is_shut(state: str) -> bool:
    """Whether a block state is a door or gate that a player would open.

    Example:
        >>> is_shut("minecraft:oak_door[facing=west,half=lower,open=false]")
        True
    """
    locked = state.partition("[")[0] in _LOCKED
    return is_door(state) and not locked and "open=false" in state


def opened(state: str) -> str:
    """Return the state of the same door, open; other states come back as they are."""
    return state.replace("open=false", "open=true") if is_shut(state) else state


def doors_opened(volume: BlockVolume) -> BlockVolume:
    """Return the volume with all its doors and gates open; its cells are the same array."""
    return replace(volume, palette=tuple(opened(state) for state in volume.palette))
