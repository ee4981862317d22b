"""Make the table of Bedrock block states, from the npm package ``minecraft-data`` (MIT).

Run by hand when the table should follow other versions of the game::

    npm pack minecraft-data@3.117.0 && tar xzf minecraft-data-3.117.0.tgz
    python tools/make_bedrock_table.py package/minecraft-data/data/bedrock 1.20.0

``states`` are the texts of the Bedrock states that some Java state becomes, bytes as true or false;
``written`` maps each Java block to their indices, one a state in the game's order, or one for all;
``read`` maps every Bedrock state known in any version, bytes as 0 or 1, to the Java block and
state that it comes back as: of several the driest and plainest.
"""

import argparse
import gzip
import json
import re
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import UsageError
from world2minecraft.minecraft.block_states import parse_state
from world2minecraft.minecraft.block_table import BlockType, block_table

ROOT = Path(__file__).parents[1] / "src/world2minecraft/minecraft/data"
TARGET = ROOT / "bedrock_states.json.gz"
RENAMED = {"minecraft:short_grass": "minecraft:grass"}  # What 1.20.1 calls them.


def main() -> None:
    """Read the mappings of all versions and write the table."""
    parser = argparse.ArgumentParser(description="Make the Bedrock table from minecraft-data.")
    parser.add_argument("data", type=Path, help="the folder bedrock of the package's data")
    parser.add_argument("version", help="the Bedrock version that is written, such as 1.20.0")
    arguments = parser.parse_args()
    folders = sorted(arguments.data.glob("*/blocksJ2B.json"), key=lambda p: _numbers(p.parent.name))
    wanted = _numbers(arguments.version)
    newer = [path.parent for path in folders if _numbers(path.parent.name) >= wanted]
    older = [path.parent for path in folders if _numbers(path.parent.name) < wanted]
    table = written_table(newer[0])
    table["read"] = read_table([*newer, *reversed(older)])
    text = json.dumps(table, separators=(",", ":"))
    TARGET.write_bytes(gzip.compress(text.encode(), compresslevel=9, mtime=0))


def written_table(folder: Path) -> dict[str, Any]:
    """Return version, states and written of one version of Bedrock."""
    mapping = json.loads((folder / "blocksJ2B.json").read_text())
    versions = {row["version"] for row in json.loads((folder / "blockStates.json").read_text())}
    states: dict[str, int] = {}
    written: dict[str, Any] = {}
    for name, block in block_table().blocks.items():
        indices = []
        for number in range(block.state_count):
            text = mapping[_java_key(block, number)]
            indices.append(states.setdefault(text, len(states)))
        written[name.partition(":")[2]] = indices if len(set(indices)) > 1 else indices[0]
    return {"version": max(versions), "states": list(states), "written": written}


def read_table(folders: list[Path]) -> dict[str, list[Any]]:
    """Return the Java block and state of each Bedrock state; the first folders win."""
    found: dict[str, list[Any]] = {}
    for folder in folders:
        best: dict[str, tuple[tuple[int, ...], str, int]] = {}
        for java, bedrock in json.loads((folder / "blocksJ2B.json").read_text()).items():
            placed = _place(java)
            if placed is not None:
                block, number = placed
                key, rank = _as_numbers(bedrock), _rank(block, number)
                if key not in best or rank < best[key][0]:
                    best[key] = (rank, block.name, number)
        for key, (_, name, number) in best.items():
            found.setdefault(key, [name.partition(":")[2], number])
    for folder in folders:
        for bedrock, java in json.loads((folder / "blocksB2J.json").read_text()).items():
            placed = _place(java)
            if placed is not None:
                name = placed[0].name.partition(":")[2]
                found.setdefault(_as_numbers(bedrock), [name, placed[1]])
    return found


def _java_key(block: BlockType, number: int) -> str:
    """Return the key of a Java state: sorted properties, in brackets even if there are none."""
    pairs = sorted(block.values_at(number).items())
    return f"{block.name}[{','.join(f'{key}={value}' for key, value in pairs)}]"


def _place(java: str) -> tuple[BlockType, int] | None:
    """Return the block and the state's index of a text; None where the table has no such block."""
    try:
        state = parse_state(java.removesuffix("[]"))
    except UsageError:
        return None
    block = block_table().blocks.get(RENAMED.get(state.name, state.name))
    return None if block is None else (block, block.index_of(dict(state.properties)))


def _rank(block: BlockType, number: int) -> tuple[int, ...]:
    """Dry before wet, then as many properties as possible at their defaults."""
    values, plain = block.values_at(number), block.values_at(block.default)
    changed = sum(values[key] != plain[key] for key in values)
    return (values.get("waterlogged") == "true", changed, number)


def _as_numbers(bedrock: str) -> str:
    return re.sub(r"=false\b", "=0", re.sub(r"=true\b", "=1", bedrock))


def _numbers(version: str) -> tuple[int, ...]:
    return tuple(map(int, version.split(".")))


if __name__ == "__main__":
    main()
