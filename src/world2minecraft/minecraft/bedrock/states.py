"""Convert Java block states to Bedrock's and back, by one table of all blocks of Java 1.20.1.

The table is made by ``tools/make_bedrock_table.py`` from the public package ``minecraft-data``; see
its notice beside it. States are written as Bedrock 1.20.0 has them, which every later game
upgrades, and read as any Bedrock from 1.17 to 1.26 has them.
"""

import gzip
import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, lru_cache
from importlib.resources import files
from typing import Any

from world2minecraft.minecraft.block_states import BlockState, complete, parse_state
from world2minecraft.minecraft.block_table import block_table
from world2minecraft.minecraft.nbt import Byte

TABLE_FILE = "data/bedrock_states.json.gz"


@dataclass(frozen=True)
class BedrockTable:
    """The table as stored; see the tool that makes it."""

    version: int  # what entries of a palette carry
    states: tuple[str, ...]
    written: Mapping[str, Any]  # Java name to the number of a Bedrock state, or one a state
    read: Mapping[str, Any]  # Bedrock key to Java name and number of its state


@cache
def bedrock_table() -> BedrockTable:
    """Read the shipped table, once."""
    packed = files("world2minecraft.minecraft").joinpath(TABLE_FILE).read_bytes()
    raw = json.loads(gzip.decompress(packed))
    return BedrockTable(raw["version"], tuple(raw["states"]), raw["written"], raw["read"])


@lru_cache(maxsize=1 << 16)
def java_to_bedrock(state: str) -> tuple[str, dict[str, Any]] | None:
    """Return the Bedrock block and its states that a Java state becomes; None where none does.

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
    """Return the Java state that a Bedrock block comes back as; None where the table has none.

    What Bedrock computes from neighbours (the shape of stairs, the sides of panes) comes back at
    its default, and colours that it keeps in block entities come back as the first of them.

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


def is_preserved(state: str, back: str) -> bool:
    """Whether a Java state that came back from Bedrock is the same but for what games compute."""
    before, after = complete(parse_state(state)), complete(parse_state(back))
    if before.name != after.name:
        return False
    ours, theirs = dict(before.properties), dict(after.properties)
    changed = {key for key in ours if ours[key] != theirs.get(key)}
    return changed <= _computed(before.name)


def _computed(name: str) -> set[str]:
    """Return the properties of a block that the game works out from its neighbours."""
    sides = {"north", "east", "south", "west"}
    if name.endswith("_stairs"):
        return {"shape", "waterlogged"}
    if name.endswith(("_pane", "_bars", "_fence")):
        return sides | {"waterlogged"}
    return {"waterlogged", "distance", "snowy", "occupied"}


def _value(text: str) -> Any:
    if text in ("true", "false"):
        return Byte(text == "true")
    return int(text) if text.lstrip("-").isdecimal() else text
