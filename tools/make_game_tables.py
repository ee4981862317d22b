"""Make the tables of older games, from the npm package ``minecraft-data`` (MIT).

Run by hand when they should follow another version of the package::

    npm pack minecraft-data@3.117.0 && tar xzf minecraft-data-3.117.0.tgz
    python tools/make_game_tables.py package/minecraft-data/data

``blocks_since.json`` says which blocks came with which game after 1.13; ``legacy_blocks.json``
gives the state of each block number and data value that schematics had before 1.13.
"""

import argparse
import json
from pathlib import Path
from typing import Any

TARGET = Path(__file__).parents[1] / "src/world2minecraft/minecraft/data"
GAMES = ("1.13", "1.13.2", "1.14.4", "1.15.2", "1.16.1", "1.17", "1.19", "1.19.3", "1.19.4", "1.20")
# The data version of each of these games' first release.
FIRST = (1519, 1631, 1952, 2225, 2566, 2724, 3105, 3218, 3337, 3463)


def main() -> None:
    """Read the package and write the two tables."""
    parser = argparse.ArgumentParser(description="Make the tables of older games.")
    parser.add_argument("data", type=Path, help="the folder that holds dataPaths.json")
    data = parser.parse_args().data
    about = "blocks by the data version of the first game that has them; the others are of 1.13"
    _write("blocks_since.json", {"about": about, "since": since(data)})
    legacy = json.loads((data / "pc/common/legacy.json").read_text())["blocks"]
    about = "states by block number, at the place of their data value; null repeats the first"
    _write("legacy_blocks.json", {"about": about, "blocks": by_number(legacy)})


def since(data: Path) -> list[list[Any]]:
    """Return [data version, [names]] for each game that brought new blocks."""
    known: set[str] = set()
    result = []
    for game, version in zip(GAMES, FIRST, strict=True):
        blocks = json.loads((data / "pc" / game / "blocks.json").read_text())
        names = {block["name"] for block in blocks}
        if known and names - known:
            result.append([version, sorted(names - known)])
        known |= names
    return result


def by_number(legacy: dict[str, str]) -> dict[str, list[str | None]]:
    """Return the states of each block number by data value, without the namespace."""
    result: dict[str, list[str | None]] = {}
    for key, state in legacy.items():
        number, value = key.split(":")
        states = result.setdefault(number, [None] * 16)
        states[int(value)] = state.removeprefix("minecraft:")
    return {number: _shortened(states) for number, states in result.items()}


def _shortened(states: list[str | None]) -> list[str | None]:
    short = [states[0], *(None if state == states[0] else state for state in states[1:])]
    while short[-1] is None:
        short.pop()
    return short


def _write(name: str, table: dict[str, Any]) -> None:
    lines = json.dumps(table, separators=(",", ":")).replace('],"', '],\n"')
    (TARGET / name).write_text(lines.replace("]],[", "]],\n[") + "\n")


if __name__ == "__main__":
    main()
