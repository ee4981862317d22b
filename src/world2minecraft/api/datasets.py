"""Build, open, verify, import and export MinecraftOcc data sets."""

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.core.machine import usable_cores
from world2minecraft.core.progress import Progress, no_progress

if TYPE_CHECKING:
    from world2minecraft.core.checksums import RepairReport
    from world2minecraft.core.types import Camera
    from world2minecraft.formats.object_names import NamedObject
    from world2minecraft.minecraftocc.building import BuildReport
    from world2minecraft.minecraftocc.exporters import ExportReport
    from world2minecraft.minecraftocc.importers.imported_samples import ImportedSet
    from world2minecraft.minecraftocc.labels.camera_region import RegionRule
    from world2minecraft.minecraftocc.store import OccStore
    from world2minecraft.minecraftocc.store.verify import VerifyReport
    from world2minecraft.minecraftocc.types import OccSample


@dataclass(frozen=True, eq=False)
class Dataset:
    """A data set of labelled images whose samples are read on demand.

    Attributes:
        folder: Folder of the data set.
        store: Reader that returns samples by key.
        report: Contents and timing of the build, set by ``build_dataset``. None otherwise.
    """

    folder: Path
    store: "OccStore | ImportedSet"
    report: "BuildReport | None" = None

    def __len__(self) -> int:
        return len(self.store)

    def __getitem__(self, number: int | str) -> "OccSample":
        """Return the sample with the given index or key."""
        if isinstance(number, str):
            return self.store[number]
        keys = self.store.keys()
        return self.store[keys[number]]

    def __iter__(self) -> Iterator["OccSample"]:
        return self.store.samples()

    def samples(self, split: str | None = None) -> Iterator["OccSample"]:
        """Iterate over the samples in a split such as ``train``. Defaults to all splits."""
        return self.store.samples(split)

    def keys(self, split: str | None = None) -> list[str]:
        """Return the sample keys in a split such as ``train``. Defaults to all splits."""
        return self.store.keys(split)

    def objects(self, scene_id: str) -> "dict[int, NamedObject]":
        """Return the class and the name of each object of a scene by its number in ``instance``.

        Data sets of former versions and of other programs have none.

        Raises:
            UnknownNameError: If there is no such scene.
        """
        from world2minecraft.minecraftocc.store import OccStore

        return self.store.objects(scene_id) if isinstance(self.store, OccStore) else {}

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
    """Open a data set in our own format or in one of the published formats.

    The published formats are NYUv2, OccScanNet, EmbodiedOcc-ScanNet and plain npz files.

    Args:
        folder: Folder written by ``build_dataset``, ``import_dataset`` or ``export_dataset``, or a
            published data set. A single ``.bin`` or ``.npz`` file is also accepted.
        format: ``store`` (our own format), ``nyu``, ``occscannet``, ``embodied`` or ``npz``.
            Detected automatically by default.
        labels: Folder with MonoScene's preprocessed ``base/``, if it is stored elsewhere. Only for
            ``nyu``.

    Raises:
        InputError: If the folder does not exist or is not a data set.
        DamagedFileError: If the data set is damaged.
        UnknownNameError: If the format is unknown.

    Example:
        >>> import world2minecraft as w2m
        >>> again = w2m.open_dataset(data.folder)
        >>> sample = again[0]
        >>> len(again), sample.colour.shape, sample.occ.labels.shape
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
    force: bool = False,
    progress: Progress = no_progress,
) -> Dataset:
    """Build a data set with images, depth maps and class labels for cells in front of the camera.

    Call the function again with the same arguments to resume an interrupted build. The same
    arguments and seed produce identical files with any engine and any number of jobs.

    Args:
        out: Output folder.
        houses: Number of furnished houses to generate. Cannot be combined with ``worlds``.
        worlds: Worlds, run folders or schematics to use instead of generated houses. For any other
            folder, all worlds directly inside it are used.
        images: Total number of images. Defaults to 50 per scene.
        preset: ``8k``, ``50k`` or ``100k``: use the paper's number of images instead of ``images``.
        test_share: Fraction of the images to use for testing, taken from separate scenes.
        camera: ``nyu`` (640x480, as in NYUv2) or ``paper`` (1920x1129, 70 degrees).
        size: Image width and height in pixels. Overrides the size of the camera.
        fov_deg: Vertical field of view in degrees. Overrides that of the camera.
        tour: Tour file with the views to use. Requires exactly one world.
        screenshots: Folder of in-game screenshots with their poses, used instead of rendered
            images. Requires exactly one world.
        at: Reference point of the screenshot positions: ``feet`` or ``eye``. Required with
            ``screenshots``.
        voxel_m: Cell size in metres. None uses one cell per block.
        region: ``paper`` (aligned with the axes or diagonals) or ``free`` (rotated with the view).
        labels_only: Write only labels and masks, without images and depth maps.
        image_format: ``jpg``, ``png`` or ``webp``.
        quality: JPEG and WebP quality from 1 to 100.
        block_map: Mapping from blocks to classes: ``nyu``, ``paper`` or a YAML file.
        blocks_per_metre: Scale for worlds that do not record their own.
        hour: Time of day from 0 to 24 for all scenes. Chosen for each scene by default.
        paper_compat: Also store the matrices K and E exactly as printed in the paper.
        seed: Random seed for houses, views and the split. Must be 0 or more.
        engine: ``pool`` (processes on this machine) or ``ray`` (a Ray cluster).
        jobs: Number of processes. Defaults to one per core. With more than one, a script must call
            this function under ``if __name__ == "__main__":``, because each process imports it.
        force: Write into a folder that contains other files.
        progress: Callback that reports progress on scenes, images and the index.

    Returns:
        The data set with its ``report``.

    Raises:
        UsageError: If arguments are invalid or contradict each other, or the folder contains other
            files without ``force``.
        ConflictError: If the folder contains another data set or another process is building there.
        InputError: If a scene cannot be read or the disk is full.

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
        report = build(out, plan, workers, progress, force)
    return replace(open_dataset(out), report=report)


