"""``w2m evaluate scannet``: a ScanNet scene's labelled mesh becomes a truth to score runs by."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.evaluation.scoring.scannet import TruthMade

EXAMPLES = """\
w2m evaluate scannet scans/scene0000_00                  beside the scene's own files
w2m evaluate scannet scans/scene0000_00 --out truth      elsewhere; the scene is left as it is
w2m evaluate scannet scans --out truths                  of each scene in a folder
w2m reconstruct scans/scene0000_00 --out OUT             then the scene is reconstructed,
w2m evaluate reconstruction OUT truth                    and scored
"""


def run(
    scene: Annotated[
        Path, typer.Argument(help="A scene of ScanNet's train or val split, or a folder of them.")
    ],
    out: Annotated[
        Path | None, typer.Option("--out", help="Where to write; else into the scene's folder.")
    ] = None,
) -> None:
    """Make a truth of a ScanNet scene, so that reconstructions of it can be scored.

    A scene is a folder with SCENE.sens (or exported color/ depth/ pose/ intrinsic/), SCENE.txt with
    its axisAlignment, SCENE_vh_clean_2.labels.ply, SCENE_vh_clean_2.0.010000.segs.json and
    SCENE.aggregation.json. Of all that, the truth knows surfaces and what cameras saw through;
    what lies behind surfaces, and the fronts of chairs, it does not know and does not ask for.
    """
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.outcome import print_compile_note
    from world2minecraft.evaluation.scoring.scannet import scenes_in, write_scannet_truth

    scenes = scenes_in(scene)
    print_compile_note()
    for one in scenes:
        with show_progress() as progress:
            made = write_scannet_truth(one, output_folder(one, scene, out), progress)
        print(summary_line(made))
    place = output_folder(scenes[0], scene, out) or scenes[0]
    print(f"next: w2m reconstruct {scenes[0]} --out OUT")
    print(f"then: w2m evaluate reconstruction OUT {place}")


def output_folder(one: Path, asked: Path, out: Path | None) -> Path | None:
    """Return where the truth of a scene goes: of one that was named ``out``, else a folder in it.

    None is the scene's own folder.
    """
    return out if out is None or one == asked else out / one.name


def summary_line(made: "TruthMade") -> str:
    """Return the line that tells what a truth holds."""
    sides = " x ".join(f"{side:.1f}" for side in made.size_m)
    return (
        f"{made.name}: {sides} m, {made.objects} objects, {made.surface:,} surface voxels of 2 cm, "
        f"{100 * made.annotated_share:.0f} % of them annotated, {made.free:,} seen to be free"
    )
