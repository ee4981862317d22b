"""``w2m dataset map``: the block maps, what a block stands for, and the tables as JSON."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.minecraftocc.block_map import BlockMap

EXAMPLES = """\
w2m dataset map                                  the map nyu, class by class
w2m dataset map oak_planks tmeo_ultra:yigui_1x_2 what these blocks stand for
w2m dataset map --map paper --json paper.json    the paper's map, for other programs
w2m dataset map --map mine.yaml                  check a map of your own
"""
MAX_SHOWN = 9

Blocks = Annotated[
    list[str] | None, typer.Argument(metavar="[BLOCK]...", help="Blocks, such as oak_planks.")
]
MapName = Annotated[str, typer.Option("--map", help="nyu, paper, or a YAML file of yours.")]
Json = Annotated[
    Path | None, typer.Option("--json", metavar="FILE", help="Write the whole map there.")
]


def run(blocks: Blocks = None, block_map: MapName = "nyu", json_out: Json = None) -> None:
    """Show a block map: what blocks of worlds by other people stand for.

    Some blocks are of one class wherever they are. Others are of the first class whose rule holds
    where they stand: planks are floor, ceiling, wall or furniture. A file of your own may begin
    from a map with `extends: nyu`.

    Args:
        blocks: blocks to look up; without any the map is shown.
        block_map: a map's name or file.
        json_out: where the map is written as JSON.

    Raises:
        UnknownNameError: there is no such map. InputError: the file is no map.
        UsageError: a block is no block state.
    """
    from world2minecraft.core.files import write_json
    from world2minecraft.minecraft.block_states import parse_state
    from world2minecraft.minecraftocc.block_map import block_map_json, load_block_map

    rules = load_block_map(block_map)
    states = [str(parse_state(block)) for block in blocks or []]
    if json_out is not None:
        write_json(json_out, block_map_json(rules))
        print(f"{json_out}: {rules.name}, every block of the game and {word_count(rules)} words")
    for state in states:
        print(line_of(state, rules))
    if not states and json_out is None:
        for line in lines_of(rules):
            print(line)


def line_of(state: str, rules: "BlockMap") -> str:
    """Return what a block stands for, in a line."""
    first, *others = rules.classes_of(state)
    if not others:
        return f"{state}  {first}"
    return f"{state}  by where it is: {', '.join([first, *others])}"


def word_count(rules: "BlockMap") -> int:
    """Return how many words a map knows of names of mods."""
    return sum(len(words.meanings) for words in rules.words)


def lines_of(rules: "BlockMap") -> list[str]:
    """Return a map's name, what each class is by name alone, and the kinds with their classes."""
    from world2minecraft.core.classes import CLASS_NAMES
    from world2minecraft.minecraft.block_states import known_blocks

    held: dict[str, list[str]] = {}
    for block in known_blocks():
        held.setdefault(rules.meaning(block), []).append(block.removeprefix("minecraft:"))
    lines = [f"{rules.name}: {' '.join(rules.about.split())}"]
    for name in dict.fromkeys((*CLASS_NAMES, *rules.kinds)):
        blocks = held.get(name, [])
        if not blocks:
            continue
        more = f" and {len(blocks) - MAX_SHOWN} more" if len(blocks) > MAX_SHOWN else ""
        told = dict.fromkeys(rule.class_name for rule in rules.rules_of(name))
        to = "" if name in CLASS_NAMES else f" -> {', '.join(told)}"
        lines.append(f"  {name}{to}: {', '.join(blocks[:MAX_SHOWN])}{more}")
    lines.append(f"  and {word_count(rules)} words in names of mods; --json FILE writes all of it")
    return lines