def worlds_in(folder: str | Path) -> list[Path]:
    """Return a sorted list of the worlds, builds and schematics in a folder.

    Raises:
        InputError: If the folder does not exist or contains no world.

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
    force: bool = False,
    progress: Progress = no_progress,
) -> Dataset:
    """Build a data set of photo-like images of generated rooms, as a substitute for real photos.

    The ground truth comes from the generated rooms and uses 8 cm cells, following the conventions
    of NYUv2. See docs/how-to/train-a-network.md.

    Args:
        out: Output folder, which must be new or empty.
        rooms: Number of rooms to generate.
        images: Total number of images.
        test_share: Fraction of the rooms to use for testing.
        size: Image width and height in pixels. Defaults to 640x480, as in NYUv2.
        seed: Random seed. Must be 0 or more.
        force: Write into a folder that contains other files.
        progress: Callback that is called after each image.

    Raises:
        UsageError: If a number is out of range, or the folder contains other files without
            ``force``.
        ConflictError: If the folder already contains a data set.
        OutputError: If the folder cannot be written.

    Example:
        >>> from world2minecraft.api.datasets import build_photo_dataset
        >>> build_photo_dataset(tmp / "PHOTO", rooms=2, images=2, size=(64, 48)).keys("test")
        ['photo_0_0001-walk-000000']
    """
    from world2minecraft.minecraftocc.plan import plain_camera
    from world2minecraft.minecraftocc.store import write_store
    from world2minecraft.minecraftocc.synthetic_photos import PhotoRooms, photo_samples

    plan = PhotoRooms(rooms, images, test_share, seed, camera_named("nyu", size, None))
    facts = {**asdict(plan), "camera": plain_camera(plan.camera)}
    write_store(
        out,
        photo_samples(plan),
        {"photo_rooms": facts},
        force=force,
        progress=_with_total(progress, images),
    )
    return open_dataset(out)


def verify_dataset(folder: str | Path, *, progress: Progress = no_progress) -> "VerifyReport":
    """Read every file in a data set and check it against the list of its files.

    Data sets of former versions have no list: of those, only the shards are checked.

    Args:
        folder: Folder of the data set.
        progress: Callback that is called after each file.

    Returns:
        The number of samples, shards, files and bytes, a checksum over all samples, and ``faults``,
        with one sentence for each missing, changed or unexpected file.

    Raises:
        InputError: If the folder is not a data set or the data set is incomplete.
        DamagedFileError: If the index cannot be read.

    Example:
        >>> import world2minecraft as w2m
        >>> report = w2m.verify_dataset(data.folder)
        >>> report.samples, report.faults
        (2, ())
    """
    from world2minecraft.minecraftocc.store import verify_store

    return verify_store(folder, progress)


def repair_dataset(
    folder: str | Path, *, jobs: int | None = None, progress: Progress = no_progress
) -> "RepairReport":
    """Make the damaged and missing files of a data set again from its plan and seed.

    Only files with the same contents as before are replaced. Unexpected files are left alone.

    Args:
        folder: Folder of the data set.
        jobs: Number of processes. Defaults to one per core.
        progress: Callback that reports progress.

    Returns:
        The names of the ``repaired`` files, and one sentence for each file in ``left``, with what
        to do.

    Raises:
        InputError: If the folder is not a data set or the data set is incomplete.
        ConflictError: If another process writes the data set.
        OutputError: If the folder cannot be written.

    Example:
        >>> from world2minecraft.api.datasets import repair_dataset
        >>> (data.folder / "README.md").unlink()
        >>> repair_dataset(data.folder).repaired
        ('README.md',)
    """
    from world2minecraft.minecraftocc.building import repair_dataset as repair
    from world2minecraft.minecraftocc.engine import open_engine

    with open_engine("pool", usable_cores() if jobs is None else jobs) as engine:
        return repair(folder, engine, progress)


def import_dataset(
    source: Dataset | str | Path,
    out: str | Path,
    *,
    format: str | None = None,
    labels: str | Path | None = None,
    split: str | None = None,
    limit: int | None = None,
    force: bool = False,
    progress: Progress = no_progress,
) -> Dataset:
    """Convert a published occupancy data set to our format, for training, scoring and display.

    Pickle files are read without executing code. A pickle file that contains anything other than
    arrays is rejected. If the import fails, the output folder is unchanged.

    Args:
        source: Folder of NYUv2, OccScanNet, EmbodiedOcc-ScanNet or npz files, or a ``Dataset`` that
            is already open.
        out: Output folder, which must be new or empty.
        format: ``nyu``, ``occscannet``, ``embodied`` or ``npz``. Detected automatically by default.
        labels: Folder with MonoScene's preprocessed ``base/``, if it is stored elsewhere. Only for
            ``nyu``.
        split: Import only ``train`` or only ``test``. Defaults to all splits.
        limit: Maximum number of samples to import.
        force: Write into a folder that contains other files.
        progress: Callback that is called after each sample.

    Raises:
        InputError: If the source cannot be read.
        UsageError: If the split contains no samples, or the folder contains other files without
            ``force``.
        ConflictError: If the output folder already contains a data set, or another process writes
            it.

    Example:
        >>> import world2minecraft as w2m
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
        force=force,
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
    axes: str = "published",
    force: bool = False,
    progress: Progress = no_progress,
) -> "ExportReport":
    """Export a data set in the format of NYUv2, OccScanNet or EmbodiedOcc-ScanNet, or as npz files.

    Call the function again with the same arguments to resume an interrupted export.
    docs/reference/occupancy-formats.md describes all files.

    Args:
        source: A ``Dataset``, or a folder that ``open_dataset`` can open.
        out: Output folder.
        format: ``nyu``, ``occscannet``, ``embodied`` or ``npz``.
        split: Export only ``train`` or only ``test``. Defaults to all splits.
        limit: Maximum number of samples to export.
        unknown: Value for unknown cells: ``keep`` (255) or ``empty`` (0).
        in_view: Mark cells outside the image as unknown.
        short_bin: Write only the headers of the ``.bin`` files. Only for ``nyu``.
        data_root: Prefix for the paths stored in the exported files. Only for ``occscannet`` and
            ``embodied``. Defaults to ``./data/occscannet``.
        frames_per_scene: Number of frames per scene, or 0 for all. Only for ``embodied``. Defaults
            to 30.
        axes: Order of the label axes: ``published``, or ``iso`` for ISO's loader. Only for
            ``occscannet``.
        force: Write into a folder that contains other files.
        progress: Callback that is called after each sample.

    Returns:
        The number of samples written and skipped, and notes on data that the format cannot
        represent.

    Raises:
        UnknownNameError: If the format is unknown.
        UsageError: If there are no samples to export, or the folder contains other files without
            ``force``.
        ConflictError: If the folder contains another export, or another process writes it.
        InputError: If the source cannot be read.

    Example:
        >>> import world2minecraft as w2m
        >>> w2m.export_dataset(data, tmp / "NYU", "nyu").written
        2
    """
    from world2minecraft.core.output_folders import output_folder
    from world2minecraft.minecraftocc.exporters import EXPORT, ExportRule, export_samples
    from world2minecraft.minecraftocc.exporters.options import DATA_ROOT, FRAMES_PER_SCENE
    from world2minecraft.minecraftocc.importers import open_occupancy

    rule = ExportRule(
        unknown=unknown,
        in_view=in_view,
        short_bin=short_bin,
        data_root=DATA_ROOT if data_root is None else data_root.rstrip("/"),
        frames_per_scene=FRAMES_PER_SCENE if frames_per_scene is None else frames_per_scene,
        axes=axes,
    )
    samples = source.store if isinstance(source, Dataset) else open_occupancy(source)
    with output_folder(Path(out), EXPORT, "written", force=force):
        return export_samples(
            samples, format, out, rule, split=split, limit=limit, progress=progress
        )


