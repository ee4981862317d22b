"""MinecraftOcc data sets: build, open, verify, import and export them."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.core.machine import usable_cores
from world2minecraft.core.progress import Progress, no_progress

if TYPE_CHECKING:
    from world2minecraft.core.types import Camera
    from world2minecraft.minecraftocc.building import BuildReport
    from world2minecraft.minecraftocc.exporters import ExportReport
    from world2minecraft.minecraftocc.importers.imported_samples import ImportedSet
    from world2minecraft.minecraftocc.labels.camera_region import RegionRule
    from world2minecraft.minecraftocc.store import OccStore
    from world2minecraft.minecraftocc.store.verify import VerifyReport
    from world2minecraft.minecraftocc.types import OccSample


@dataclass(frozen=True, eq=False)
class Dataset:
    """A data set of labelled images, read sample by sample.

    Attributes:
        folder: where it lies.
        store: the reader of its samples, by key.
        report: of ``build_dataset``, what the build made and how long it took; else None.
    """

    folder: Path
    store: "OccStore | ImportedSet"
    report: "BuildReport | None" = None

    def __len__(self) -> int:
        return len(self.store)

    def __getitem__(self, number: int | str) -> "OccSample":
        """Return the sample of a number or of a key."""
        if isinstance(number, str):
            return self.store[number]
        keys = self.store.keys()
        return self.store[keys[number]]

    def __iter__(self) -> Iterator["OccSample"]:
        return self.store.samples()

    def samples(self, split: str | None = None) -> Iterator["OccSample"]:
        """Yield the samples of a split, such as ``train``; of all splits by default."""
        return self.store.samples(split)

    def keys(self, split: str | None = None) -> list[str]:
        """Return the keys of the samples of a split; of all splits by default."""
        return self.store.keys(split)

    def describe(self) -> str:
        """Return the format and the number of samples, such as ``store, 3 samples (3 train)``."""
        from world2minecraft.minecraftocc.importers import open_occupancy
        from world2minecraft.minecraftocc.store import OccStore

        found = open_occupancy(self.folder) if isinstance(self.store, OccStore) else self.store
        return found.describe()

    def __repr__(self) -> str:
        return f"Dataset({str(self.folder)!r}, {len(self):,} images)"


def open_dataset(
    folder: str | Path, *, format: str | None = None, labels: str | Path | None = None
) -> Dataset:
    """Open a data set: one of ours, or NYUv2, OccScanNet, EmbodiedOcc-ScanNet or plain npz files.

    Args:
        folder: what ``build_dataset``, ``import_dataset`` or ``export_dataset`` wrote, or a
            published data set; a single ``.bin`` or ``.npz`` too.
        format: ``store`` (ours), ``nyu``, ``occscannet``, ``embodied`` or ``npz``; detected by
            default.
        labels: of ``nyu``, the folder of MonoScene's preprocessed ``base/``, if elsewhere.

    Raises:
        InputError: the folder is not found, or is not a data set. DamagedFileError: it is damaged.
        UnknownNameError: there is no such format.

    Example:
        >>> import world2minecraft as w2m
        >>> from world2minecraft.api.datasets import build_photo_dataset
        >>> made = build_photo_dataset(tmp / "DATA", rooms=2, images=2, size=(64, 48))
        >>> data = w2m.open_dataset(tmp / "DATA")
        >>> sample = data[0]
        >>> len(data), sample.colour.shape, sample.occ.labels.shape
        (2, (48, 64, 3), (60, 60, 36))
    """
    from world2minecraft.minecraftocc.importers import open_occupancy
    from world2minecraft.minecraftocc.store import open_store
    from world2minecraft.minecraftocc.store.folder import META

    place = Path(folder)
    if format == "store" or (format is None and (place / META).is_file()):
        return Dataset(place, open_store(place))
    return Dataset(place, open_occupancy(place, format, labels=labels))


def build_dataset(
    out: str | Path,
    *,
    houses: int | None = None,
    worlds: str | Path | Sequence[str | Path] = (),
    images: int | None = None,
    preset: str = "",
    test_share: float = 0.2,
    camera: str = "nyu",
    size: tuple[int, int] | None = None,
    fov_deg: float | None = None,
    tour: str | Path | None = None,
    screenshots: str | Path | None = None,
    at: str = "",
    voxel_m: float | None = 0.08,
    region: str = "paper",
    labels_only: bool = False,
    image_format: str = "jpg",
    quality: int = 95,
    block_map: str = "nyu",
    blocks_per_metre: float | None = None,
    hour: float | None = None,
    paper_compat: bool = False,
    seed: int = 0,
    engine: str = "pool",
    jobs: int | None = None,
    progress: Progress = no_progress,
) -> Dataset:
    """Build a data set: images, depth, and the class of every cell in front of the camera.

    A build that was interrupted continues when it is called again with the same arguments. The
    same arguments and seed give the same bytes, with any engine and any number of jobs.

    Args:
        out: the folder to write.
        houses: generate this many furnished houses.
        worlds: or worlds, run folders and schematics; of a folder that is none of these, all
            that lie in it.
        images: how many in all; 50 per scene by default.
        preset: ``8k``, ``50k`` or ``100k``: the paper's numbers of images, instead of ``images``.
        test_share: the share of images, in scenes of their own, that are for testing.
        camera: ``nyu`` (640x480, as NYUv2) or ``paper`` (1920x1129, 70 degrees).
        size: width and height in pixels, instead of the camera's.
        fov_deg: the vertical field of view in degrees, instead of the camera's.
        tour: the views of the one world, as a tour file.
        screenshots: or the game's own pictures of it, a folder with their poses.
        at: what the positions of screenshots are: ``feet`` or ``eye``.
        voxel_m: the side of a cell in metres; None for one cell per block.
        region: ``paper`` (along the axes or diagonals) or ``free`` (turned with the view).
        labels_only: write labels and masks, no images and no depth.
        image_format: ``jpg``, ``png`` or ``webp``.
        quality: of JPEG and WebP, 1 to 100.
        block_map: the map from blocks to classes: ``nyu``, ``paper`` or a YAML file.
        blocks_per_metre: the scale of worlds that do not state it.
        hour: the time of day, 0 to 24, in all scenes; each has its own by default.
        paper_compat: also store K and E as the paper prints them.
        seed: 0 or more; it draws houses, views and the split.
        engine: ``pool`` (processes of this machine) or ``ray`` (a Ray cluster).
        jobs: the number of processes; one per core by default.
        progress: called with scenes, images and the index.

    Returns:
        The data set, with its ``report``.

    Raises:
        UsageError: arguments contradict each other. ConflictError: the folder holds another data
        set, or another process builds there. InputError: a scene cannot be read, the disk is full.

    Example:
        >>> import world2minecraft as w2m
        >>> data = w2m.build_dataset(
        ...     tmp / "DATA", worlds=[run.folder], images=2, size=(64, 48), test_share=0, jobs=1
        ... )
        >>> len(data), data.report.images
        (2, {'train': 2})
    """
    from world2minecraft.minecraftocc import scene_selection as selection
    from world2minecraft.minecraftocc.building import build_dataset as build
    from world2minecraft.minecraftocc.engine import open_engine
    from world2minecraft.minecraftocc.plan import Recipe, plan_dataset
    from world2minecraft.minecraftocc.store.sample_files import SampleFiles

    check_seed(seed)
    check_hour(hour)
    given, recorded = selection.read_given_views(_path(tour), _path(screenshots), at, fov_deg)
    places = _expand_worlds(worlds)
    scenes = selection.select_scenes(houses, places, preset, blocks_per_metre, given)
    if images is None and not preset:
        images = recorded or selection.IMAGES_PER_SCENE * len(scenes)
    recipe = Recipe(
        camera=camera_named(camera, size, fov_deg),
        region=_region_rule(region, voxel_m),
        is_block_cells=voxel_m is None,
        files=SampleFiles(image_format, quality),
        pictures=not labels_only,
        block_map=block_map,
        hour=hour,
        paper_compat=paper_compat,
        seed=seed,
    )
    plan = plan_dataset(scenes, images, preset=preset, recipe=recipe, test_share=test_share)
    with open_engine(engine, usable_cores() if jobs is None else jobs) as workers:
        report = build(out, plan, workers, progress)
    return replace(open_dataset(out), report=report)


def worlds_in(folder: str | Path) -> list[Path]:
    """Return the worlds, builds and schematics that lie in a folder, sorted.

    Raises:
        InputError: the folder is not found, or holds none.

    Example:
        >>> import world2minecraft as w2m
        >>> from world2minecraft.api.datasets import worlds_in
        >>> path = w2m.convert(run, tmp / "worlds" / "study.schem").path
        >>> [world.name for world in worlds_in(tmp / "worlds")]
        ['study.schem']
    """
    from world2minecraft.minecraftocc.scene_selection import find_worlds

    return find_worlds(Path(folder))


def build_photo_dataset(
    out: str | Path,
    *,
    rooms: int = 20,
    images: int = 400,
    test_share: float = 0.25,
    size: tuple[int, int] | None = None,
    seed: int = 0,
    progress: Progress = no_progress,
) -> Dataset:
    """Build a data set of photo-like images of generated rooms, in place of real photos.

    Truth is the rooms' own, in cells of 8 cm by the rule of NYUv2. See docs/training.md.

    Args:
        out: the data set, a new folder.
        rooms: how many rooms.
        images: how many images in all.
        test_share: the share of the rooms that are for testing.
        size: width and height in pixels, instead of NYUv2's 640x480.
        seed: 0 or more.
        progress: called after each image.

    Raises:
        UsageError: a number is out of range. ConflictError: the folder holds a data set.
        OutputError: the folder cannot be written.

    Example:
        >>> from world2minecraft.api.datasets import build_photo_dataset
        >>> build_photo_dataset(tmp / "PHOTO", rooms=2, images=2, size=(64, 48)).keys("test")
        ['photo_0_0001-walk-000000']
    """
    from world2minecraft.minecraftocc.store import write_store
    from world2minecraft.minecraftocc.synthetic_photos import PhotoRooms, photo_samples

    plan = PhotoRooms(rooms, images, test_share, seed, camera_named("nyu", size, None))
    facts = {"rooms": rooms, "images": images, "test_share": test_share, "seed": seed}
    write_store(
        out, photo_samples(plan), {"photo_rooms": facts}, progress=_with_total(progress, images)
    )
    return open_dataset(out)


def verify_dataset(folder: str | Path, *, progress: Progress = no_progress) -> "VerifyReport":
    """Read every file of a data set and compare it with the index and its checksums.

    Args:
        folder: the data set.
        progress: called after each shard.

    Returns:
        The numbers of samples, shards and bytes, the checksum of all samples, and ``faults``,
        one sentence for each file that is missing, damaged or unexpected.

    Raises:
        InputError: it is not a data set, or not finished. DamagedFileError: its index cannot be
        read.

    Example:
        >>> import world2minecraft as w2m
        >>> from world2minecraft.api.datasets import build_photo_dataset
        >>> data = build_photo_dataset(tmp / "DATA", rooms=2, images=2, size=(64, 48))
        >>> report = w2m.verify_dataset(tmp / "DATA")
        >>> report.samples, report.faults
        (2, ())
    """
    from world2minecraft.minecraftocc.store import verify_store

    return verify_store(folder, progress)


def import_dataset(
    source: Dataset | str | Path,
    out: str | Path,
    *,
    format: str | None = None,
    labels: str | Path | None = None,
    split: str | None = None,
    limit: int | None = None,
    progress: Progress = no_progress,
) -> Dataset:
    """Convert a published occupancy data set into one that trains, scores and displays as ours.

    Pickles are read without executing anything: one that asks for more than arrays is refused.

    Args:
        source: a folder of NYUv2, OccScanNet, EmbodiedOcc-ScanNet or npz files, or such a data
            set, opened.
        out: the data set to write, a new folder.
        format: ``nyu``, ``occscannet``, ``embodied`` or ``npz``; detected by default.
        labels: of ``nyu``, the folder of MonoScene's preprocessed ``base/``, if elsewhere.
        split: ``train`` or ``test`` alone; all by default.
        limit: import this many samples at most.
        progress: called after each sample.

    Raises:
        InputError: the source cannot be read. UsageError: it has no sample in the split.
        ConflictError: the folder holds a data set.

    Example:
        >>> import world2minecraft as w2m
        >>> from world2minecraft.api.datasets import build_photo_dataset
        >>> data = build_photo_dataset(tmp / "DATA", rooms=2, images=2, size=(64, 48))
        >>> report = w2m.export_dataset(data, tmp / "NPZ", "npz")
        >>> w2m.import_dataset(tmp / "NPZ", tmp / "AGAIN").keys() == data.keys()
        True
    """
    from itertools import islice

    from world2minecraft.minecraftocc.store import write_store

    found = (
        source
        if isinstance(source, Dataset)
        else open_dataset(source, format=format, labels=labels)
    )
    keys = found.keys(split)
    count = len(keys) if limit is None else min(limit, len(keys))
    if not count:
        place = f" in {split}" if split else ""
        raise UsageError(f"{found.folder} has no sample{place}: {found.describe()}")
    name = found.describe().partition(",")[0]
    write_store(
        out,
        islice(found.samples(split), count),
        {"imported": {"format": name, "samples": count}},
        progress=_with_total(progress, count),
    )
    return open_dataset(out)


def export_dataset(
    source: Dataset | str | Path,
    out: str | Path,
    format: str,
    *,
    split: str | None = None,
    limit: int | None = None,
    unknown: str = "keep",
    in_view: bool = False,
    short_bin: bool = False,
    data_root: str | None = None,
    frames_per_scene: int | None = None,
    progress: Progress = no_progress,
) -> "ExportReport":
    """Write a data set in the format of NYUv2, OccScanNet, EmbodiedOcc-ScanNet, or as plain npz.

    An export that was interrupted continues when it is called again with the same arguments.
    docs/occupancy-formats.md describes every file.

    Args:
        source: a data set, or a folder that ``open_dataset`` opens.
        out: the folder to write.
        format: ``nyu``, ``occscannet``, ``embodied`` or ``npz``.
        split: ``train`` or ``test`` alone; all by default.
        limit: export this many samples at most.
        unknown: ``keep`` unknown cells as 255, or write them as ``empty`` (0).
        in_view: make cells outside the image unknown.
        short_bin: of ``nyu``, write only the headers of the ``.bin`` files.
        data_root: of ``occscannet`` and ``embodied``, what the paths inside files begin with;
            ``./data/occscannet`` by default.
        frames_per_scene: of ``embodied``; 30 by default, 0 for all.
        progress: called after each sample.

    Returns:
        How many samples were written and skipped, and notes on what the format cannot hold.

    Raises:
        UnknownNameError: there is no such format. UsageError: there is nothing to export.
        ConflictError: the folder holds another export. InputError: the source cannot be read.

    Example:
        >>> import world2minecraft as w2m
        >>> from world2minecraft.api.datasets import build_photo_dataset
        >>> data = build_photo_dataset(tmp / "DATA", rooms=2, images=2, size=(64, 48))
        >>> w2m.export_dataset(data, tmp / "NYU", "nyu").written
        2
    """
    from world2minecraft.minecraftocc.exporters import ExportRule, export_samples
    from world2minecraft.minecraftocc.exporters.options import DATA_ROOT, FRAMES_PER_SCENE
    from world2minecraft.minecraftocc.importers import open_occupancy

    rule = ExportRule(
        unknown=unknown,
        in_view=in_view,
        short_bin=short_bin,
        data_root=DATA_ROOT if data_root is None else data_root.rstrip("/"),
        frames_per_scene=FRAMES_PER_SCENE if frames_per_scene is None else frames_per_scene,
    )
    samples = source.store if isinstance(source, Dataset) else open_occupancy(source)
    return export_samples(samples, format, out, rule, split=split, limit=limit, progress=progress)


def camera_named(
    name: str, size: tuple[int, int] | None = None, fov_deg: float | None = None
) -> "Camera":
    """Return the camera ``nyu`` or ``paper``, at another size or vertical field of view.

    Raises:
        UnknownNameError: there is no such camera. UsageError: a number is out of range.

    Example:
        >>> from world2minecraft.api.datasets import camera_named
        >>> camera_named("paper", size=(192, 112)).width_px
        192
    """
    from world2minecraft.minecraftocc.tours import nyu_camera, paper_camera
    from world2minecraft.rendering.views import camera_of, vertical_fov_deg_of

    cameras = {"nyu": nyu_camera, "paper": paper_camera}
    if name not in cameras:
        raise UnknownNameError("camera", name, cameras)
    camera = cameras[name]()
    if size is None and fov_deg is None:
        return camera
    width, height = size or (camera.width_px, camera.height_px)
    angle = vertical_fov_deg_of(camera) if fov_deg is None else fov_deg
    return camera_of(width, height, vertical_fov_deg=angle)


def check_seed(seed: int) -> None:
    """Raise UsageError for a negative seed."""
    if seed < 0:
        raise UsageError(f"--seed must be 0 or more, not {seed}")


def check_hour(hour: float | None) -> None:
    """Raise UsageError for an hour outside 0 to 24; None is each scene's own."""
    if hour is not None and not 0 <= hour <= 24:
        raise UsageError(f"--hour must be 0 to 24, not {hour:g}")


def _region_rule(kind: str, voxel_m: float | None) -> "RegionRule":
    from world2minecraft.minecraftocc.labels.camera_region import RegionRule

    rule = RegionRule(kind)
    return rule if voxel_m is None else replace(rule, voxel_m=voxel_m)


def _expand_worlds(worlds: str | Path | Sequence[str | Path]) -> list[Path]:
    """Return the worlds that paths stand for: a folder of worlds stands for all in it."""
    from world2minecraft.minecraftocc.scene_selection import find_worlds, is_scene_source

    places: list[Path] = []
    for one in [worlds] if isinstance(worlds, str | Path) else worlds:
        path = Path(one)
        places += find_worlds(path) if path.is_dir() and not is_scene_source(path) else [path]
    return places


def _path(path: str | Path | None) -> Path | None:
    return None if path is None else Path(path)


def _with_total(progress: Progress, steps: int) -> Progress:
    """Return a progress that states the steps in all where its caller does not know them."""

    def report(stage: str, done: int, total: int, note: str = "") -> None:
        progress(stage, done, total or steps, note)

    return report
