"""Score a finished run against ground truth: ``w2m evaluate reconstruction``."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from rich.table import Table

EXAMPLES = """\
w2m evaluate reconstruction OUT my_trial                   all scores of the run in OUT
w2m evaluate reconstruction OUT my_trial --stages          also the loss of each stage
w2m evaluate reconstruction OUT my_trial --json scores.json
w2m evaluate reconstruction labels.npz my_trial            the result of another method
"""


def run(
    out: Annotated[Path, typer.Argument(help="Folder of a finished run, or a labels.npz.")],
    truth: Annotated[Path, typer.Argument(help="Folder with truth.npz and truth.json.")],
    stages: Annotated[
        bool,
        typer.Option(
            "--stages", help="Also replace the output of each stage by the truth and score."
        ),
    ] = False,
    json_path: Annotated[
        Path | None,
        typer.Option("--json", metavar="FILE", help="Also write all results to this file."),
    ] = None,
) -> None:
    """Score a reconstruction against the ground truth of the scanned room.

    Only cells that a noise-free ray of a used frame reached or crossed are scored. Results of
    another method are read from labels.npz: labels (uint8 X, Y, Z), voxel_m, origin_m and
    grid_to_scan (4x4, from the grid frame to the frame of the capture's poses). An objects.json in
    the same folder is a list of {class, center_m, size_m, yaw_deg}.
    """
    from rich.console import Console

    from world2minecraft.api import evaluate
    from world2minecraft.api.progress import show_progress
    from world2minecraft.core.files import write_json

    with show_progress() as progress:
        facts = evaluate(out, truth, stages=stages, progress=progress)
    console = Console(highlight=False)
    console.print(score_table(facts))
    if "calibration" in facts:
        console.print(reliability_table(facts["calibration"]["occupied"]))
    if stages:
        console.print(stage_table(facts))
    if json_path is not None:
        write_json(json_path, facts)
        print(f"results  {json_path}")
    if out.is_dir() and (out / "scan.json").is_file():
        print(next_step(out, truth, stages))


def score_table(facts: dict[str, Any]) -> "Table":
    """Return a table of the scores of a run, one per row."""
    from rich.table import Table

    table = Table("what", "score", box=None, header_style="bold", pad_edge=False)
    table.columns[1].justify = "right"
    for name, text in score_rows(facts):
        table.add_row(name, text)
    return table


def score_rows(facts: dict[str, Any]) -> list[tuple[str, str]]:
    """Return the names and values of the scores in print order."""
    from world2minecraft.core.classes import class_id, display_name

    surface, cells, objects = (
        facts[name] for name in ("surface_within_one_voxel", "occupancy", "objects")
    )
    frame = facts["frame_error"]
    rows = [
        ("surface within one voxel, precision", f"{surface['precision']:.3f}"),
        ("surface within one voxel, recall", f"{surface['recall']:.3f}"),
        ("free space recognised as free", f"{facts['free_recall']:.3f}"),
        ("IoU, exact", f"{cells['iou']:.3f}"),
        ("mIoU of 11 classes", f"{cells['miou']:.3f}"),
        ("mIoU of the classes present", f"{cells['miou_present_classes']:.3f}"),
        ("class accuracy of occupied cells", f"{cells['label_accuracy']:.3f}"),
        ("frame, tilt and yaw", f"{frame['tilt_deg']:.2f} deg, {frame['yaw_deg']:.2f} deg"),
        ("frame, floor", f"{100 * frame['floor_m']:+.1f} cm"),
    ]
    if "walls_x_m" in frame and "walls_y_m" in frame:
        walls = f"{100 * frame['walls_x_m']:+.1f} cm, {100 * frame['walls_y_m']:+.1f} cm"
        rows.append(("frame, walls along x and y", walls))
    rows += [(f"poses, {name}", _pose_text(poses)) for name, poses in facts["poses"].items()]
    if objects["true"]:
        rows.append(("object F1 (precision, recall)", _f1_text(objects)))
        rows += [
            (
                f"  {display_name(class_id(name))}",
                f"{row['matched']} of {row['true']}, {row['found']} found",
            )
            for name, row in objects["by_class"].items()
        ]
    else:
        rows.append(("objects", "not scored: the ground truth has none in view"))
    asked, right = objects["orientation_asked"], objects["orientation_hits"]
    if asked:
        rows.append(("orientation of chairs, sofas and beds correct", f"{right} of {asked}"))
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
    """Return a table of the accuracy of cells by confidence."""
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
    """Return a table of the scores with the output of each stage replaced by the ground truth."""
    from rich.table import Table

    names = ("truth after", "IoU", "mIoU", "object F1", "turned", "collisions", "in the world")
    table = Table(*names, box=None, header_style="bold", pad_edge=False)
    table.title, table.title_justify = "scores with ground truth after each stage", "left"
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


def next_step(out: Path, truth: Path, stages: bool) -> str:
    """Return the line with the next command."""
    if stages:
        return f"next: open {out / 'report.html'} in a browser"
    return f"next: w2m evaluate reconstruction {out} {truth} --stages"


def _pose_text(poses: dict[str, float]) -> str:
    return (
        f"{poses['mean_mm']:.1f} mm, {poses['mean_deg']:.2f} deg, "
        f"scale {poses['scale_rms_percent']:.2f} %"
    )


def _f1_text(counts: dict[str, Any]) -> str:
    return f"{counts['f1']:.3f} ({counts['precision']:.3f}, {counts['recall']:.3f})"
