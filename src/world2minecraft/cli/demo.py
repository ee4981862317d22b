"""Generate a furnished room, scan it virtually and rebuild it in Minecraft: ``w2m demo``."""

from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.cli.build.options import (
    Formats,
    PaletteName,
    Scale,
    Style,
    print_style_note,
    split_names,
)
from world2minecraft.cli.panels import Force, OutFolder, more_option

EXAMPLES = """\
w2m demo                      build a living room in OUT/
w2m demo --kind kitchen       build a kitchen
w2m demo --seed 7 -o other    build another living room in other/
"""
DEMO_SEED = 5
DEMO_FRAMES = 40


def run(
    out: OutFolder = Path("OUT"),
    kind: Annotated[
        str, typer.Option("--kind", help="Generate a living, bed, kitchen, dining or study room.")
    ] = "living",
    seed: Annotated[
        int, typer.Option("--seed", help="Choose another room of this kind.")
    ] = DEMO_SEED,
    frames: Annotated[
        int, more_option("--frames", help="Take this many frames in the virtual scan.")
    ] = DEMO_FRAMES,
    blocks_per_metre: Scale = 4.0,
    style: Style = None,
    palette: PaletteName = None,
    formats: Formats = None,
    force: Force = False,
) -> None:
    """Generate a room, scan it with a virtual depth camera and build it as a world.

    No download, camera or game is needed. The room's ground truth is known, so the report scores
    the result against it.

    Args:
        out: Output folder. The scan is written to its ``capture`` subfolder.
        kind: Room type.
        seed: Random seed of the room.
        frames: Number of frames of the virtual scan.
        blocks_per_metre: Scale of the world.
        style: Material of the furniture.
        palette: Palette of blocks to build with.
        formats: Additional file formats to write.
        force: Write into a folder that contains other files.
    """
    from world2minecraft.api import demo
    from world2minecraft.api.progress import show_progress
    from world2minecraft.api.time_left import DEMO
    from world2minecraft.cli.outcome import print_outcome
    from world2minecraft.core.precompile import compile_first

    print_style_note(blocks_per_metre, style)
    with show_progress(stages=DEMO) as shown:
        progress = compile_first(shown)
        made = demo(
            out,
            kind=kind,
            seed=seed,
            frames=frames,
            blocks_per_metre=blocks_per_metre,
            style=style,
            palette=palette,
            formats=split_names(formats),
            force=force,
            progress=progress,
        )
    print_outcome(out, made.report)
