"""Make the block table that the program ships, from the npm package ``minecraft-data`` (MIT).

Run by hand when the table should follow another version of the game::

    npm pack minecraft-data@3.117.0 && tar xzf minecraft-data-3.117.0.tgz
    python tools/make_block_table.py package/minecraft-data/data 1.20.1

It keeps names, properties, default states and collision boxes, and nothing else.
"""

import argparse
import gzip
import json
from pathlib import Path
from typing import Any

TARGET = Path(__file__).parents[1] / "src/world2minecraft/minecraft/data/blocks.json.gz"


def main() -> None:
    """Read the package's two files for one version and write the table."""
    parser = argparse.ArgumentParser(description="Make the block table from minecraft-data.")
    parser.add_argument("data", type=Path, help="the folder that holds dataPaths.json")
    parser.add_argument("version", help="the version of the game, such as 1.20.1")
    arguments = parser.parse_args()
    paths = json.loads((arguments.data / "dataPaths.json").read_text())["pc"][arguments.version]
    blocks = json.loads((arguments.data / paths["blocks"] / "blocks.json").read_text())
    shapes_folder = arguments.data / paths["blockCollisionShapes"]
    shapes = json.loads((shapes_folder / "blockCollisionShapes.json").read_text())
    text = json.dumps(table_of(arguments.version, blocks, shapes), separators=(",", ":"))
    TARGET.write_bytes(gzip.compress(text.encode(), compresslevel=9, mtime=0))


def table_of(version: str, blocks: list[Any], shapes: dict[str, Any]) -> dict[str, Any]:
    """Return the table as ``minecraft.block_table`` reads it.

    ``blocks`` maps a name to its properties (indices into ``properties``), the index of its
    default state and one shape index a state, or a single one where all states share it.
    """
    properties: list[list[Any]] = []
    numbers: dict[str, int] = {}
    boxes: list[list[float]] = []
    result = {}
    for block in sorted(blocks, key=lambda block: block["name"]):
        states = [_property(state) for state in block["states"]]
        for state in states:
            if state not in properties:
                properties.append(state)
        held = shapes["blocks"][block["name"]]
        indices = [
            _shape_index(shapes["shapes"][str(shape)], numbers, boxes)
            for shape in (held if isinstance(held, list) else [held])
        ]
        result[block["name"]] = [
            [properties.index(state) for state in states],
            block["defaultState"] - block["minStateId"],
            indices if len(set(indices)) > 1 else indices[0],
        ]
    return {"version": version, "properties": properties, "blocks": result, "shapes": boxes}


def _property(state: dict[str, Any]) -> list[Any]:
    """A boolean has no values of its own; its first is true."""
    values = state.get("values") or ["true", "false"]
    if len(values) != state["num_values"]:
        raise SystemExit(f"property {state['name']} has {len(values)} values, not num_values")
    return [state["name"], values]


def _shape_index(shape: list[Any], numbers: dict[str, int], boxes: list[list[float]]) -> int:
    flat = [round(float(value), 6) for box in shape for value in box]
    flat = [int(value) if value == int(value) else value for value in flat]
    key = repr(flat)
    if key not in numbers:
        numbers[key] = len(boxes)
        boxes.append(flat)
    return numbers[key]


if __name__ == "__main__":
    main()
