"""``w2m rooms scan``: a generated room, a house or a trial of the benchmark becomes a capture."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from world2minecraft.core.progress import Progress
    from world2minecraft.procgen import Room

EXAMPLES = """\
w2m rooms scan my_room --out capture                    what w2m rooms generate wrote
w2m rooms scan --seed 7 --kind kitchen --out capture    a room of its own
w2m rooms scan --trial noise-500 --out capture          a trial of the benchmark
w2m rooms scan --seed 7 --out capture --depth-scale-sigma 0.03 --coverage 0.6
w2m rooms scan --seed 7 --sensor photos --out photos    JPEGs without depth or poses
"""


def run(
    room_dir: Annotated[
        Path | None, typer.Argument(help="A folder that w2m rooms generate wrote.")
    ] = None,
    out: Annotated[Path, typer.Option("--out", help="The folder to write.")] = Path("capture"),
    seed: Annotated[
        int | None, typer.Option("--seed", help="Of the room (without ROOM_DIR) and the scan.")
    ] = None,
    kind: Annotated[str | None, typer.Option("--kind", help="The kind of room of --seed.")] = None,
    trial: Annotated[
        str | None, typer.Option("--trial", help="A trial, such as noise-500 or noise-500-clean.")
    ] = None,
    sensor: Annotated[
        str | None,
        typer.Option("--sensor", help="rgbd (default), clean; photo, photos, video: a phone's."),
    ] = None,
    frames: Annotated[
        int | None, typer.Option("--frames", help="Pictures of the whole walk; 40, or 100 photos.")
    ] = None,
    depth_scale_sigma: Annotated[
        float | None,
        typer.Option("--depth-scale-sigma", help="How far a frame's depth is off in scale."),
    ] = None,
    coverage: Annotated[
        float | None, typer.Option("--coverage", help="The share of the walk that is taken.")
    ] = None,
    labels: Annotated[bool, typer.Option("--labels", help="Write label images too.")] = False,
    label_error: Annotated[
        float | None, typer.Option("--label-error", help="The share of them that is wrong.")
    ] = None,
) -> None:
    """Scan a generated room or house with a virtual depth camera or phone.

    A person's walk through all rooms is planned, and pictures are taken along it. The result is
    a capture for w2m reconstruct; its truth lies beside it, for w2m evaluate. A trial brings
    settings of its own.
    """
    from world2minecraft.cli.outcome import print_compile_note
    from world2minecraft.cli.progress import show_progress

    figures = {
        "sensor": sensor, "frames": frames, "depth_scale_sigma": depth_scale_sigma,
        "coverage": coverage, "label_error": label_error,
    }  # fmt: skip
    given = {name: value for name, value in figures.items() if value is not None}
    if labels or label_error is not None:
        given["with_labels"] = True
    _check_source(room_dir, seed, kind, trial, given)
    _check_figures(given)
    _check_empty(out)
    print_compile_note()
    with show_progress() as progress:
        if trial is not None:
            _scan_trial(trial, out, progress)
        else:
            _scan(_room(room_dir, seed, kind, progress), out, seed, given, progress)
    print(f"next: w2m reconstruct {out} --out OUT")
    print(f"then: w2m evaluate reconstruction OUT {out}")


def _check_source(
    room_dir: Path | None,
    seed: int | None,
    kind: str | None,
    trial: str | None,
    given: dict[str, Any],
) -> None:
    from world2minecraft.core.errors import UsageError

    if trial is not None:
        if room_dir is not None or seed is not None or kind is not None or given:
            raise UsageError("--trial brings its own room and settings; give it with --out alone")
    elif room_dir is None and seed is None:
        raise UsageError("nothing to scan; give a folder of w2m rooms generate, --seed or --trial")
    elif room_dir is not None and kind is not None:
        raise UsageError(f"{room_dir} has a kind of its own; leave --kind out")
    if seed is not None and seed < 0:
        raise UsageError(f"--seed must be 0 or more, not {seed}")


def _check_figures(given: dict[str, Any]) -> None:
    """Refuse figures out of range before any work is done."""
    from world2minecraft.core.errors import UsageError
    from world2minecraft.procgen.sensors.scan_frames import ScanSettings

    try:
        ScanSettings(**given)
    except ValueError as error:
        raise UsageError(f"--{str(error).replace('_', '-')}") from error


def _check_empty(out: Path) -> None:
    """Refuse a folder that holds a capture or a room: two would mix."""
    from world2minecraft.core.errors import UsageError
    from world2minecraft.reconstruction.run_folder import check_writable

    check_writable(out)
    if (out / "layout.json").exists():
        raise UsageError(f"{out} holds a generated room; give another --out")
    if any((out / name).exists() for name in ("capture.json", "capture.mp4", "truth.npz")):
        raise UsageError(f"{out} holds a capture already; give another --out, or remove it")


def _scan_trial(name: str, out: Path, progress: "Progress") -> None:
    from world2minecraft.procgen.benchmark_trials import find_trial, write_trial

    write_trial(find_trial(name), out, progress)


def _room(
    room_dir: Path | None, seed: int | None, kind: str | None, progress: "Progress"
) -> "Room":
    from world2minecraft.procgen import generate_room, read_generated

    progress("room", 0, 1)
    room = read_generated(room_dir) if room_dir is not None else generate_room(seed or 0, kind=kind)
    progress("room", 1, 1, f"{room.kind}, seed {room.seed}")
    return room


def _scan(
    room: "Room", out: Path, seed: int | None, given: dict[str, Any], progress: "Progress"
) -> None:
    from world2minecraft.procgen import scan_room

    chosen = room.seed if seed is None else seed
    scan_room(room, out, seed=chosen, progress=progress, **given)