def camera_named(
    name: str, size: tuple[int, int] | None = None, fov_deg: float | None = None
) -> "Camera":
    """Return the camera ``nyu`` or ``paper``, optionally with another size or field of view.

    ``fov_deg`` is the vertical field of view in degrees.

    Raises:
        UnknownNameError: If the camera is unknown.
        UsageError: If a number is out of range.

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
    """Raise UsageError if the seed is negative."""
    if seed < 0:
        raise UsageError(f"seed must be 0 or more, got {seed}")


def check_hour(hour: float | None) -> None:
    """Raise UsageError if the hour is not between 0 and 24. None (one hour per scene) is valid."""
    if hour is not None and not 0 <= hour <= 24:
        raise UsageError(f"hour must be 0 to 24, got {hour:g}")


def _region_rule(kind: str, voxel_m: float | None) -> "RegionRule":
    from world2minecraft.minecraftocc.labels.camera_region import RegionRule

    rule = RegionRule(kind)
    return rule if voxel_m is None else replace(rule, voxel_m=voxel_m)


def _expand_worlds(worlds: str | Path | Sequence[str | Path]) -> list[Path]:
    """Return the paths with each folder of worlds replaced by the worlds inside it."""
    from world2minecraft.minecraftocc.scene_selection import find_worlds, is_scene_source

    places: list[Path] = []
    for one in [worlds] if isinstance(worlds, str | Path) else worlds:
        path = Path(one)
        places += find_worlds(path) if path.is_dir() and not is_scene_source(path) else [path]
    return places


def _path(path: str | Path | None) -> Path | None:
    return None if path is None else Path(path)


def _with_total(progress: Progress, steps: int) -> Progress:
    """Return a progress callback that reports ``steps`` as the total if the caller reports none."""

    def report(stage: str, done: int, total: int, note: str = "") -> None:
        progress(stage, done, total or steps, note)

    return report
