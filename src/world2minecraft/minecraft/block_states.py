"""Block states as text and as Python values.

The canonical text includes the namespace and sorts the properties:
``minecraft:oak_stairs[facing=east,half=bottom,shape=straight,waterlogged=false]``.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.minecraft.block_table import block_table

AIRS = frozenset(("minecraft:air", "minecraft:cave_air", "minecraft:void_air"))
MAX_TEXT = 1000  # The longest state of the game has about 150 characters.
_NAME = re.compile(r"[a-z0-9_.-]+:[a-z0-9_./-]+")
_WORD = re.compile(r"[a-z0-9_]+")


@dataclass(frozen=True)
class BlockState:
    """A block name and its explicit properties, sorted by name.

    Example:
        >>> str(BlockState("oak_log", {"axis": "y"}))
        'minecraft:oak_log[axis=y]'
    """

    name: str
    properties: tuple[tuple[str, str], ...] = field(default=())

    def __init__(
        self, name: str, properties: Mapping[str, str] | tuple[tuple[str, str], ...] = ()
    ) -> None:
        pairs = tuple(sorted(dict(properties).items()))
        full = name if ":" in name else f"minecraft:{name}"
        if not _NAME.fullmatch(full):
            raise UsageError(
                f"block name {name!r} is invalid; expected a name such as minecraft:oak_log with "
                "lower-case letters, digits and _ . - /"
            )
        for key, value in pairs:
            if not (_WORD.fullmatch(key) and _WORD.fullmatch(value)):
                raise UsageError(
                    f"property {key}={value} of {full} is invalid; use lower-case letters, digits "
                    "and _"
                )
        object.__setattr__(self, "name", full)
        object.__setattr__(self, "properties", pairs)

    def __str__(self) -> str:
        if not self.properties:
            return self.name
        return f"{self.name}[{','.join(f'{key}={value}' for key, value in self.properties)}]"

    def get(self, key: str, default: str = "") -> str:
        """Return the value of a property, or ``default`` if the property is not set."""
        return dict(self.properties).get(key, default)

    def having(self, **changed: str) -> "BlockState":
        """Return a copy of the state with some properties changed or added."""
        return BlockState(self.name, {**dict(self.properties), **changed})


@lru_cache(maxsize=1 << 16)
def parse_state(text: str) -> BlockState:
    """Parse the text of a block state. The namespace ``minecraft:`` is optional.

    Raises:
        UsageError: If the text is not a valid block state or repeats a property.

    Example:
        >>> parse_state("oak_stairs[half=top,facing=east]").get("facing")
        'east'
    """
    name, bracket, rest = text.partition("[")
    if len(text) > MAX_TEXT or (bracket and not rest.endswith("]")):
        shown = text if len(text) <= 80 else text[:77] + "..."
        raise UsageError(
            f"block state {shown!r} is invalid; expected text such as minecraft:oak_log[axis=y]"
        )
    properties: dict[str, str] = {}
    for part in rest[:-1].split(",") if rest[:-1] else ():
        key, equals, value = part.partition("=")
        key, value = key.strip(), value.strip()
        if not equals or key in properties:
            raise UsageError(f"block state {text!r} has an invalid or repeated property {part!r}")
        properties[key] = value
    return BlockState(name, properties)


@lru_cache(maxsize=1 << 16)
def complete(state: BlockState) -> BlockState:
    """Add the default value of each property that a block state leaves out.

    A block that is not in the table (from a mod or a newer game) is returned unchanged. Properties
    that are not in the table are kept.
    """
    block = block_table().blocks.get(state.name)
    if block is None:
        return state
    return BlockState(state.name, {**block.values_at(block.default), **dict(state.properties)})


def check_state(state: BlockState) -> BlockState:
    """Return a block state after checking its block name, properties and property values.

    Raises:
        UnknownNameError: If a name or value does not exist. The message suggests the nearest one.
    """
    blocks = block_table().blocks
    if state.name not in blocks:
        near = [name for name in blocks if name.split("_")[-1] == state.name.split("_")[-1]]
        raise UnknownNameError("block", state.name, near or list(blocks))
    known = dict(blocks[state.name].properties)
    for key, value in state.properties:
        if key not in known:
            raise UnknownNameError(f"property of {state.name}", key, known)
        if value not in known[key]:
            raise UnknownNameError(f"{key} value of {state.name}", value, known[key])
    return state


def known_blocks() -> tuple[str, ...]:
    """Return the full names of all blocks in the table, sorted."""
    return tuple(block_table().blocks)


def states_of(name: str) -> list[BlockState]:
    """Return all states of a known block, in the game's order.

    Raises:
        UnknownNameError: If the block is not in the table.
    """
    full = check_state(BlockState(name)).name
    block = block_table().blocks[full]
    return [BlockState(full, block.values_at(index)) for index in range(block.state_count)]
