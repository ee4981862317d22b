"""``w2m dataset map``: the block maps, the classes of blocks, and the tables as JSON."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from collections.abc import Sequence

    from world2minecraft.api.dataset_contents import BlockMap

EXAMPLES = """\
w2m dataset map                                  the map nyu, class by class
w2m dataset map oak_planks tmeo_ultra:yigui_1x_2 the classes of these blocks
w2m dataset map --map paper --json paper.json    the paper's map, for other programs
w2m dataset map --map mine.yaml                  check your own map
"""
MAX_SHOWN = 9

Blocks = Annotated[
    list[str] | None,
    typer.Argument(
        metavar="[BLOCK]...", help="Blocks to look up, such as oak_planks.", show_default=False
    ),
]
MapName = Annotated[str, typer.Option("--map", help="nyu, paper, or a YAML file.")]
Json = Annotated[
    Path | None,
    typer.Option("--json", "--out", "-o", metavar="FILE", help="Write the whole map as JSON."),
]


def run(blocks: Blocks = None, block_map: MapName = "nyu", json_out: Json = None) -> None:
    """Show a block map: the classes of the blocks in worlds by other people.

    Some blocks have one class wherever they are. Others have the class of the first rule that
    holds where they stand: planks are floor, ceiling, wall or furniture. A file of your own may
    extend a map with `extends: nyu`.

    Args:
        blocks: blocks to look up; without any the map is shown.
        block_map: a map's name or file.
        json_out: where the map is written as JSON.

    Raises:
        UnknownNameError: there is no such map. InputError: the file is not a map.
        UsageError: a text is not a block state.
    """
    from world2minecraft.api import dataset_contents as contents

    rules = contents.open_block_map(block_map)
    found = contents.classes_of_blocks(blocks or [], rules)
    if json_out is not None:
        contents.save_block_map(rules, json_out)
        print(f"{json_out}: {rules.name}, every block of the game and {word_count(rules)} words")
    for state, classes in found.items():
        print(line_of(state, classes))
    if not found and json_out is None:
        for line in lines_of(rules):
            print(line)


def line_of(state: str, classes: "Sequence[str]") -> str:
    """Return the classes of a block in a line."""
    first, *others = classes
    if not others:
        return f"{state}  {first}"
    return f"{state}  by its place: {', '.join([first, *others])}"


def word_count(rules: "BlockMap") -> int:
    """Return how many words a map knows of names of mods."""
    return sum(len(words.meanings) for words in rules.words)


def lines_of(rules: "BlockMap") -> list[str]:
    """Return a map's name, the blocks of each class, and the kinds with their classes."""
    from world2minecraft.api.dataset_contents import blocks_by_meaning
    from world2minecraft.core.classes import CLASS_NAMES

    held = blocks_by_meaning(rules)
    lines = [f"{rules.name}: {' '.join(rules.about.split())}"]
    for name in dict.fromkeys((*CLASS_NAMES, *rules.kinds)):
        blocks = [block.removeprefix("minecraft:") for block in held.get(name, [])]
        if not blocks:
            continue
        more = f" and {len(blocks) - MAX_SHOWN} more" if len(blocks) > MAX_SHOWN else ""
        classes = dict.fromkeys(rule.class_name for rule in rules.rules_of(name))
        to = "" if name in CLASS_NAMES else f" -> {', '.join(classes)}"
        lines.append(f"  {name}{to}: {', '.join(blocks[:MAX_SHOWN])}{more}")
    lines.append(f"  and {word_count(rules)} words in names of mods; --json FILE writes all of it")
    return lines
