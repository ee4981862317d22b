"""``w2m evaluate reconstruction``: a finished run against the truth of a virtual scan."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from rich.table import Table

EXAMPLES = """\
w2m evaluate reconstruction OUT my_trial                   every score of the run in OUT
w2m evaluate reconstruction OUT my_trial --stages          and what each stage loses
w2m evaluate reconstruction OUT my_trial --json scores.json
w2m evaluate reconstruction labels.npz my_trial            another method's, objects.json beside
"""


def run(
    out: Annotated[
        Path, typer.Argument(help="The folder of a finished reconstruction, or a labels.npz.")
    ],
    truth: Annotated[Path, typer.Argument(help="The folder with truth.npz and truth.json.")],
    stages: Annotated[
        bool, typer.Option("--stages", help="Put truth in after each stage and score the rest.")
    ] = False,
    json_path: Annotated[
        Path | None, typer.Option("--json", metavar="FILE", help="Write every figure here, too.")
    ] = None,
) -> None:
    """Score a reconstruction against the room that was scanned.

    Only cells that a noise-free ray of a used frame reached or crossed are scored. What another
    method made is read from labels.npz: labels (uint8 X, Y, Z), voxel_m, origin_m and grid_to_scan
    (4x4, from the grid's frame to that of the capture's poses); objects.json beside it is a list
    of {class, center_m, size_m, yaw_deg}.

    Args:
        out: the run's folder, or another method's labels.
        truth: the capture's folder, or that of a truth which names its capture.
        stages: whether to say what each stage loses.
        json_path: where to write the figures.
    """
    from rich.console import Console

    from world2minecraft.cli.progress import show_progress
    from world2minecraft.core.errors import UsageError
    from world2minecraft.core.files import write_json
    from world2minecraft.evaluation.scoring import evaluate_reconstruction
    from world2minecraft.evaluation.scoring.other_methods import evaluate_foreign, foreign_file
    from world2minecraft.evaluation.scoring.stage_losses import stage_losses

    foreign = foreign_file(out)
    if foreign is not None and stages:
        raise UsageError(f"{out} is no run of w2m reconstruct, whose stages --stages goes through")
    if foreign is None:
        check_run(out)
        facts = evaluate_reconstruction(out, truth)
    else:
        facts = evaluate_foreign(foreign, truth)
    if stages:
        with show_progress() as progress:
            facts["stages"] = stage_losses(out, truth, progress=progress)
    console = Console(highlight=False)
    console.print(score_table(facts))
    if "calibration" in facts:
        console.print(reliability_table(facts["calibration"]["occupied"]))
    if stages:
        console.print(stage_table(facts))
    if json_path is not None:
        write_json(json_path, facts)
        print(f"figures  {json_path}")
    if foreign is None:
        for line in next_steps(out, truth, stages):
            print(line)


def check_run(out: Path) -> None:
    """Raise InputError where ``out`` holds no finished run."""
    from world2minecraft.core.errors import InputError

    if not out.is_dir():
        raise InputError(out, "is no folder; w2m reconstruct CAPTURE --out OUT makes one")
    for name in ("scan.json", "room.npz", "objects.json"):
        if not (out / name).is_file():
            raise InputError(
                out, f"has no {name}; finish the run first: w2m reconstruct CAPTURE --out {out}"
            )


def score_table(facts: dict[str, Any]) -> "Table":
    """Return the scores of a run, one a row."""
    from rich.table import Table

    table = Table("what", "score", box=None, header_style="bold", pad_edge=False)
    table.columns[1].justify = "right"
    for name, text in score_rows(facts):
        table.add_row(name, text)
    return table


def score_rows(facts: dict[str, Any]) -> list[tuple[str, str]]:
    """Return the names and the texts of the scores, in the order in which they are printed."""
    surface, cells, objects = (
        facts[name] for name in ("surface_within_one_voxel", "occupancy", "objects")
    )
    frame = facts["frame_error"]
    rows = [
        ("surface within one voxel, precision", f"{surface['precision']:.3f}"),
        ("surface within one voxel, recall", f"{surface['recall']:.3f}"),
        ("free space found free", f"{facts['free_recall']:.3f}"),
        ("IoU, exact", f"{cells['iou']:.3f}"),
        ("mIoU of 11 classes", f"{cells['miou']:.3f}"),
        ("mIoU of the classes present", f"{cells['miou_present_classes']:.3f}"),
        ("class right where occupied", f"{cells['label_accuracy']:.3f}"),
        ("frame, tilt and yaw", f"{frame['tilt_deg']:.2f} deg, {frame['yaw_deg']:.2f} deg"),
        ("frame, floor", f"{100 * frame['floor_m']:+.1f} cm"),
    ]
    if "walls_x_m" in frame and "walls_y_m" in frame:
        walls = f"{100 * frame['walls_x_m']:+.1f} cm, {100 * frame['walls_y_m']:+.1f} cm"
        rows.append(("frame, walls along x and y", walls))
    rows += [(f"poses, {name}", _pose_text(poses)) for name, poses in facts["poses"].items()]
    rows.append(("object F1 (precision, recall)", _f1_text(objects)))
    rows += [
        (f"  {name}", f"{row['matched']} of {row['true']}, {row['found']} found")
        for name, row in objects["by_class"].items()
    ]
    asked, right = objects["orientation_asked"], objects["orientation_hits"]
    if asked:
        rows.append(("chairs, sofas and beds turned right", f"{right} of {asked}"))
    if "openings" in facts:
        rows.append(("openings F1 (precision, recall)", _f1_text(facts["openings"])))
    if layout := facts["layout"]:
        rows += [
            ("collisions", str(layout["collisions"])),
            ("out of bounds", str(layout["out_of_bounds"])),
            ("semantic integrity", f"{layout['semantic_integrity']:.3f}"),
        ]
    if calibration := facts.get("calibration"):
        occupied, every = (calibration[name]["error"] for name in ("occupied", "all"))
        rows.append(("calibration error, occupied cells", f"{occupied:.3f}"))
        rows.append(("calibration error, all observed", f"{every:.3f}"))
    return rows


def reliability_table(calibration: dict[str, Any]) -> "Table":
    """Return how often cells of each confidence are right."""
    from rich.table import Table

    table = Table(
        "confidence", "cells", "mean", "right", box=None, header_style="bold", pad_edge=False
    )
    table.title, table.title_justify = "occupied cells, by confidence", "left"
    for row in calibration["bins"]:
        table.add_row(
            f"{row['from']:.1f} to {row['to']:.1f}",
            f"{row['cells']:,}",
            f"{row['confidence']:.3f}",
            f"{row['right']:.3f}",
        )
    return table


def stage_table(facts: dict[str, Any]) -> "Table":
    """Return what is left to lose: the scores with truth put in after each stage."""
    from rich.table import Table

    names = ("truth after", "IoU", "mIoU", "object F1", "turned", "collisions", "in the world")
    table = Table(*names, box=None, header_style="bold", pad_edge=False)
    table.title, table.title_justify = "what is left to lose", "left"
    for name, row in {"none": facts, **facts["stages"]}.items():
        table.add_row(
            name,
            f"{row['occupancy']['iou']:.3f}",
            f"{row['occupancy']['miou']:.3f}",
            f"{row['objects']['f1']:.3f}",
            f"{row['objects']['orientation_right']:.2f}",
            str(row["layout"].get("collisions", "")),
            f"{row['world'].get('right_class', 0.0):.3f}",
        )
    return table


def next_steps(out: Path, truth: Path, stages: bool) -> list[str]:
    """Return the lines that end the output."""
    lines = ["" if stages else f"next: w2m evaluate reconstruction {out} {truth} --stages"]
    return [line for line in lines if line] or [f"next: open {out / 'report.html'} in a browser"]


def _pose_text(poses: dict[str, float]) -> str:
    return (
        f"{poses['mean_mm']:.1f} mm, {poses['mean_deg']:.2f} deg, "
        f"scale {poses['scale_rms_percent']:.2f} %"
    )


def _f1_text(counts: dict[str, Any]) -> str:
    return f"{counts['f1']:.3f} ({counts['precision']:.3f}, {counts['recall']:.3f})"
