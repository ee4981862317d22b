"""``w2m dataset build``: labelled images of many scenes, in shards, with one command."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from world2minecraft.cli.dataset import options as option

if TYPE_CHECKING:
    from world2minecraft.minecraftocc.building import BuildReport
    from world2minecraft.minecraftocc.plan import DatasetPlan

EXAMPLES = """\
w2m dataset build DATA --houses 4 --images 40            a small one, to look at
w2m dataset build DATA --houses 40 --images 2000         from nothing to 2,000 labelled images
w2m dataset build DATA --preset 100k --camera paper      as many as the paper has, at its size
w2m dataset build DATA --worlds MY_WORLDS --images 500   of worlds that are there
w2m dataset build DATA --schem house.schem --blocks-per-metre 1
w2m dataset build DATA --world saves/Home --screenshots MY_SHOTS --at feet
w2m dataset build DATA --houses 40 --images 2000 --labels-only
w2m dataset build DATA --preset 50k --engine ray         on many machines
"""


def run(
    folder: option.Folder,
    houses: option.Houses = None,
    worlds: option.Worlds = None,
    world: option.World = None,
    tour: option.TourFile = None,
    screenshots: option.Screenshots = None,
    at: option.At = "",
    images: option.Images = None,
    preset: option.Preset = "",
    test_share: option.TestShare = 0.2,
    camera: option.CameraName = "nyu",
    size: option.Size = "",
    fov: option.Fov = None,
    voxel: option.Voxel = "0.08",
    region: option.Region = "paper",
    labels_only: option.LabelsOnly = False,
    image_format: option.ImageFormat = "jpg",
    quality: option.Quality = 95,
    block_map: option.BlockMap = "nyu",
    blocks_per_metre: option.Scale = None,
    hour: option.Hour = None,
    paper_compat: option.PaperCompat = False,
    seed: option.Seed = 0,
    engine: option.EngineName = "pool",
    jobs: option.Jobs = None,
) -> None:
    """Make a data set: pictures, depth, and the class of every cell before the camera.

    Stopped, killed or out of space, the same command goes on where it was: what is lost is one
    image at most. The same words and seed give the same bytes, with any engine and any jobs.

    Raises:
        UsageError: the words contradict each other. ConflictError: the folder has another data
        set, or another run works there. InputError: a scene cannot be read, the disk is full.
    """
    from world2minecraft.minecraftocc.labels.camera_region import RegionRule
    from world2minecraft.minecraftocc.plan import Recipe, plan_dataset
    from world2minecraft.minecraftocc.store.sample_files import SampleFiles

    option.check_seed(seed, hour)
    given, recorded = option.read_given_poses(tour, screenshots, at, fov)
    scenes = option.find_scenes(houses, worlds, world, preset, blocks_per_metre, given)
    if images is None and not preset:
        images = recorded or option.IMAGES_A_SCENE * len(scenes)
    side = option.cells_of(voxel)
    rule = RegionRule(region)
    recipe = Recipe(
        camera=option.parse_camera(camera, size, fov),
        region=rule if side is None else replace(rule, voxel_m=side),
        is_block_cells=side is None,
        files=SampleFiles(image_format, quality),
        pictures=not labels_only,
        block_map=block_map,
        hour=hour,
        paper_compat=paper_compat,
        seed=seed,
    )
    plan = plan_dataset(scenes, images, preset=preset, recipe=recipe, test_share=test_share)
    build(folder, plan, engine, jobs)


def build(folder: Path, plan: "DatasetPlan", engine: str, jobs: int | None) -> None:
    """Carry out a plan and say what came of it. Raises what ``run`` raises."""
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.outcome import print_compile_note
    from world2minecraft.core.machine import usable_cores
    from world2minecraft.minecraftocc.building import build_dataset
    from world2minecraft.minecraftocc.engine import open_engine

    print_compile_note()
    processes = usable_cores() if jobs is None else jobs
    with open_engine(engine, processes) as workers, show_progress() as progress:
        report = build_dataset(folder, plan, workers, progress)
    _print_summary(folder, report)


def _print_summary(folder: Path, report: "BuildReport") -> None:
    from world2minecraft.api.progress import format_duration
    from world2minecraft.minecraftocc.building import TITLES

    for note in report.notes:
        print(f"note: {note}")
    splits = ", ".join(f"{count:,} {split}" for split, count in report.images.items())
    total, shards = sum(report.images.values()), report.shards
    seconds = format_duration(report.seconds)
    print(f"{folder}: {total:,} images ({splits}) in {shards:,} shards, {seconds}")
    if report.made:
        each = report.milliseconds
        stages = ", ".join(f"{title} {each[stage]:.0f}" for stage, title in TITLES.items())
        print(f"  made   {report.made:,} images in {each['all']:.0f} ms of CPU each: {stages}")
    else:
        print("  made   nothing: all was there")
    print(f"  sum    {report.sha256}")
    print(f"  read   datasets.load_dataset({str(folder)!r}), or open_store (docs/minecraftocc.md)")
    print(f"  next   w2m dataset verify {folder}")
