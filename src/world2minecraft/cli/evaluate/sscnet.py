"""Score one frame by SSCNet's protocol: ``w2m evaluate sscnet``."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from world2minecraft.cli.json_output import JsonOutput
from world2minecraft.cli.panels import MORE

if TYPE_CHECKING:
    from rich.table import Table

EXAMPLES = """\
w2m evaluate sscnet NYU0001_0000.png NYU0001_0000.bin       complete the depth image and score it
w2m evaluate sscnet pred.npz NYU0001_0000.bin               labels from w2m occupy or other methods
w2m evaluate sscnet OUT NYU0001_0000.bin                    a run of w2m reconstruct on this frame
w2m evaluate sscnet NYU0001_0000.png NYUtest --json scores.json
"""


def run(
    predicted: Annotated[
        Path,
        typer.Argument(metavar="RUN_OR_GRID",
                       help="Depth PNG to complete, saved labels, or a run folder."),
    ],
    truth: Annotated[
        Path, typer.Argument(help="SSCNet .bin with NAME.png beside it, or any set with depth.")
    ],
    colour: Annotated[
        Path | None, typer.Option("--colour", help="Photo from the camera of the depth PNG.")
    ] = None,
    labels: Annotated[
        Path | None,
        typer.Option(
            "--labels", help="Folder with MonoScene's base/, if stored elsewhere (NYUv2)."
        ),
    ] = None,
    depth_code: Annotated[
        str,
        typer.Option(
            "--depth-code",
            help="Depth encoding of the PNG: auto, rotated, mm or 8000.",
            rich_help_panel=MORE,
        ),
    ] = "auto",
    json_file: JsonOutput = None,
) -> None:  # fmt: skip
    """Score the completion of one frame by SSCNet's protocol.

    Cells outside the image or the room, and cells that the depth image shows to be empty, are not
    scored. IoU is computed on hidden and surface cells, and on hidden cells alone as in SSCNet's
    paper; classes are scored on hidden and surface cells.
    """
    from rich.console import Console

    from world2minecraft.api.networks import evaluate_frame
    from world2minecraft.cli.json_output import print_json, prints_json
    from world2minecraft.core.files import write_json

    scores = evaluate_frame(predicted, truth, colour=colour, labels=labels, depth_code=depth_code)
    if prints_json(json_file):
        print_json(scores)
        return
    console = Console(highlight=False)
    console.print(score_table(scores))
    if json_file is not None:
        write_json(json_file, scores)
        print(f"figures  {json_file}")
    print(
        "next: w2m evaluate occupancy PREDICTIONS DATA --protocol ssc     scores a whole data set"
    )


def score_table(scores: dict[str, Any]) -> "Table":
    """Return a table of the scores of a frame in percent."""
    from rich.table import Table

    from world2minecraft.core.classes import CLASS_NAMES, display_name

    table = Table("percent", "score", box=None, header_style="bold", pad_edge=False)
    table.title, table.title_justify = scores["frame"], "left"
    table.columns[1].justify = "right"
    for key, cells in (("completion", "hidden and surface"), ("completion_hidden", "hidden")):
        for name, title in (("iou", "IoU"), ("precision", "precision"), ("recall", "recall")):
            table.add_row(f"{title}, {cells} cells", _per_cent(scores[key][name]))
    for key, title in (
        ("miou", "mIoU of 11 classes"),
        ("miou_with_empty", "mIoU of 12 classes, with empty"),
        ("miou_present_classes", "mIoU of the classes present"),
    ):
        table.add_row(title, _per_cent(scores[key]))
    for label, value in scores["class_iou"].items():
        table.add_row(f"  {display_name(CLASS_NAMES.index(label))}", _per_cent(value))
    return table


def _per_cent(value: float) -> str:
    return f"{100 * value:.2f}"
