"""Write tour files, which contain the views of planned walks or the poses of screenshots."""

from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from world2minecraft.api.datasets import camera_named, check_seed
from world2minecraft.core.errors import UsageError
from world2minecraft.core.progress import Progress, no_progress

if TYPE_CHECKING:
    from world2minecraft.core.types import Camera
    from world2minecraft.minecraftocc.scene_sources import SceneSource
    from world2minecraft.minecraftocc.tours import PlannedView

GAME_FOV_DEG = 70.0  # For screenshots that do not record their own.


@dataclass(frozen=True)
class TourFile:
    """Summary of a tour file that was written.

    Attributes:
        path: Path of the file, which contains one JSON object per line.
        views: Number of views.
        tours: Number of walks that the views belong to.
        rooms: Number of rooms with views. Always 0 for screenshots.
        kinds: Number of views by type: ``axis``, ``diagonal`` and ``free``. For screenshots, the
            number of views by source of the pose.
        notes: Remarks about the world.
    """

    path: Path
    views: int
    tours: int
    rooms: int
    kinds: dict[str, int]
    notes: tuple[str, ...] = ()


def plan_tour(
    world: str | Path,
    out: str | Path,
    *,
    count: int = 100,
    seed: int = 0,
    camera: str = "nyu",
    size: tuple[int, int] | None = None,
    fov_deg: float | None = None,
    reachable: bool = False,
    block_map: str = "nyu",
    blocks_per_metre: float | None = None,
    progress: Progress = no_progress,
) -> TourFile:
    """Plan smooth walks through all rooms of a world, with views that are suitable for images.

    Args:
        world: A world, a run folder or a block file.
        out: Tour file to write, in JSONL format.
        count: Maximum number of views. Small rooms can result in fewer views.
        seed: Random seed. Must be 0 or more.
        camera: ``nyu`` or ``paper``.
        size: Image width and height in pixels. Overrides the size of the camera.
        fov_deg: Vertical field of view in degrees. Overrides that of the camera.
        reachable: Skip rooms that cannot be reached on foot from the spawn point.
        block_map: Mapping from blocks to classes: ``nyu``, ``paper`` or a YAML file.
        blocks_per_metre: Scale for a world that does not record its own.
        progress: Callback that reports progress on the rooms.

    Raises:
        UsageError: If an argument is invalid or the world has no position where a player can stand.
        InputError: If the world cannot be read.

    Example:
        >>> from world2minecraft.api.tours import plan_tour
        >>> plan_tour(run.folder, tmp / "tour.jsonl", count=3).views
        3
    """
    from world2minecraft.minecraftocc.scene_sources import open_scene_source
    from world2minecraft.minecraftocc.tours import write_views

    check_seed(seed)
    source = open_scene_source(world, block_map=block_map, blocks_per_metre=blocks_per_metre)
    lens = camera_named(camera, size, fov_deg)
    views = _plan_views(source, count, seed, lens, reachable, progress)
    write_views(out, views, source.volume().block_to_room, source.scene_id)
    return TourFile(
        path=Path(out),
        views=len(views),
        tours=len({view.tour_id for view in views}),
        rooms=len({view.room for view in views}),
        kinds=dict(Counter(view.kind for view in views)),
        notes=tuple(source.notes()),
    )


def tour_of_screenshots(
    world: str | Path,
    screenshots: str | Path,
    out: str | Path,
    *,
    at: str,
    poses: str | Path | None = None,
    pattern: str | None = None,
    fov_deg: float | None = None,
    block_map: str = "nyu",
    blocks_per_metre: float | None = None,
) -> TourFile:
    """Write a tour file with the poses of in-game screenshots.

    Args:
        world: World that the screenshots show.
        screenshots: Folder of the screenshots.
        out: Tour file to write, in JSONL format.
        at: Reference point of the positions: ``feet`` or ``eye``.
        poses: JSONL or CSV file with the poses.
        pattern: Pattern for poses in file names, such as ``{x}_{y}_{z}_{yaw}_{pitch}``.
        fov_deg: Vertical field of view in degrees for screenshots that do not record their own.
            Defaults to 70.
        block_map: Mapping from blocks to classes: ``nyu``, ``paper`` or a YAML file.
        blocks_per_metre: Scale for a world that does not record its own.

    Raises:
        UsageError: If ``at`` is neither ``feet`` nor ``eye``.
        InputError: If the world or a screenshot cannot be read.

    Example:
        >>> from PIL import Image
        >>> from world2minecraft.api.tours import tour_of_screenshots
        >>> Image.new("RGB", (64, 48)).save(tmp / "6_64_5_90_10.png")
        >>> tour_of_screenshots(run.folder, tmp, tmp / "tour.jsonl", at="feet").views
        1
    """
    from world2minecraft.minecraftocc.scene_selection import position_reference
    from world2minecraft.minecraftocc.scene_sources import open_scene_source
    from world2minecraft.minecraftocc.screenshots import read_screenshots
    from world2minecraft.minecraftocc.tours.pose_files import write_recorded_views

    reference = position_reference(at)
    source = open_scene_source(world, block_map=block_map, blocks_per_metre=blocks_per_metre)
    views = read_screenshots(
        screenshots,
        at=reference,
        poses=poses,
        pattern=pattern,
        vertical_fov_deg=fov_deg or GAME_FOV_DEG,
    )
    write_recorded_views(out, views, source.volume().block_to_room, source.scene_id)
    tours, kinds = {view.tour_id for view in views}, Counter(view.pose_source for view in views)
    return TourFile(Path(out), len(views), len(tours), 0, dict(kinds))


def _plan_views(
    source: "SceneSource",
    count: int,
    seed: int,
    camera: "Camera",
    reachable: bool,
    progress: Progress,
) -> "list[PlannedView]":
    from world2minecraft.minecraftocc.tours import TourRule, find_layouts, plan_views

    start = source.start()
    if reachable and start is None:
        raise UsageError("--reachable needs a world with a spawn point, which this one lacks")
    rule = TourRule(
        camera=camera,
        start=start,
        reachable_only=reachable,
        layouts=find_layouts(source.path),
    )
    return plan_views(source.volume(), count, seed, rule, progress=progress)
