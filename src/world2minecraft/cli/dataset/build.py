"""Build a data set of labelled images from many scenes: ``w2m dataset build``."""

from typing import TYPE_CHECKING, Any

from world2minecraft.cli.dataset import options as option
from world2minecraft.cli.panels import Force

if TYPE_CHECKING:
    from world2minecraft.api.datasets import Dataset

EXAMPLES = """\
w2m dataset build DATA --houses 4 --images 40            a small data set to try
w2m dataset build DATA --houses 40 --images 2000         2,000 images of generated houses
w2m dataset build DATA --preset 100k --camera paper      the paper's number and size of images
w2m dataset build DATA --worlds MY_WORLDS --images 500   images of worlds on disk
w2m dataset build DATA --schem house.schem --blocks-per-metre 1
w2m dataset build DATA --world saves/Home --screenshots MY_SHOTS --at feet
w2m dataset build DATA --houses 40 --images 2000 --labels-only
w2m dataset build DATA --preset 50k --engine ray         on many machines
"""
STAGES = {
    "render": "render",
    "encode": "encode",
    "labels": "labels and masks",
    "write": "write and index",
    "scenes": "worlds and views",
}


def run(
    folder: option.NewFolder = None,
    out: option.OutFolder = None,
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
    force: Force = False,
) -> None:
    """Build a data set with images, depth, and a class for every cell in front of the camera.

    Repeat the command to resume an interrupted build, which loses at most one image per process.
    The same options and seed produce identical files with any engine and number of jobs.

    Raises:
        UsageError: If options contradict each other.
        ConflictError: If the folder contains another data set, or another process is building
            there.
        InputError: If a scene cannot be read.
    """
    from world2minecraft.cli.arguments import output_of, size_of

    target = output_of(folder, out)
    given: dict[str, Any] = {
        "houses": houses, "tour": tour, "screenshots": screenshots, "at": at, "images": images,
        "preset": preset, "test_share": test_share, "camera": camera, "size": size_of(size),
        "fov_deg": fov, "voxel_m": option.cells_of(voxel), "region": region,
        "labels_only": labels_only, "image_format": image_format, "quality": quality,
        "block_map": block_map, "blocks_per_metre": blocks_per_metre, "hour": hour,
        "paper_compat": paper_compat, "seed": seed, "engine": engine, "jobs": jobs,
        "force": force,
    }  # fmt: skip
    from world2minecraft.api import build_dataset
    from world2minecraft.api.datasets import worlds_in
    from world2minecraft.api.progress import show_progress
    from world2minecraft.core.precompile import compile_first

    places = [*(world or []), *(worlds_in(worlds) if worlds is not None else [])]
    with show_progress() as progress:
        made = build_dataset(
            target, worlds=places, progress=compile_first(progress, "dataset"), **given
        )
    _print_summary(made)


def _print_summary(data: "Dataset") -> None:
    from world2minecraft.api.progress import format_duration

    folder, report = data.folder, data.report
    if report is None:
        return
    for note in report.notes:
        print(f"note: {note}")
    splits = ", ".join(f"{count:,} {split}" for split, count in report.images.items())
    total = sum(report.images.values())
    shards = f"{report.shards:,} shard{'s' * (report.shards != 1)}"
    seconds = format_duration(report.seconds)
    print(f"{folder}: {total:,} images ({splits}) in {shards}, {seconds}")
    if report.made:
        each = report.milliseconds
        stages = ", ".join(f"{title} {each[stage]:.0f}" for stage, title in STAGES.items())
        print(f"  made   {report.made:,} images in {each['all']:.0f} ms of CPU each: {stages}")
    else:
        print("  made   nothing; the data set is already complete")
    print(f"  sum    {report.sha256}")
    print(f"  read   w2m.open_dataset({str(folder)!r}), or datasets.load_dataset({str(folder)!r})")
    print(f"  next   w2m dataset verify {folder}")
