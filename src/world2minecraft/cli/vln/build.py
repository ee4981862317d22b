"""Build a navigation set from walks through scenes: ``w2m vln build``."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli.panels import MORE, Force

if TYPE_CHECKING:
    from world2minecraft.api.navigation import BuiltSet

EXAMPLES = """\
w2m vln build OUT -o SET                                   from one reconstruction
w2m vln build --rooms 3 --houses 1 -o SET                  from newly generated scenes
w2m vln build --rooms 15 --houses 5 --paper-size -o SET    3,542 items, as in the paper
w2m vln build OUT --stream tour.jsonl -o SET               from recorded walks
w2m vln build runs/* houses/* -o SET --composition base
w2m vln build houses/* -o SET --trajectories 10 --moves rxr
"""

Scenes = Annotated[
    list[Path] | None, typer.Argument(help="Runs, generated houses, worlds, schematics.")
]
Out = Annotated[Path, typer.Option("--out", "-o", help="Output folder of the navigation set.")]
Rooms = Annotated[
    int,
    typer.Option("--rooms", help="Generate, scan and reconstruct this many rooms first.", min=0),
]
Houses = Annotated[int, typer.Option("--houses", help="Generate this many houses first.", min=0)]
Streams = Annotated[
    list[Path] | None,
    typer.Option("--stream", help="Recorded walk: a tour file, or a folder from w2m vln run."),
]
At = Annotated[
    str,
    typer.Option(
        "--at", help="Reference point of stream positions: eye or feet.", rich_help_panel=MORE
    ),
]
Composition = Annotated[
    str,
    typer.Option(
        "--composition", help="base (reconstructions), extend (other scenes) or combined."
    ),
]
Trajectories = Annotated[
    int | None,
    typer.Option(
        "--trajectories", help="Number of walks per scene.", show_default="base 30, extend 110"
    ),
]
Views = Annotated[
    int,
    typer.Option(
        "--views", help="Number of Next-View items per walk.", min=0, rich_help_panel=MORE
    ),
]
PaperSize = Annotated[
    bool, typer.Option("--paper-size", help="Limit each part to the paper's number of items.")
]
PaperSplit = Annotated[
    bool,
    typer.Option("--paper-split", help="Hold out as many walks as the paper, instead of scenes."),
]
UnseenShare = Annotated[
    float,
    typer.Option(
        "--unseen-share",
        help="Fraction of scenes of each kind to hold out.",
        min=0.0,
        max=1.0,
        rich_help_panel=MORE,
    ),
]
Annotations = Annotated[
    Path | None,
    typer.Option(
        "--annotations",
        help="Human instructions: CSV or JSONL with trajectory_id, instruction.",
    ),
]
EveryKeyframe = Annotated[
    bool,
    typer.Option(
        "--every-keyframe",
        help="Create items at every keyframe; blind baselines then score high.",
        rich_help_panel=MORE,
    ),
]
Moves = Annotated[str, typer.Option("--moves", help="Move set: vlnce, rxr, block or macro.")]
Size = Annotated[
    str,
    typer.Option(
        "--size", metavar="WIDTHxHEIGHT", help="Image size in pixels.", rich_help_panel=MORE
    ),
]
Seed = Annotated[int, typer.Option("--seed", help="Random seed.", min=0)]
Workers = Annotated[
    int | None,
    typer.Option("--workers", help="Number of processes.", min=1, show_default="one per core"),
]


def run(
    out: Out,
    scenes: Scenes = None,
    rooms: Rooms = 0,
    houses: Houses = 0,
    stream: Streams = None,
    at: At = "eye",
    composition: Composition = "combined",
    trajectories: Trajectories = None,
    views: Views = 3,
    paper_size: PaperSize = False,
    paper_split: PaperSplit = False,
    unseen_share: UnseenShare = 0.2,
    annotations: Annotations = None,
    every_keyframe: EveryKeyframe = False,
    moves: Moves = "vlnce",
    size: Size = "640x360",
    seed: Seed = 0,
    workers: Workers = None,
    force: Force = False,
) -> None:
    """Generate walks through scenes, instructions in English, and items about views and actions.

    Each scene is toured from object to object, and each leg is converted to moves that the game's
    physics allow. Scenes are split by name, and one in five of each kind is held out. Generated
    rooms and houses are stored in OUT/scenes and reused. The same arguments and seed produce
    identical files with any number of workers.

    Raises:
        UsageError: If an option is invalid or no scene results in an item.
        InputError: If a scene cannot be read.
        OutputError: If the folder cannot be written.
    """
    from world2minecraft.api import build_navigation_set
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.arguments import parse_size
    from world2minecraft.core.precompile import compile_first

    with show_progress() as progress:
        built = build_navigation_set(
            list(scenes or []),
            out,
            rooms=rooms,
            houses=houses,
            streams=stream or (),
            at=at,
            composition=composition,
            trajectories=trajectories,
            views=views,
            paper_size=paper_size,
            paper_split=paper_split,
            unseen_share=unseen_share,
            annotations=annotations,
            every_keyframe=every_keyframe,
            moves=moves,
            size=parse_size(size, example="640x360"),
            seed=seed,
            workers=workers,
            force=force,
            progress=compile_first(progress, "navigation"),
        )
    _print_summary(out, built)


def _print_summary(out: Path, built: "BuiltSet") -> None:
    walks = sum(len(work.trajectories) for work in built.works)
    refused = sum((sum(work.refused.values()) for work in built.works), 0)
    scenes = f"{len(built.works)} scene{'s' if len(built.works) != 1 else ''}"
    print(f"\n{len(built.items):,} items of {walks:,} walks in {scenes}.")
    print(f"  rejected {refused:,} walks that collided or showed too little")
    if built.left_out:
        print(f"  skipped  {len(built.left_out)} scenes outside the composition")
    if not built.leaks.is_clean:
        shared = len(built.leaks.images)
        print(f"  LEAK     {shared} training images are in held-out splits; see dataset.json")
    print(f"  next     w2m vln stats {out}      lengths, balance and baseline scores")
    print(f"  words    w2m vln reword {out} --annotations FILE, or --rewrite MODEL")
    print(f"  then     w2m vln export {out} --to llamafactory --out TRAIN")
