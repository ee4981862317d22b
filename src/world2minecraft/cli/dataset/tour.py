"""``w2m dataset tour``: which pictures of a world are taken, as a file of poses."""

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli.dataset.options import (
    At,
    BlockMap,
    CameraName,
    Fov,
    Scale,
    Seed,
    Size,
    check_seed,
    parse_at,
    parse_camera,
)

if TYPE_CHECKING:
    from world2minecraft.minecraftocc.scene_sources import SceneSource
    from world2minecraft.minecraftocc.tours import PlannedView

EXAMPLES = """\
w2m dataset tour WORLDS/house_0001                        100 views, to tour.jsonl
w2m dataset tour WORLDS/house_0001 --count 640 --seed 2 --out more.jsonl
w2m dataset tour house.schem --blocks-per-metre 1 --camera paper
w2m dataset tour OUT --reachable                          only where the player can walk to
w2m dataset tour WORLD --screenshots FOLDER --at feet     poses of real screenshots
w2m dataset tour WORLD --screenshots FOLDER --at feet --pattern "{x}_{y}_{z}_{yaw}_{pitch}"
"""
GAME_FOV_DEG = 70.0

World = Annotated[
    Path, typer.Argument(metavar="WORLD", help="A world, a run's folder, or a file of blocks.")
]
Count = Annotated[int, typer.Option("--count", metavar="N", help="How many views.")]
Out = Annotated[Path, typer.Option("--out", "-o", metavar="FILE", help="The tour file, JSONL.")]
Reachable = Annotated[
    bool, typer.Option("--reachable", help="Leave out rooms that no way from the spawn leads to.")
]
Shots = Annotated[
    Path | None,
    typer.Option("--screenshots", metavar="DIR", help="Take the poses of these screenshots."),
]
Poses = Annotated[
    Path | None, typer.Option("--poses", metavar="FILE", help="Their poses, as JSONL or CSV.")
]
Pattern = Annotated[
    str | None, typer.Option("--pattern", metavar="TEXT", help="How their names hold poses.")
]


def run(
    world: World,
    count: Count = 100,
    out: Out = Path("tour.jsonl"),
    seed: Seed = 0,
    camera: CameraName = "nyu",
    size: Size = "",
    fov: Fov = None,
    reachable: Reachable = False,
    block_map: BlockMap = "nyu",
    blocks_per_metre: Scale = None,
    screenshots: Shots = None,
    at: At = "",
    poses: Poses = None,
    pattern: Pattern = None,
) -> None:
    """Plan smooth walks through all rooms of a world, with views that are worth a picture.

    Rooms share the views by their size and by what stands in them. Views look along the axes,
    along the diagonals and freely; blocked, empty, flat and dark ones and those nearly like another
    are left out. Doors are opened on the way.

    With --screenshots, the poses of real screenshots become a tour file instead: they come from
    --poses, from the names by --pattern, or from a poses.jsonl or .csv beside them, the PNG's texts
    or the usual names. --at says whether x, y, z is at the feet, as F3 shows it, or at the eye.

    Raises:
        UsageError: the words contradict each other, or nobody can stand in the world.
        InputError: the world or a screenshot cannot be read.
    """
    from world2minecraft.core.errors import UsageError
    from world2minecraft.minecraftocc.scene_sources import open_scene_source
    from world2minecraft.minecraftocc.tours import write_views

    if screenshots is None and (at or poses is not None or pattern is not None):
        raise UsageError("--at, --poses and --pattern tell of --screenshots DIR; name them")
    check_seed(seed)
    source = open_scene_source(world, block_map=block_map, blocks_per_metre=blocks_per_metre)
    if screenshots is not None:
        _write_recorded(source, screenshots, at, poses, pattern, fov, out)
        return
    wanted = parse_camera(camera, size, fov)
    views = _plan(source, count, seed, wanted, reachable)
    write_views(out, views, source.volume().block_to_room, source.scene_id)
    for note in source.notes():
        print(f"note: {note}")
    _print_summary(views, count, out, world)


def _plan(
    source: "SceneSource", count: int, seed: int, camera, reachable: bool
) -> "list[PlannedView]":
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.outcome import print_compile_note
    from world2minecraft.core.errors import UsageError
    from world2minecraft.minecraftocc.tours import TourRule, find_layouts, plan_views

    start = source.start()
    if reachable and start is None:
        raise UsageError("--reachable needs a world that says its spawn; this one does not")
    rule = TourRule(
        camera=camera,
        start=start,
        reachable_only=reachable,
        layouts=find_layouts(source.path),
    )
    print_compile_note()
    with show_progress() as progress:
        return plan_views(source.volume(), count, seed, rule, progress=progress)


def _write_recorded(
    source: "SceneSource",
    folder: Path,
    at: str,
    poses: Path | None,
    pattern: str | None,
    fov_deg: float | None,
    out: Path,
) -> None:
    from world2minecraft.minecraftocc.screenshots import read_screenshots
    from world2minecraft.minecraftocc.tours.pose_files import write_recorded_views

    told = parse_at(at)
    views = read_screenshots(
        folder, at=told, poses=poses, pattern=pattern, vertical_fov_deg=fov_deg or GAME_FOV_DEG
    )
    write_recorded_views(out, views, source.volume().block_to_room, source.scene_id)
    kinds = Counter(view.pose_source for view in views)
    by = ", ".join(f"{number} by {kind}" for kind, number in kinds.items())
    print(f"{out}: {len(views)} screenshots ({by}), x, y, z taken as that of the {at}")
    print(f"  look   w2m dataset sheet {out} --world {source.path}      pictures of the same poses")


def _print_summary(views: "Sequence[PlannedView]", count: int, out: Path, world: Path) -> None:
    kinds = Counter(view.kind for view in views)
    told = ", ".join(f"{kinds[kind]} {kind}" for kind in ("axis", "diagonal", "free"))
    tours, rooms = len({view.tour_id for view in views}), len({view.room for view in views})
    print(f"{out}: {len(views)} views ({told}) in {tours} tours of {rooms} rooms")
    if len(views) < count:
        print(
            f"note: {count} were asked for; the rooms give no more that differ and show something"
        )
    print(f"  look   w2m dataset sheet {out} --world {world}")
    print(f"  draw   w2m render {world} --poses {out} --out pictures")
