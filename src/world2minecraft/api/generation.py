"""Generated rooms with exact truth, virtual scans of them, and the scores of a reconstruction."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from world2minecraft.api.results import Run
from world2minecraft.api.rooms import BuildOptions, path_of
from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.core.progress import Progress, no_progress

if TYPE_CHECKING:
    from world2minecraft.procgen import Room as GeneratedRoom

MIN_FRAMES = 3  # Of fewer nobody can say how well their poses fit.


def generate_room(
    kind: str | None = None,
    *,
    seed: int = 0,
    shape: str | None = "box",
    clutter: float = 0.0,
    out: str | Path | None = None,
) -> "GeneratedRoom":
    """Generate a furnished room with exact truth; the same seed gives the same room.

    Args:
        kind: ``living``, ``bed``, ``kitchen``, ``dining``, ``study``, ``bathroom`` ...; drawn by
            the seed by default.
        seed: 0 or more.
        shape: ``box``, ``ell``, ``cut``, ``sloped`` or ``columns``; None draws one.
        clutter: 0 (tidy) to 1.
        out: a folder to write the room to: ``layout.json``, ``truth.npz`` and ``preview.png``.

    Raises:
        UsageError: an argument is out of range. OutputError: the folder cannot be written.

    Example:
        >>> import world2minecraft as w2m
        >>> room = w2m.generate_room("kitchen", seed=7)
        >>> room.kind, len(room.objects) > 3
        ('kitchen', True)
    """
    from world2minecraft.procgen import generate_room as generate

    try:
        made = generate(seed, kind=kind, clutter=clutter, shape=shape)
    except ValueError as error:
        raise UsageError(str(error)) from error
    return made if out is None else save_room(made, out)


def generate_house(
    *,
    seed: int = 0,
    rooms: int = 5,
    storeys: int = 1,
    clutter: float = 0.0,
    out: str | Path | None = None,
) -> "GeneratedRoom":
    """Generate a house of several furnished rooms; the same seed gives the same house.

    Args:
        seed: 0 or more.
        rooms: 3 to 14, halls included.
        storeys: 1 or 2.
        clutter: 0 (tidy) to 1.
        out: a folder to write the house to.

    Raises:
        UsageError: an argument is out of range. OutputError: the folder cannot be written.

    Example:
        >>> import world2minecraft as w2m
        >>> len(w2m.generate_house(seed=2, rooms=4).layouts)
        4
    """
    from world2minecraft.procgen import generate_house as generate

    try:
        made = generate(seed, rooms=rooms, storeys=storeys, clutter=clutter)
    except ValueError as error:
        raise UsageError(str(error)) from error
    return made if out is None else save_room(made, out)


def generate_worlds(
    out: str | Path,
    *,
    houses: int,
    seed: int = 0,
    style: str | None = None,
    progress: Progress = no_progress,
) -> list[Path]:
    """Generate houses as Minecraft worlds, each with the class and the object of every block.

    Args:
        out: the folder to write; each house is a folder in it.
        houses: how many; a longer series begins with a shorter one.
        seed: 0 or more.
        style: the style of all houses; each draws its own by default.
        progress: called for each house.

    Returns:
        The folders of the houses, with ``world/``, ``scene.json``, ``scene.npz`` and
        ``designs.json``.

    Raises:
        UsageError: a number is out of range. UnknownNameError: there is no such style.
        OutputError: the folder cannot be written.

    Example:
        >>> import world2minecraft as w2m
        >>> [house.name for house in generate_worlds(tmp / "worlds", houses=1)]
        ['house_0001']
    """
    from world2minecraft.procgen.worlds import write_worlds
    from world2minecraft.reconstruction.run_folder import check_writable

    if houses < 1:
        raise UsageError(f"houses must be 1 or more, not {houses}")
    if seed < 0:
        raise UsageError(f"seed must be 0 or more, not {seed}")
    check_writable(Path(out))
    return write_worlds(Path(out), houses, seed, style=style, progress=progress)


def save_room(
    room: "GeneratedRoom", out: str | Path, progress: Progress = no_progress
) -> "GeneratedRoom":
    """Write a generated room: ``layout.json``, ``truth.npz`` and ``preview.png``; return it.

    Args:
        room: the room or house.
        out: the folder to write.
        progress: called at each step.

    Raises:
        OutputError: the folder cannot be written.

    Example:
        >>> import world2minecraft as w2m
        >>> save_room(w2m.generate_room("bathroom"), tmp / "bathroom").kind
        'bathroom'
    """
    import io

    from PIL import Image

    from world2minecraft.core.files import write_bytes
    from world2minecraft.procgen import room_picture, write_generated
    from world2minecraft.reconstruction.run_folder import check_writable

    folder = Path(out)
    check_writable(folder)
    progress("write", 0, 2, "layout.json, truth.npz")
    write_generated(room, folder)
    progress("write", 1, 2, "preview.png")
    picture = io.BytesIO()
    Image.fromarray(room_picture(room)).save(picture, "PNG")
    write_bytes(folder / "preview.png", picture.getvalue())
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
    progress: Progress = no_progress,
) -> Path:
    """Scan a generated room with a virtual camera; write a capture with its truth beside it.

    Args:
        room: a generated room or house, or the folder of one.
        out: the folder of the capture; must hold no other capture.
        sensor: ``rgbd`` (noisy depth), ``clean``, or a phone's ``photo`` (photos with poses),
            ``photos`` (photos alone) or ``video``.
        frames: the pictures of the whole walk; 40 by default, 100 photos, 240 of a video.
        seed: of the walk and the noise; that of the room by default.
        labels: write label images too.
        label_error: the share of their surface that is wrong, 0 to 1.
        depth_scale_sigma: the standard deviation of each frame's factor of depth.
        coverage: the share of the walk that is taken, above 0 and up to 1.
        progress: called after each frame.

    Returns:
        The folder of the capture, for ``reconstruct``; ``evaluate`` finds the truth in it.

    Raises:
        UsageError: an argument is out of range, or the folder holds another capture.
        OutputError: the folder cannot be written.

    Example:
        >>> import world2minecraft as w2m
        >>> capture = w2m.scan_room(w2m.generate_room("study"), tmp / "capture", frames=3)
        >>> (capture / "truth.npz").is_file()
        True
    """
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
    scan(made, folder, seed=chosen, progress=progress, **_settings_of(figures))
    return folder


def check_scan(out: Path, figures: Mapping[str, Any]) -> None:
    """Check the folder and the figures of ``scan_room`` before any work.

    Args:
        out: the folder of the capture.
        figures: the arguments of ``scan_room`` by their names.

    Raises:
        UsageError: a figure is out of range, or the folder holds another capture or a room.
        OutputError: the folder cannot be written.
    """
    from world2minecraft.procgen.sensors.scan_frames import ScanSettings

    try:
        ScanSettings(**_settings_of(figures))
    except ValueError as error:
        raise UsageError(str(error)) from error
    _check_empty(out)


def _settings_of(figures: Mapping[str, Any]) -> dict[str, Any]:
    """Return the arguments of ``scan_room`` as those of a virtual scan."""
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
    progress: Progress = no_progress,
) -> Run:
    """Generate a room, scan it with a virtual depth camera and reconstruct it.

    The truth is known, so that the report scores the result against it.

    Args:
        out: the folder to write; the scan is in its folder ``capture``.
        kind: the kind of room, as ``generate_room`` has it.
        seed: 0 or more.
        frames: the frames of the scan, 3 or more.
        blocks_per_metre: the scale of the world.
        style: ``blocks``, ``display`` or ``voxels``.
        palette: ``vanilla``, the palette of a mod, or a YAML file.
        formats: further files of the build.
        progress: called at each step.

    Raises:
        UsageError: an argument is out of range. OutputError: the folder cannot be written.

    Example:
        >>> import world2minecraft as w2m
        >>> w2m.demo(tmp / "demo", kind="study", seed=3, frames=6).world.is_dir()
        True
    """
    from world2minecraft.procgen import generate_room as generate
    from world2minecraft.procgen import scan_room as scan
    from world2minecraft.reconstruction.run_folder import check_writable
    from world2minecraft.runs import run_capture

    if seed < 0:
        raise UsageError(f"--seed must be 0 or more, not {seed}")
    if frames < MIN_FRAMES:
        raise UsageError(f"--frames must be {MIN_FRAMES} or more, not {frames}; try 40")
    plaque = {"build.plaque": f"A {kind} room"}
    options = BuildOptions(blocks_per_metre, style, palette, formats, settings=plaque)
    chosen = options.parameters()
    folder = Path(out)
    check_writable(folder)
    progress("room", 0, 1)
    made = generate(seed, kind=kind)
    progress("room", 1, 1, f"a {kind} room, seed {seed}")
    scan(made, folder / "capture", frames=frames, seed=seed, progress=progress)
    run_capture(folder / "capture", folder, chosen, progress=progress)
    return Run(folder)


def scan_trial(name: str, out: str | Path, progress: Progress = no_progress) -> Path:
    """Write a trial of the benchmark, such as ``noise-500``: a scanned room with its truth.

    Raises:
        UnknownNameError: there is no such trial. UsageError: the folder holds another capture.
        OutputError: the folder cannot be written.
    """
    from world2minecraft.procgen.benchmark_trials import find_trial, write_trial

    _check_empty(Path(out))
    write_trial(find_trial(name), Path(out), progress)
    return Path(out)


def evaluate(
    run: Run | str | Path,
    truth: str | Path,
    *,
    stages: bool = False,
    progress: Progress = no_progress,
) -> dict[str, Any]:
    """Score a reconstruction against the room that was scanned.

    Only cells that a noise-free ray of a used frame reached or crossed are scored.

    Args:
        run: a run or its folder, or the ``labels.npz`` of another method: ``labels`` (uint8
            [X, Y, Z]), ``voxel_m``, ``origin_m`` and ``grid_to_scan`` (4x4), with an
            ``objects.json`` beside it.
        truth: the folder of a virtual scan, or any with ``truth.npz`` and ``truth.json``.
        stages: also score the run with the truth put in after each stage.
        progress: called at each step of ``stages``.

    Returns:
        The figures by group, such as ``["occupancy"]["iou"]``; docs/metrics.md describes them.

    Raises:
        InputError: a file is missing or cannot be read.
        UsageError: ``stages`` is asked of another method's labels.

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
            raise UsageError(f"{place} is not a run of w2m reconstruct; leave out --stages")
        return evaluate_foreign(foreign, folder)
    _check_run(place)
    scores = evaluate_reconstruction(place, folder)
    if stages:
        scores["stages"] = stage_losses(place, folder, progress=progress)
    return scores


def _check_run(folder: Path) -> None:
    """Raise InputError where a folder holds no finished run."""
    if not folder.is_dir():
        raise InputError(folder, "is not a folder; w2m reconstruct CAPTURE --out OUT makes one")
    for name in ("scan.json", "room.npz", "objects.json"):
        if not (folder / name).is_file():
            raise InputError(
                folder, f"has no {name}; finish the run: w2m reconstruct CAPTURE --out {folder}"
            )


def _check_empty(out: Path) -> None:
    """Refuse a folder that holds a capture or a room: two would mix."""
    from world2minecraft.reconstruction.run_folder import check_writable

    check_writable(out)
    if (out / "layout.json").exists():
        raise UsageError(f"{out} holds a generated room; choose another --out")
    if any((out / name).exists() for name in ("capture.json", "capture.mp4", "truth.npz")):
        raise UsageError(f"{out} holds a capture; choose another --out, or remove it")
