"""Scan a generated room, a house or a benchmark trial: ``w2m rooms scan``."""

from pathlib import Path
from typing import Annotated, Any

import typer

from world2minecraft.cli.panels import MORE, Force
from world2minecraft.core.errors import UsageError

EXAMPLES = """\
w2m rooms scan my_room -o capture                    a room from w2m rooms generate
w2m rooms scan --seed 7 --kind kitchen -o capture    a newly generated room
w2m rooms scan --trial noise-500 -o capture          a benchmark trial
w2m rooms scan --seed 7 -o capture --depth-scale-sigma 0.03 --coverage 0.6
w2m rooms scan --seed 7 --sensor photos -o photos    JPEGs without depth or poses
"""


RoomFolder = Annotated[Path | None, typer.Argument(help="Folder written by w2m rooms generate.")]
Out = Annotated[Path, typer.Option("--out", "-o", help="Output folder of the capture.")]
Seed = Annotated[
    int | None,
    typer.Option("--seed", help="Random seed of the scan and, without ROOM_DIR, of the room."),
]
Kind = Annotated[str | None, typer.Option("--kind", help="Room type to generate with --seed.")]
TrialName = Annotated[
    str | None,
    typer.Option("--trial", help="Benchmark trial, such as noise-500 or noise-500-clean."),
]
SensorName = Annotated[
    str | None,
    typer.Option(
        "--sensor", help="rgbd or clean; a phone's photo, photos or video.", show_default="rgbd"
    ),
]
Frames = Annotated[
    int | None,
    typer.Option(
        "--frames",
        help="Number of images in the whole walk.",
        show_default="40; photos 100; video 240",
    ),
]
DepthScaleSigma = Annotated[
    float | None,
    typer.Option(
        "--depth-scale-sigma",
        help="Standard deviation of the depth scale factor of each frame.",
        show_default="0",
        rich_help_panel=MORE,
    ),
]
Coverage = Annotated[
    float | None,
    typer.Option(
        "--coverage",
        help="Fraction of the walk to record.",
        show_default="1",
        rich_help_panel=MORE,
    ),
]
Labels = Annotated[bool, typer.Option("--labels", help="Also write label images.")]
LabelError = Annotated[
    float | None,
    typer.Option(
        "--label-error",
        help="Fraction of the surface with wrong labels.",
        show_default="0",
        rich_help_panel=MORE,
    ),
]


def run(
    room_dir: RoomFolder = None,
    out: Out = Path("capture"),
    seed: Seed = None,
    kind: Kind = None,
    trial: TrialName = None,
    sensor: SensorName = None,
    frames: Frames = None,
    depth_scale_sigma: DepthScaleSigma = None,
    coverage: Coverage = None,
    labels: Labels = False,
    label_error: LabelError = None,
    force: Force = False,
) -> None:
    """Scan a generated room or house with a virtual depth camera or phone.

    Images are rendered along a planned walk through all rooms. The result is a capture for w2m
    reconstruct, with the ground truth for w2m evaluate in the same folder. A trial has fixed
    settings.
    """
    from world2minecraft.api.generation import scan_trial
    from world2minecraft.api.progress import show_progress
    from world2minecraft.core.precompile import compile_first

    figures = {
        "sensor": sensor, "frames": frames, "depth_scale_sigma": depth_scale_sigma,
        "coverage": coverage, "label_error": label_error,
    }  # fmt: skip
    given: dict[str, Any] = {name: value for name, value in figures.items() if value is not None}
    if labels:
        given["labels"] = True
    _check_source(room_dir, seed, kind, trial, given)
    with show_progress() as shown:
        progress = compile_first(shown)
        if trial is not None:
            scan_trial(trial, out, progress, force=force)
        else:
            more = {"progress": progress, "force": force}
            _scan(room_dir, out, seed, kind, given, more)
    print(f"next: w2m reconstruct {out} --out OUT")
    print(f"then: w2m evaluate reconstruction OUT {out}")


def _scan(
    room_dir: Path | None,
    out: Path,
    seed: int | None,
    kind: str | None,
    given: dict[str, Any],
    more: dict[str, Any],
) -> None:
    from world2minecraft.api import generate_room, scan_room
    from world2minecraft.api.generation import check_scan

    check_scan(out, given)
    room = room_dir or generate_room(kind, seed=seed or 0)
    scan_room(room, out, seed=seed, **given, **more)


def _check_source(
    room_dir: Path | None,
    seed: int | None,
    kind: str | None,
    trial: str | None,
    given: dict[str, Any],
) -> None:
    if trial is not None:
        if room_dir is not None or seed is not None or kind is not None or given:
            raise UsageError("--trial has a fixed room and settings; combine it only with --out")
    elif room_dir is None and seed is None:
        raise UsageError("nothing to scan; give a room folder, --seed or --trial")
    elif room_dir is not None and kind is not None:
        raise UsageError(f"the type of {room_dir} is fixed; omit --kind")
    if seed is not None and seed < 0:
        raise UsageError(f"seed must be 0 or more, got {seed}")
