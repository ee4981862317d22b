"""Plan views of a world, or read screenshot poses, as a tour file: ``w2m dataset tour``."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from world2minecraft.cli.dataset.options import At, BlockMap, CameraName, Fov, Scale, Seed, Size

if TYPE_CHECKING:
    from world2minecraft.api.tours import TourFile

EXAMPLES = """\
w2m dataset tour WORLDS/house_0001                        write 100 views to tour.jsonl
w2m dataset tour WORLDS/house_0001 --count 640 --seed 2 --out more.jsonl
w2m dataset tour house.schem --blocks-per-metre 1 --camera paper
w2m dataset tour OUT --reachable                          only where the player can walk
w2m dataset tour WORLD --screenshots FOLDER --at feet     poses of real screenshots
w2m dataset tour WORLD --screenshots FOLDER --at feet --pattern "{x}_{y}_{z}_{yaw}_{pitch}"
"""

World = Annotated[Path, typer.Argument(metavar="WORLD", help="World, run folder, or block file.")]
Count = Annotated[int, typer.Option("--count", metavar="N", help="Number of views.")]
Out = Annotated[
    Path, typer.Option("--out", "-o", metavar="FILE", help="Tour file to write, in JSONL format.")
]
Reachable = Annotated[
    bool,
    typer.Option("--reachable", help="Skip rooms that cannot be reached from the spawn point."),
]
Shots = Annotated[
    Path | None,
    typer.Option(
        "--screenshots", metavar="DIR", help="Use the poses of the screenshots in a folder."
    ),
]
Poses = Annotated[
    Path | None, typer.Option("--poses", metavar="FILE", help="Screenshot poses as JSONL or CSV.")
]
Pattern = Annotated[
    str | None,
    typer.Option("--pattern", metavar="TEXT", help="Pattern for poses in screenshot names."),
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
    """Plan smooth walks through all rooms of a world, with views that are suitable for images.

    Views are distributed over the rooms by size and amount of furniture. They look along the axes,
    along the diagonals and in free directions. Blocked, empty, flat and dark views and near
    duplicates are skipped. Doors are opened on the way.

    With --screenshots, the tour file contains the poses of screenshots. They are read from --poses,
    from file names matching --pattern, from a poses.jsonl or .csv in the folder, from PNG text, or
    from common file names. --at states whether x, y, z are at the feet, as on the F3 screen, or at
    the eye.

    Raises:
        UsageError: If options contradict each other or the world has no position where a player can
            stand.
        InputError: If the world or a screenshot cannot be read.
    """
    from world2minecraft.api.datasets import check_seed
    from world2minecraft.api.progress import show_progress
    from world2minecraft.api.tours import plan_tour, tour_of_screenshots
    from world2minecraft.cli.arguments import size_of
    from world2minecraft.core.errors import UsageError
    from world2minecraft.core.precompile import compile_first

    if screenshots is None and (at or poses is not None or pattern is not None):
        raise UsageError("--at, --poses and --pattern require --screenshots DIR")
    check_seed(seed)
    scene: dict[str, Any] = {
        "block_map": block_map,
        "blocks_per_metre": blocks_per_metre,
        "fov_deg": fov,
    }
    if screenshots is not None:
        tour = tour_of_screenshots(
            world, screenshots, out, at=at, poses=poses, pattern=pattern, **scene
        )
        _print_recorded(tour, at, world)
        return
    with show_progress() as progress:
        tour = plan_tour(
            world,
            out,
            count=count,
            seed=seed,
            camera=camera,
            size=size_of(size),
            reachable=reachable,
            progress=compile_first(progress, "dataset"),
            **scene,
        )
    for note in tour.notes:
        print(f"note: {note}")
    _print_planned(tour, count, world)


def _print_recorded(tour: "TourFile", at: str, world: Path) -> None:
    by = ", ".join(f"{number} by {kind}" for kind, number in tour.kinds.items())
    print(f"{tour.path}: {tour.views} screenshots ({by}), with positions at the {at}")
    print(f"  look   w2m dataset sheet {tour.path} --world {world}      render the same poses")


def _print_planned(tour: "TourFile", count: int, world: Path) -> None:
    kinds = ", ".join(f"{tour.kinds.get(kind, 0)} {kind}" for kind in ("axis", "diagonal", "free"))
    print(f"{tour.path}: {tour.views} views ({kinds}) in {tour.tours} tours of {tour.rooms} rooms")
    if tour.views < count:
        print(f"note: {count} views were requested; the rooms have no more distinct views")
    print(f"  look   w2m dataset sheet {tour.path} --world {world}")
    print(f"  draw   w2m render {world} --poses {tour.path} --out pictures")
