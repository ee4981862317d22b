"""Generate a furnished room, scan it virtually and rebuild it in Minecraft: ``w2m demo``."""

from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.cli.build.options import (
    Formats,
    PaletteName,
    Scale,
    Style,
    style_note,
    with_build_options,
)
from world2minecraft.cli.panels import OutFolder, more_option

EXAMPLES = """\
w2m demo                      build a living room in OUT/
w2m demo --kind kitchen       build a kitchen
w2m demo --seed 7 -o other    build another living room in other/
"""
DEMO_SEED = 5
DEMO_FRAMES = 40
MIN_FRAMES = 3  # With fewer, how well the poses fit cannot be measured.


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
) -> None:
    """Generate a room, scan it with a virtual depth camera and build it as a world.

    No download, camera or game is needed. The room's ground truth is known, so the report scores
    the result against it.

    Args:
        out: the folder to write; the scan is written to its folder ``capture``.
        kind: the kind of room.
        seed: the room's seed.
        frames: the number of frames of the virtual camera.
        blocks_per_metre: the scale.
        style: what furniture is made of.
        palette: the blocks that may be used.
        formats: further file formats of the build.
    """
    from world2minecraft.cli.outcome import print_compile_note, print_outcome
    from world2minecraft.cli.progress import show_progress
    from world2minecraft.cli.time_left import DEMO
    from world2minecraft.construction import BuildParameters
    from world2minecraft.procgen import generate_room, scan_room
    from world2minecraft.reconstruction.parameters import Parameters
    from world2minecraft.reconstruction.run_folder import check_writable
    from world2minecraft.runs import run_capture

    check_figures(seed, frames)
    plaque = BuildParameters(plaque=f"A {kind} room")
    chosen = Parameters(blocks_per_metre=blocks_per_metre, build=plaque)
    chosen = with_build_options(chosen, style, palette, formats)
    check_writable(out)
    style_note(chosen)
    print_compile_note()
    with show_progress(stages=DEMO) as progress:
        progress("room", 0, 1)
        room = generate_room(seed, kind=kind)
        progress("room", 1, 1, f"a {kind} room, seed {seed}")
        scan_room(room, out / "capture", frames=frames, seed=seed, progress=progress)
        facts = run_capture(out / "capture", out, chosen, progress=progress)
    print_outcome(out, facts)


def check_figures(seed: int, frames: int) -> None:
    """Raise UsageError for a seed or a number of frames that is out of range."""
    from world2minecraft.core.errors import UsageError

    if seed < 0:
        raise UsageError(f"--seed must be 0 or more, not {seed}")
    if frames < MIN_FRAMES:
        raise UsageError(f"--frames must be {MIN_FRAMES} or more, not {frames}; 40 are usual")
