"""Show the classes of blocks, and export block maps as JSON: ``w2m dataset map``."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from collections.abc import Sequence

    from world2minecraft.api.dataset_contents import BlockMap

EXAMPLES = """\
w2m dataset map                                  show the map nyu, class by class
w2m dataset map oak_planks tmeo_ultra:yigui_1x_2 the classes of these blocks
w2m dataset map --map paper --json paper.json    export the paper's map
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
    """Show a block map, which assigns classes to the blocks of worlds without labels.

    Some blocks always have the same class. The class of other blocks is set by the first matching
    rule for their surroundings: planks are floor, ceiling, wall or furniture. A YAML file of your
    own can extend a map with `extends: nyu`.

    Args:
        blocks: Blocks to look up. Without any, the map is shown.
        block_map: Name or file of a map.
        json_out: JSON file to write the map to.

    Raises:
        UnknownNameError: If the map is unknown.
        InputError: If the file is not a valid map.
        UsageError: If a block is not a valid block state.
    """
    from world2minecraft.api import dataset_contents as contents

    rules = contents.open_block_map(block_map)
    found = contents.classes_of_blocks(blocks or [], rules)
    if json_out is not None:
        contents.save_block_map(rules, json_out)
        print(f"{json_out}: {rules.name}, all vanilla blocks, {word_count(rules)} mod words")
    for state, classes in found.items():
        print(line_of(state, classes))
    if not found and json_out is None:
        for line in lines_of(rules):
            print(line)


def line_of(state: str, classes: "Sequence[str]") -> str:
    """Return a line of text with the possible classes of a block."""
    first, *others = classes
    if not others:
        return f"{state}  {first}"
    return f"{state}  depends on surroundings: {', '.join([first, *others])}"


def word_count(rules: "BlockMap") -> int:
    """Return the number of words for mod block names in a map."""
    return sum(len(words.meanings) for words in rules.words)


def lines_of(rules: "BlockMap") -> list[str]:
    """Return the name of a map, the blocks of each class, and the classes of block kinds."""
    from world2minecraft.api.dataset_contents import blocks_by_meaning
    from world2minecraft.core.classes import CLASS_NAMES, class_id, display_name

    held = blocks_by_meaning(rules)
    lines = [f"{rules.name}: {' '.join(rules.about.split())}"]
    for name in dict.fromkeys((*CLASS_NAMES, *rules.kinds)):
        blocks = [block.removeprefix("minecraft:") for block in held.get(name, [])]
        if not blocks:
            continue
        more = f" and {len(blocks) - MAX_SHOWN} more" if len(blocks) > MAX_SHOWN else ""
        classes = dict.fromkeys(rule.class_name for rule in rules.rules_of(name))
        if name in CLASS_NAMES:
            shown = display_name(class_id(name))
            to = "" if shown == name else f" ({name})"
        else:
            shown, to = name, f" -> {', '.join(display_name(class_id(one)) for one in classes)}"
        lines.append(f"  {shown}{to}: {', '.join(blocks[:MAX_SHOWN])}{more}")
    lines.append(
        f"  and {word_count(rules)} words for mod blocks; --json FILE writes the whole map"
    )
    return lines
