"""``w2m vln build``: navigation questions of walks through scenes, with one command."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.navigation.data.set_building import BuildRule, BuiltSet

EXAMPLES = """\
w2m vln build OUT --out SET                                of one reconstruction
w2m vln build --rooms 3 --houses 1 --out SET               of scenes that it makes itself
w2m vln build --rooms 15 --houses 5 --paper-size --out SET 3,542 items, as the paper counts
w2m vln build OUT --stream tour.jsonl --out SET            of walks that were recorded there
w2m vln build runs/* houses/* --out SET --composition base
w2m vln build houses/* --out SET --trajectories 10 --moves rxr
"""

Scenes = Annotated[
    list[Path] | None, typer.Argument(help="Run folders, generated houses, worlds, schematics.")
]
Out = Annotated[Path, typer.Option("--out", help="The folder of the set.")]
Rooms = Annotated[
    int, typer.Option("--rooms", help="Generate, scan and reconstruct so many rooms first.", min=0)
]
Houses = Annotated[int, typer.Option("--houses", help="Generate so many houses first.", min=0)]
Streams = Annotated[
    list[Path] | None,
    typer.Option("--stream", help="A recorded walk: a tour file, or a folder of w2m vln run."),
]
At = Annotated[str, typer.Option("--at", help="What x, y, z of streams is: eye or feet.")]
Composition = Annotated[
    str,
    typer.Option("--composition", help="base (reconstructions), extend (all else), combined."),
]
Trajectories = Annotated[
    int | None, typer.Option("--trajectories", help="Of each scene; 30 of base, 110 of extend.")
]
Views = Annotated[int, typer.Option("--views", help="Next-View items of a trajectory.", min=0)]
PaperSize = Annotated[
    bool, typer.Option("--paper-size", help="No more items than the paper has, part by part.")
]
PaperSplit = Annotated[
    bool, typer.Option("--paper-split", help="Hold out walks, not scenes, as many as the paper.")
]
UnseenShare = Annotated[
    float, typer.Option("--unseen-share", help="Of the scenes of each kind.", min=0.0, max=1.0)
]
Annotations = Annotated[
    Path | None,
    typer.Option("--annotations", help="People's words: trajectory_id, instruction; CSV, JSONL."),
]
EveryKeyframe = Annotated[
    bool,
    typer.Option("--every-keyframe", help="Ask at every keyframe; then blind guesses win."),
]
Moves = Annotated[str, typer.Option("--moves", help="vlnce, rxr, block or macro.")]
Size = Annotated[str, typer.Option("--size", help="Of pictures, width x height.")]
Seed = Annotated[int, typer.Option("--seed", help="Another seed, another set.", min=0)]
Workers = Annotated[
    int | None, typer.Option("--workers", help="Processes; as many as cores if not said.", min=1)
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
) -> None:
    """Walk through scenes, tell each walk in English, and ask what is seen and done next.

    A scene is toured from thing to thing; each leg becomes moves that the game's physics can make.
    Scenes are split by their names: one in five of each kind is for scoring alone. Rooms and houses
    that it makes go to OUT/scenes; those that are there are taken as they are. The same words
    and seed give the same bytes, with any number of workers.

    Raises:
        UsageError: an option cannot be, or no scene gives an item. InputError: a scene cannot be
        read. OutputError: the folder cannot be written.
    """
    from world2minecraft.core.errors import UsageError
    from world2minecraft.navigation.data.recorded_walks import parse_at
    from world2minecraft.navigation.data.scene_items import SceneRule
    from world2minecraft.navigation.data.set_building import BuildRule

    work = SceneRule(
        views=views, move_set=_moves(moves), balanced=not every_keyframe, size_px=_size(size),
        seed=seed,
    )  # fmt: skip
    rule = BuildRule(
        composition, trajectories, paper_size, paper_split, unseen_share,
        tuple(map(str, stream or ())), parse_at(at), work,
    )  # fmt: skip
    if not (scenes or rooms or houses):
        raise UsageError("no scene is named; give paths of scenes, or --rooms 3 to make some")
    built = _build(out, list(scenes or []), (rooms, houses), rule, workers)
    if annotations is not None:
        from world2minecraft.navigation.data.rewording import annotate_set

        annotate_set(out, annotations)
    _print_summary(out, built)


def _build(
    out: Path, scenes: list[Path], made: tuple[int, int], rule: "BuildRule", workers: int | None
) -> "BuiltSet":
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.outcome import print_compile_note
    from world2minecraft.core.machine import usable_cores
    from world2minecraft.navigation.data.generated_scenes import make_scenes
    from world2minecraft.navigation.data.set_building import build_navigation_set
    from world2minecraft.navigation.records import SCENES_FOLDER
    from world2minecraft.reconstruction.run_folder import check_writable

    check_writable(out)
    print_compile_note()
    hands, seed = workers or usable_cores(), rule.work.seed
    with show_progress() as progress:
        places = scenes + make_scenes(out / SCENES_FOLDER, *made, seed, hands, progress)
        return build_navigation_set(places, out, rule, progress, hands)


def _moves(name: str) -> str:
    from world2minecraft.core.errors import UnknownNameError
    from world2minecraft.navigation.types import MOVE_SETS

    if name not in MOVE_SETS:
        raise UnknownNameError("set of moves", name, MOVE_SETS)
    return name


def _size(text: str) -> tuple[int, int]:
    from world2minecraft.core.errors import UsageError

    parts = text.lower().split("x")
    if len(parts) != 2 or not all(part.isdecimal() and 16 <= int(part) <= 4096 for part in parts):
        raise UsageError(f"--size is width x height, such as 640x360, not {text!r}")
    return int(parts[0]), int(parts[1])


def _print_summary(out: Path, built: "BuiltSet") -> None:
    walks = sum(len(work.trajectories) for work in built.works)
    refused = sum((sum(work.refused.values()) for work in built.works), 0)
    print(f"\n{len(built.items):,} items of {walks:,} walks in {len(built.works)} scenes.")
    print(f"  refused  {refused:,} walks: that met something, or showed too little")
    if built.left_out:
        print(f"  left     {len(built.left_out)} scenes are not of the composition")
    if not built.leaks.is_clean:
        shared = len(built.leaks.images)
        print(f"  LEAK     {shared} pictures of train are in what is scored on: see dataset.json")
    print(f"  next     w2m vln stats {out}      lengths, balance, and what blind guessing scores")
    print(f"  words    w2m vln reword {out} --annotations FILE, or --rewrite MODEL")
    print(f"  then     w2m vln export {out} --to llamafactory --out TRAIN")
