"""Generate rooms with ground truth, scan them virtually, and score reconstructions."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from world2minecraft.api.results import Run
from world2minecraft.api.rooms import BuildOptions, path_of
from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.core.output_folders import FolderKind
from world2minecraft.core.progress import Progress, no_progress

if TYPE_CHECKING:
    from world2minecraft.procgen import Room as GeneratedRoom

CAPTURE = FolderKind(
    {},
    ("capture.*", "colour", "depth", "labels", "truth.json", "truth.npz", "*.jpg"),
)
ROOM = FolderKind({"truth.npz": ""}, ("layout.json", "preview.png", "truth.npz"), in_place=True)
HOUSES = FolderKind({"house_0001/scene.json": ""}, ("house_*",))
MIN_FRAMES = 3  # The quality of the poses cannot be estimated from fewer frames.


def generate_room(
    kind: str | None = None,
    *,
    seed: int = 0,
    shape: str | None = "box",
    clutter: float = 0.0,
    furnishing: str = "basic",
    out: str | Path | None = None,
) -> "GeneratedRoom":
    """Generate a furnished room with exact ground truth. The same seed gives the same room.

    Args:
        kind: Room type: ``living``, ``bed``, ``kitchen``, ``dining``, ``study``, ``bathroom`` and
            others. Random by default.
        seed: Random seed. Must be 0 or more.
        shape: Floor shape: ``box``, ``ell``, ``cut``, ``sloped`` or ``columns``. None selects a
            random shape.
        clutter: Amount of clutter from 0 (tidy) to 1.
        furnishing: ``basic`` for the main furniture, or ``full`` for all that people expect in a
            room of its kind, such as radiators, lamps, mirrors and shelves.
        out: Folder to write ``layout.json``, ``truth.npz`` and ``preview.png`` to. None writes no
            files.

    Returns:
        The room. Among its attributes are ``objects``, ``layout`` and ``size_m``. ``scan_room``
        scans it.

    Raises:
        UsageError: If an argument is out of range.
        OutputError: If the output folder cannot be written.

    Example:
        >>> import world2minecraft as w2m
        >>> room = w2m.generate_room("kitchen", seed=7)
        >>> room.kind, len(room.objects) > 3
        ('kitchen', True)
    """
    from world2minecraft.procgen import generate_room as generate

    try:
        made = generate(seed, kind=kind, clutter=clutter, shape=shape, furnishing=furnishing)
    except ValueError as error:
        raise UsageError(str(error)) from error
    return made if out is None else save_room(made, out)


def generate_house(
    *,
    seed: int = 0,
    rooms: int = 5,
    storeys: int = 1,
    clutter: float = 0.0,
    furnishing: str = "basic",
    out: str | Path | None = None,
) -> "GeneratedRoom":
    """Generate a house of several furnished rooms. The same seed gives the same house.

    Args:
        seed: Random seed. Must be 0 or more.
        rooms: Number of rooms including halls, 3 to 14.
        storeys: Number of storeys, 1 or 2.
        clutter: Amount of clutter from 0 (tidy) to 1.
        furnishing: ``basic`` for the main furniture, or ``full`` for all that people expect in its
            rooms, such as radiators, lamps, mirrors and shelves.
        out: Folder to write the house to. None writes no files.

    Raises:
        UsageError: If an argument is out of range.
        OutputError: If the output folder cannot be written.

    Example:
        >>> import world2minecraft as w2m
        >>> len(w2m.generate_house(seed=2, rooms=4).layouts)
        4
    """
    from world2minecraft.procgen import generate_house as generate

    try:
        made = generate(seed, rooms=rooms, storeys=storeys, clutter=clutter, furnishing=furnishing)
    except ValueError as error:
        raise UsageError(str(error)) from error
    return made if out is None else save_room(made, out)


def generate_worlds(
    out: str | Path,
    *,
    houses: int,
    seed: int = 0,
    style: str | None = None,
    force: bool = False,
    progress: Progress = no_progress,
) -> list[Path]:
    """Generate houses as Minecraft worlds, with the class and object id of every block.

    Args:
        out: Output folder, with one subfolder per house.
        houses: Number of houses. With the same seed, a larger number adds houses after the same
            first ones.
        seed: Random seed. Must be 0 or more.
        style: Style of all houses. Random for each house by default.
        force: Write into a folder that contains other files.
        progress: Callback that is called for each house.

    Returns:
        The folders of the houses. Each contains ``world/``, ``scene.json``, ``scene.npz`` and
        ``designs.json``.

    Raises:
        UsageError: If a number is out of range, or the folder contains other files without
            ``force``.
        ConflictError: If another process writes the folder.
        UnknownNameError: If the style is unknown.
        OutputError: If the output folder cannot be written.

    Example:
        >>> import world2minecraft as w2m
        >>> [house.name for house in generate_worlds(tmp / "worlds", houses=1)]
        ['house_0001']
    """
    from world2minecraft.core.output_folders import output_folder
    from world2minecraft.procgen.worlds import write_worlds

    if houses < 1:
        raise UsageError(f"houses must be 1 or more, got {houses}")
    if seed < 0:
        raise UsageError(f"seed must be 0 or more, got {seed}")
    with output_folder(Path(out), HOUSES, "generated", force=force):
        return write_worlds(Path(out), houses, seed, style=style, progress=progress)


def save_room(
    room: "GeneratedRoom",
    out: str | Path,
    progress: Progress = no_progress,
    *,
    force: bool = False,
) -> "GeneratedRoom":
    """Write a generated room as ``layout.json``, ``truth.npz`` and ``preview.png``, and return it.

    Args:
        room: Room or house to write.
        out: Output folder.
        progress: Callback that reports each written file.
        force: Write into a folder that contains other files.

    Raises:
        UsageError: If the folder contains other files without ``force``.
        ConflictError: If another process writes the folder.
        OutputError: If the output folder cannot be written.

    Example:
        >>> import world2minecraft as w2m
        >>> save_room(w2m.generate_room("bathroom"), tmp / "bathroom").kind
        'bathroom'
    """
    from PIL import Image

    from world2minecraft.core.files import image_bytes, write_bytes
    from world2minecraft.core.output_folders import output_folder
    from world2minecraft.procgen import room_picture, write_generated

    folder = Path(out)
    with output_folder(folder, ROOM, "generated", force=force, keep=False):
        progress("write", 0, 2, "layout.json, truth.npz")
        write_generated(room, folder)
        progress("write", 1, 2, "preview.png")
        picture = image_bytes(Image.fromarray(room_picture(room)), "PNG")
        write_bytes(folder / "preview.png", picture)
        progress("write", 2, 2)
    return room


def scan_room(
    room: "GeneratedRoom | str | Path",
    out: str | Path,
    *,
    sensor: str = "rgbd",
    frames: int | None = None,
    seed: int | None = None,
    labels: bool = False,
    label_error: float = 0.0,
    depth_scale_sigma: float = 0.0,
    coverage: float = 1.0,
    force: bool = False,
    progress: Progress = no_progress,
) -> Path:
    """Scan a generated room with a virtual camera, and write a capture with its ground truth.

    Args:
        room: Generated room or house, or its folder.
        out: Folder of the capture. Must not contain another capture.
        sensor: ``rgbd`` (noisy depth), ``clean`` (exact depth), ``photo`` (phone photos with
            poses), ``photos`` (phone photos only) or ``video``.
        frames: Number of images in the whole walk. Defaults to 40, 100 for photos, or 240 for a
            video.
        seed: Random seed of the walk and the noise. Defaults to the seed of the room.
        labels: Also write label images.
        label_error: Fraction of the surface with wrong labels, 0 to 1.
        depth_scale_sigma: Standard deviation of the depth scale factor of each frame.
        coverage: Fraction of the walk to record, above 0 and at most 1.
        force: Write into a folder that contains other files.
        progress: Callback that is called after each frame.

    Returns:
        The capture folder, which can be passed to ``reconstruct`` and, as the ground truth, to
        ``evaluate``.

    Raises:
        UsageError: If an argument is out of range, or the folder contains another capture, or
            other files without ``force``.
        ConflictError: If another process writes the folder.
        OutputError: If the output folder cannot be written.

    Example:
        >>> import world2minecraft as w2m
        >>> capture = w2m.scan_room(w2m.generate_room("study"), tmp / "capture", frames=3)
        >>> (capture / "truth.npz").is_file()
        True
    """
    from world2minecraft.core.output_folders import output_folder
    from world2minecraft.procgen import read_generated
    from world2minecraft.procgen import scan_room as scan

    folder = Path(out)
    figures: dict[str, Any] = {
        "sensor": sensor,
        "frames": frames,
        "labels": labels,
        "label_error": label_error,
        "depth_scale_sigma": depth_scale_sigma,
        "coverage": coverage,
    }
    check_scan(folder, figures)
    made = read_generated(Path(room)) if isinstance(room, str | Path) else room
    chosen = made.seed if seed is None else seed
    with output_folder(folder, CAPTURE, "written", force=force, keep=False):
        scan(made, folder, seed=chosen, progress=progress, **_settings_of(figures))
    return folder


def check_scan(out: Path, figures: Mapping[str, Any]) -> None:
    """Check the output folder and the settings of ``scan_room`` before any work.

    Args:
        out: Folder of the capture.
        figures: Arguments of ``scan_room`` by name.

    Raises:
        UsageError: If a setting is out of range, or if the folder contains another capture or a
            room.
        OutputError: If the output folder cannot be written.
    """
    from world2minecraft.procgen.sensors.scan_frames import ScanSettings

    try:
        ScanSettings(**_settings_of(figures))
    except ValueError as error:
        raise UsageError(str(error)) from error
    _check_new(out)


def _settings_of(figures: Mapping[str, Any]) -> dict[str, Any]:
    """Convert the arguments of ``scan_room`` to the settings of a virtual scan."""
    chosen = {name: value for name, value in figures.items() if name not in ("labels", "progress")}
    chosen["with_labels"] = bool(figures.get("labels") or figures.get("label_error"))
    return chosen


def demo(
    out: str | Path = "OUT",
    *,
    kind: str = "living",
    seed: int = 5,
    frames: int = 40,
    blocks_per_metre: float = 4.0,
    style: str | None = None,
    palette: str | Path | None = None,
    formats: Sequence[str] = (),
    force: bool = False,
    progress: Progress = no_progress,
) -> Run:
    """Generate a room, scan it with a virtual depth camera and reconstruct it.

    The report scores the result against the ground truth of the generated room.

    Args:
        out: Output folder. The scan is written to its ``capture`` subfolder.
        kind: Room type. ``generate_room`` lists the types.
        seed: Random seed. Must be 0 or more.
        frames: Number of frames in the scan, 3 or more.
        blocks_per_metre: Scale of the world.
        style: ``blocks``, ``display`` or ``voxels``.
        palette: ``vanilla``, the palette of a mod, or a YAML file.
        formats: Additional file formats to write.
        force: Write into a folder that contains other files.
        progress: Callback that reports the progress of each stage.

    Raises:
        UsageError: If an argument is out of range, or the folder contains other files without
            ``force``.
        ConflictError: If another process writes the folder.
        OutputError: If the output folder cannot be written.

    Example:
        >>> import world2minecraft as w2m
        >>> w2m.demo(tmp / "demo", kind="study", seed=3, frames=6).world.is_dir()
        True
    """
    from world2minecraft.core.output_folders import output_folder
    from world2minecraft.procgen import generate_room as generate
    from world2minecraft.procgen import scan_room as scan
    from world2minecraft.procgen.rooms.recipes import KINDS, find_kind, room_title
    from world2minecraft.reconstruction.run_folder import RUN
    from world2minecraft.runs import run_capture

    if seed < 0:
        raise UsageError(f"seed must be 0 or more, got {seed}")
    if frames < MIN_FRAMES:
        raise UsageError(f"frames must be {MIN_FRAMES} or more, got {frames}; try 40")
    kind = find_kind(kind)
    plaque = {"build.plaque": room_title(kind)}
    options = BuildOptions(blocks_per_metre, style, palette, formats, settings=plaque)
    chosen = options.parameters()
    folder = Path(out)
    with output_folder(folder, RUN, "reconstructed", force=force):
        progress("room", 0, 1)
        made = generate(seed, kind=kind)
        progress("room", 1, 1, f"{KINDS[kind].title}, seed {seed}")
        scan(made, folder / "capture", frames=frames, seed=seed, progress=progress)
        run_capture(folder / "capture", folder, chosen, progress=progress)
    return Run(folder)


def scan_trial(
    name: str, out: str | Path, progress: Progress = no_progress, *, force: bool = False
) -> Path:
    """Write a benchmark trial, such as ``noise-500``: a scanned room with its ground truth.

    Args:
        name: Name of the trial.
        out: Output folder.
        progress: Callback that reports the progress of the scan.
        force: Write into a folder that contains other files.

    Raises:
        UnknownNameError: If the trial is unknown.
        UsageError: If the folder contains another capture, or other files without ``force``.
        ConflictError: If another process writes the folder.
        OutputError: If the output folder cannot be written.
    """
    from world2minecraft.core.output_folders import output_folder
    from world2minecraft.procgen.benchmark_trials import find_trial, write_trial

    folder, trial = Path(out), find_trial(name)
    _check_new(folder)
    with output_folder(folder, CAPTURE, "written", force=force, keep=False):
        write_trial(trial, folder, progress)
    return folder


def evaluate(
    run: Run | str | Path,
    truth: str | Path,
    *,
    stages: bool = False,
    progress: Progress = no_progress,
) -> dict[str, Any]:
    """Score a reconstruction against the ground truth of its virtual scan.

    Only cells that a noise-free ray of a used frame reached or crossed are scored.

    Args:
        run: Run, run folder, or a ``labels.npz`` file of another method. Such a file contains
            ``labels`` (uint8 [X, Y, Z]), ``voxel_m``, ``origin_m`` and ``grid_to_scan`` (4x4), with
            an ``objects.json`` in the same folder.
        truth: Folder of a virtual scan, or any folder with ``truth.npz`` and ``truth.json``.
        stages: Also score the run with the output of each stage replaced by the ground truth in
            turn.
        progress: Callback that reports the scored stages if ``stages`` is True.

    Returns:
        Scores by group, such as ``["occupancy"]["iou"]``. See docs/reference/metrics.md.

    Raises:
        InputError: If a file is missing or cannot be read.
        UsageError: If ``stages`` is requested for the labels of another method.

    Example:
        >>> import world2minecraft as w2m
        >>> 0.5 < w2m.evaluate(run, scan)["occupancy"]["iou"] < 1
        True
    """
    from world2minecraft.evaluation.scoring import evaluate_reconstruction
    from world2minecraft.evaluation.scoring.other_methods import evaluate_foreign, foreign_file
    from world2minecraft.evaluation.scoring.stage_losses import stage_losses

    place, folder = path_of(run), Path(truth)
    foreign = foreign_file(place)
    if foreign is not None:
        if stages:
            raise UsageError(
                f"{place} was not created by w2m reconstruct; omit the stages (--stages)"
            )
        return evaluate_foreign(foreign, folder)
    _check_run(place)
    scores = evaluate_reconstruction(place, folder)
    if stages:
        scores["stages"] = stage_losses(place, folder, progress=progress)
    return scores


def _check_run(folder: Path) -> None:
    """Raise InputError if a folder does not contain a finished run."""
    if not folder.is_dir():
        raise InputError(
            folder, "folder not found; create it with w2m reconstruct CAPTURE --out OUT"
        )
    for name in ("scan.json", "room.npz", "objects.json"):
        if not (folder / name).is_file():
            raise InputError(
                folder,
                f"does not contain {name}; finish the run: w2m reconstruct CAPTURE --out {folder}",
            )


def _check_new(out: Path) -> None:
    """Raise UsageError if a folder already contains a capture or a generated room."""
    if (out / "layout.json").exists():
        raise UsageError(f"{out} already contains a generated room; choose another output folder")
    if any((out / name).exists() for name in ("capture.json", "capture.mp4", "truth.npz")):
        raise UsageError(
            f"{out} already contains a capture; delete it or choose another output folder"
        )
