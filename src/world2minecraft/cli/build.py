"""``w2m build``: any occupancy file becomes a Minecraft world."""

from pathlib import Path
from typing import Annotated

import typer

EXAMPLES = """\
w2m build OUT --out second --blocks-per-metre 2     a finished run at another scale
w2m build room.npz --out world_of_room              an occupancy grid alone
w2m build labels.npy --out world_of_labels          an array of class ids [x, y, z]
"""


def run(
    source: Annotated[
        Path, typer.Argument(metavar="ROOM", help="A run's folder, room.npz, occ.json or .npy.")
    ],
    out: Annotated[Path, typer.Option("--out", help="The folder of the results.")],
    blocks_per_metre: Annotated[
        float, typer.Option("--blocks-per-metre", help="Scale: 1, 2, 4 or 12.5.")
    ] = 4.0,
    mc_version: Annotated[
        str, typer.Option("--mc-version", help="The game version to write for.")
    ] = "1.20.1",
    settings: Annotated[
        list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="Change any parameter.")
    ] = None,
) -> None:
    """Build a world from an occupancy grid.

    A run's folder is built from its objects and placements as they stand; from a grid alone the
    objects are found and matched first.

    Args:
        source: what to build.
        out: the folder to write.
        blocks_per_metre: the scale.
        mc_version: the game version.
        settings: further parameters.
    """
    from world2minecraft.cli.outcome import compiling_note, say_how_to_play
    from world2minecraft.cli.progress import shown
    from world2minecraft.parameters import Parameters, with_settings
    from world2minecraft.rebuild import rebuild

    chosen = with_settings(
        Parameters(blocks_per_metre=blocks_per_metre, mc_version=mc_version), settings or []
    )
    compiling_note()
    with shown() as progress:
        rebuild(source, out, chosen, progress)
    print()
    say_how_to_play(out / "build")
