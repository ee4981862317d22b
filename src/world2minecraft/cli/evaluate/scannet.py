"""Create ground truth from ScanNet scenes to score runs: ``w2m evaluate scannet``."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.api.comparison import TruthMade

EXAMPLES = """\
w2m evaluate scannet scans/scene0000_00                  write to the scene folder
w2m evaluate scannet scans/scene0000_00 -o truth         write to another folder
w2m evaluate scannet scans -o truths                     process all scenes in a folder
w2m reconstruct scans/scene0000_00 --out OUT             reconstruct the scene,
w2m evaluate reconstruction OUT truth                    and score it
"""


def run(
    scene: Annotated[
        Path, typer.Argument(help="Scene of ScanNet's train or val split, or a folder of scenes.")
    ],
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Write to this folder.", show_default="the scene folder"),
    ] = None,
) -> None:
    """Create ground truth from a ScanNet scene so that reconstructions of it can be scored.

    A scene is a folder with SCENE.sens (or exported color/ depth/ pose/ intrinsic/), SCENE.txt with
    its axisAlignment, SCENE_vh_clean_2.labels.ply, SCENE_vh_clean_2.0.010000.segs.json and
    SCENE.aggregation.json. The ground truth contains the surfaces and the free space observed by
    cameras. Space behind surfaces and the orientation of chairs are unknown and are not scored.
    """
    from world2minecraft.api.comparison import scannet_truths
    from world2minecraft.api.progress import show_progress
    from world2minecraft.core.precompile import compile_first

    with show_progress() as progress:
        made = scannet_truths(scene, out, progress=compile_first(progress))
    for one in made:
        print(summary_line(one.made))
    print(f"next: w2m reconstruct {made[0].scene} --out OUT")
    print(f"then: w2m evaluate reconstruction OUT {made[0].folder}")


def summary_line(made: "TruthMade") -> str:
    """Return a one-line summary of a ground truth."""
    sides = " x ".join(f"{side:.1f}" for side in made.size_m)
    return (
        f"{made.name}: {sides} m, {made.objects} objects, {made.surface:,} surface voxels of 2 cm, "
        f"{100 * made.annotated_share:.0f} % of them annotated, {made.free:,} free voxels"
    )
