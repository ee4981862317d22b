"""Conversion between Java and Bedrock block states, with a table of all blocks of Java 1.20.1.

``tools/make_bedrock_table.py`` builds the table from the public package ``minecraft-data``; see the
notice in the data folder. States are written in the form of Bedrock 1.20.0, which every later game
upgrades. States of Bedrock 1.17 to 1.26 can be read.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import Any

from world2minecraft.minecraft.block_states import AIRS, BlockState, complete, parse_state
from world2minecraft.minecraft.block_table import block_table
from world2minecraft.minecraft.data_files import read_data
from world2minecraft.minecraft.nbt import Byte


@dataclass(frozen=True)
class BedrockTable:
    """The stored table of Bedrock and Java block states."""

    version: int  # The version number in each palette entry.
    states: tuple[str, ...]
    written: Mapping[str, Any]  # Java name to a Bedrock state index, or one index per Java state.
    read: Mapping[str, Any]  # Bedrock key to Java name and state index.


@cache
def bedrock_table() -> BedrockTable:
    """Load the bundled table of Bedrock states. The result is cached."""
    raw = read_data("bedrock_states.json.gz")
    return BedrockTable(raw["version"], tuple(raw["states"]), raw["written"], raw["read"])


@lru_cache(maxsize=1 << 16)
def java_to_bedrock(state: str) -> tuple[str, dict[str, Any]] | None:
    """Convert a Java block state to a Bedrock block name and its states.

    Returns None if Bedrock Edition has no such block.

    Example:
        >>> java_to_bedrock("minecraft:oak_planks")
        ('minecraft:planks', {'wood_type': 'oak'})
    """
    parsed = parse_state(state)
    namespace, _, name = parsed.name.partition(":")
    written = bedrock_table().written.get(name) if namespace == "minecraft" else None
    if written is None:
        return None
    if not isinstance(written, int):
        block = block_table().blocks[parsed.name]
        written = written[block.index_of(dict(parsed.properties))]
    bedrock, _, rest = bedrock_table().states[written][:-1].partition("[")
    pairs = (pair.partition("=") for pair in rest.split(",") if pair)
    return bedrock, {key: _value(text) for key, _, text in pairs}


def bedrock_to_java(name: str, states: Mapping[str, Any]) -> str | None:
    """Convert a Bedrock block to a Java state, or return None if the table does not have it.

    Properties that Bedrock computes from neighbouring blocks, such as the shape of stairs, are set
    to their defaults. Colours that Bedrock stores in block entities are set to the first colour.

    Example:
        >>> bedrock_to_java('minecraft:planks', {'wood_type': 'oak'})
        'minecraft:oak_planks'
    """
    pairs = sorted((key, str(int(v) if isinstance(v, int) else v)) for key, v in states.items())
    found = bedrock_table().read.get(f"{name}[{','.join(f'{k}={v}' for k, v in pairs)}]")
    if found is None:
        return None
    block = block_table().blocks[f"minecraft:{found[0]}"]
    return str(BlockState(block.name, block.values_at(found[1])))


def changed_properties(state: str, back: str) -> tuple[str, ...]:
    """Return the properties in which a Java state differs from what its Bedrock state becomes.

    If the block differs, the result is ``blocks``. What the game computes again as time passes is
    ignored: the distance of leaves, snow on grass and whether somebody lies in a bed.

    Example:
        >>> changed_properties("minecraft:oak_button[face=floor,facing=east]",
        ...                    "minecraft:oak_button[face=floor,facing=north]")
        ('facing',)
    """
    before, after = complete(parse_state(state)), complete(parse_state(back))
    if before.name != after.name:
        return () if {before.name, after.name} <= AIRS else ("blocks",)
    theirs = dict(after.properties)
    changed = (key for key, value in before.properties if theirs.get(key) != value)
    return tuple(key for key in changed if key not in ("distance", "occupied", "snowy"))


def _value(text: str) -> Any:
    if text in ("true", "false"):
        return Byte(text == "true")
    return int(text) if text.lstrip("-").isdecimal() else text
