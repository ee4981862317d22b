"""``w2m rooms scan``: scan a generated room, a house or a trial of the benchmark."""

from pathlib import Path
from typing import Annotated, Any

import typer

from world2minecraft.cli.panels import MORE
from world2minecraft.core.errors import UsageError

EXAMPLES = """\
w2m rooms scan my_room -o capture                    what w2m rooms generate wrote
w2m rooms scan --seed 7 --kind kitchen -o capture    a room of its own
w2m rooms scan --trial noise-500 -o capture          a trial of the benchmark
w2m rooms scan --seed 7 -o capture --depth-scale-sigma 0.03 --coverage 0.6
w2m rooms scan --seed 7 --sensor photos -o photos    JPEGs without depth or poses
"""


RoomFolder = Annotated[Path | None, typer.Argument(help="A folder that w2m rooms generate wrote.")]
Out = Annotated[Path, typer.Option("--out", "-o", help="Folder of the capture.")]
Seed = Annotated[
    int | None, typer.Option("--seed", help="Of the room (without ROOM_DIR) and the scan.")
]
Kind = Annotated[str | None, typer.Option("--kind", help="Kind of the room of --seed.")]
TrialName = Annotated[
    str | None, typer.Option("--trial", help="A trial, such as noise-500 or noise-500-clean.")
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
        help="Pictures of the whole walk.",
        show_default="40; 100 photos; 240 of a video",
    ),
]
DepthScaleSigma = Annotated[
    float | None,
    typer.Option(
        "--depth-scale-sigma",
        help="Standard deviation of the factor of each frame's depth.",
        show_default="0",
        rich_help_panel=MORE,
    ),
]
Coverage = Annotated[
    float | None,
    typer.Option(
        "--coverage",
        help="Share of the walk that is taken.",
        show_default="1",
        rich_help_panel=MORE,
    ),
]
Labels = Annotated[bool, typer.Option("--labels", help="Write label images too.")]
LabelError = Annotated[
    float | None,
    typer.Option(
        "--label-error",
        help="Share of the label images that is wrong.",
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
) -> None:
    """Scan a generated room or house with a virtual depth camera or phone.

    A person's walk through all rooms is planned, and pictures are taken along it. The result is
    a capture for w2m reconstruct, with its truth beside it for w2m evaluate. A trial brings its
    own settings.
    """
    from world2minecraft.api.generation import scan_trial
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.outcome import with_compile_note

    figures = {
        "sensor": sensor, "frames": frames, "depth_scale_sigma": depth_scale_sigma,
        "coverage": coverage, "label_error": label_error,
    }  # fmt: skip
    given: dict[str, Any] = {name: value for name, value in figures.items() if value is not None}
    if labels:
        given["labels"] = True
    _check_source(room_dir, seed, kind, trial, given)
    with show_progress() as shown:
        progress = with_compile_note(shown)
        if trial is not None:
            scan_trial(trial, out, progress)
        else:
            _scan(room_dir, out, seed, kind, given | {"progress": progress})
    print(f"next: w2m reconstruct {out} --out OUT")
    print(f"then: w2m evaluate reconstruction OUT {out}")


def _scan(
    room_dir: Path | None, out: Path, seed: int | None, kind: str | None, given: dict[str, Any]
) -> None:
    from world2minecraft.api import generate_room, scan_room
    from world2minecraft.api.generation import check_scan

    check_scan(out, given)
    room = room_dir or generate_room(kind, seed=seed or 0)
    scan_room(room, out, seed=seed, **given)


def _check_source(
    room_dir: Path | None,
    seed: int | None,
    kind: str | None,
    trial: str | None,
    given: dict[str, Any],
) -> None:
    if trial is not None:
        if room_dir is not None or seed is not None or kind is not None or given:
            raise UsageError("--trial brings its own room and settings; give it with --out alone")
    elif room_dir is None and seed is None:
        raise UsageError("nothing to scan; give a folder of w2m rooms generate, --seed or --trial")
    elif room_dir is not None and kind is not None:
        raise UsageError(f"{room_dir} has a kind of its own; leave --kind out")
    if seed is not None and seed < 0:
        raise UsageError(f"--seed must be 0 or more, not {seed}")
