"""Score a network, an ONNX file or saved predictions: ``w2m evaluate occupancy``."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from world2minecraft.cli.json_output import JsonOutput
from world2minecraft.cli.panels import MORE
from world2minecraft.cli.train.options import Cache, Device

if TYPE_CHECKING:
    from rich.table import Table

EXAMPLES = """\
w2m evaluate occupancy RUN DATA                                 a run from w2m train
w2m evaluate occupancy net.onnx NYU --protocol monoscene        an exported network, on real NYUv2
w2m evaluate occupancy PREDICTED NYU --protocol ssc --protocol monoscene
w2m evaluate occupancy PRED.npz NYU0003_0000.bin                one frame
w2m evaluate occupancy saved OCC --protocol embodied            files of EmbodiedOcc or GPOcc
w2m evaluate occupancy scenes OCC --protocol embodied           grids of scenes as SCENE.npy
w2m evaluate occupancy RUN DATA --json                          print all results as JSON
w2m evaluate occupancy RUN DATA --json scores.json --latex rows.tex
"""


Predicted = Annotated[
    Path,
    typer.Argument(metavar="PRED_OR_NET",
                   help="Run folder, weights, an .onnx file, or saved predictions."),
]  # fmt: skip
Truth = Annotated[Path, typer.Argument(metavar="GT_OR_DATA", help="Any occupancy data set.")]
Protocols = Annotated[
    list[str] | None,
    typer.Option(
        "--protocol",
        help="monoscene, iso, embodied, ssc or visible. Repeatable.",
        show_default="all",
    ),
]
Split = Annotated[
    str,
    typer.Option(
        "--split", help="train, test or all.", show_default="test, or all without a test split"
    ),
]
Limit = Annotated[
    int | None,
    typer.Option("--limit", min=1, help="Maximum number of frames, selected evenly."),
]
Order = Annotated[
    str,
    typer.Option(
        "--order",
        help="Axes of saved predictions: xyz, xzy (NYUv2) or yxz.",
        show_default="from their shape",
        rich_help_panel=MORE,
    ),
]
Classes = Annotated[
    str,
    typer.Option(
        "--classes",
        help="Classes of saved predictions: ours, or embodied (12 is empty).",
        show_default="ours",
        rich_help_panel=MORE,
    ),
]
Labels = Annotated[
    Path | None,
    typer.Option("--labels", help="Folder with MonoScene's base/, if stored elsewhere (NYUv2)."),
]
Latex = Annotated[
    Path | None,
    typer.Option("--latex", metavar="FILE", help="Write the scores as LaTeX table rows."),
]
Seed = Annotated[
    int, typer.Option("--seed", help="Random seed of the intervals.", rich_help_panel=MORE)
]


def run(
    predicted: Predicted,
    truth: Truth,
    protocol: Protocols = None,
    split: Split = "",
    limit: Limit = None,
    order: Order = "",
    classes: Classes = "",
    labels: Labels = None,
    json_file: JsonOutput = None,
    latex: Latex = None,
    seed: Seed = 0,
    device: Device = "auto",
    cache: Cache = "",
) -> None:
    """Score occupancy predictions with published protocols and confidence intervals over scenes.

    docs/reference/occupancy-scores.md defines what each protocol counts and how it treats unknown
    cells.
    """
    from world2minecraft.api import evaluate_network
    from world2minecraft.api.networks import scores_latex
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.json_output import print_json, prints_json
    from world2minecraft.core.files import write_json, write_text

    with show_progress() as progress:
        scores = evaluate_network(
            predicted,
            truth,
            protocols=protocol or (),
            split=split,
            limit=limit,
            order=order,
            classes=classes,
            labels=labels,
            seed=seed,
            device=device,
            cache=cache,
            progress=progress,
        )
    if latex is not None:
        write_text(latex, scores_latex(scores, predicted.stem))
    if prints_json(json_file):
        print_json(scores)
        return
    _print_tables(scores)
    if json_file is not None:
        write_json(json_file, scores)
        print(f"figures  {json_file}")
    if latex is not None:
        print(f"rows     {latex}")
    if json_file is None:
        print("next: add --json scores.json to write all results and intervals")


def _print_tables(scores: dict[str, Any]) -> None:
    from rich.console import Console

    console = Console(highlight=False)
    console.print(score_table(scores))
    for table in (interval_table(scores), class_table(scores)):
        if table is not None:
            console.print(table)
    for name, reason in scores["left_out"].items():
        print(f"{name} skipped: {reason}")


def score_table(scores: dict[str, Any]) -> "Table":
    """Return a table of the micro scores by protocol, with macro IoU and mIoU."""
    rows = []
    for name, found in scores["protocols"].items():
        micro, macro = found["micro"], found["macro"]
        both = f"{_per_cent(macro['iou'])} / {_per_cent(macro['miou'])}"
        rows.append(
            (name, f"{found['frames']:,}", *(_per_cent(micro[key]) for key in _FIGURES), both)
        )
    head = ("protocol", "frames", "IoU", "precision", "recall", "mIoU", "macro")
    return _table("percent; macro: IoU / mIoU, averaged over frames", head, rows)


def interval_table(scores: dict[str, Any]) -> "Table | None":
    """Return a table of the intervals of the micro scores, or None if there is only one scene."""
    rows, scenes = [], 0
    for name, found in scores["protocols"].items():
        if found["interval"] is not None:
            ends = (found["interval"][key] for key in _FIGURES)
            rows.append((name, *(f"{100 * low:.1f}-{100 * high:.1f}" for low, high in ends)))
            scenes = max(scenes, found["scenes"])
    head = ("protocol", "IoU", "precision", "recall", "mIoU")
    return _table(f"95 % intervals over {scenes} scenes", head, rows) if rows else None


_FIGURES = ("iou", "precision", "recall", "miou")


def _table(title: str, head: tuple[str, ...], rows: list[tuple[str, ...]]) -> "Table":
    from rich.table import Table

    table = Table(*head, box=None, header_style="bold", pad_edge=False, title=title)
    table.title_justify = "left"
    for column in table.columns[1:]:
        column.justify = "right"
    for row in rows:
        table.add_row(*row)
    return table


def class_table(scores: dict[str, Any]) -> "Table":
    """Return a table of the IoU by class and protocol."""
    from world2minecraft.core.classes import CLASS_NAMES, display_name

    names = list(scores["protocols"])
    micro = {name: scores["protocols"][name]["micro"]["class_iou"] for name in names}
    rows = [
        (
            display_name(CLASS_NAMES.index(label)),
            *(_per_cent(micro[name][label]) for name in names),
        )
        for label in micro[names[0]]
    ]
    heads = ("class", *(name.replace(" ", "\n") for name in names))
    return _table("IoU of each class", heads, rows)


def _per_cent(value: float) -> str:
    return f"{100 * value:.2f}"
