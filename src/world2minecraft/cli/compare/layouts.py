"""Score layouts of any method for collisions and missing objects: ``w2m compare layouts``."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli.compare import options as option
from world2minecraft.cli.json_output import JsonOutput

if TYPE_CHECKING:
    from world2minecraft.api.comparison import LayoutScores

EXAMPLES = """\
w2m compare layouts gpt4.bedroom.k-similar.k_8.px_regular.json      results published by LayoutGPT
w2m compare layouts scene_graph.json                                I-Design
w2m compare layouts RESULT/layout.json --task room.json --assets ASSETS    LayoutVLM
w2m compare layouts OUT --truth MY_SCAN                             a reconstruction
w2m compare layouts gpt.json scene_graph.json OUT --truth MY_SCAN --json
"""

Paths = Annotated[
    list[Path],
    typer.Argument(
        metavar="LAYOUT...", help="Layouts of LayoutGPT, I-Design or LayoutVLM, folders from "
        "w2m compare build, or finished runs.", show_default=False,
    ),
]  # fmt: skip
Truth = Annotated[
    Path | None,
    typer.Option(
        "--truth", metavar="SCENE", help="True scene for semantic integrity: a scan from w2m rooms "
        "scan, or a repaired run. Runs are also scored within the rooms of a scan.",
    ),
]  # fmt: skip
Scenes = Annotated[bool, typer.Option("--scenes", help="Print one row per scene.")]
Markdown = Annotated[bool, typer.Option("--markdown", help="Print Markdown tables.")]


def run(
    paths: Paths,
    truth: Truth = None,
    scenes: Scenes = False,
    layout_format: option.Format = "",
    px_m: option.PxM = option.DEFAULT_PX_M,
    task: option.Task = None,
    assets: option.Assets = None,
    json_path: JsonOutput = None,
    markdown: Markdown = False,
) -> None:
    """Score room layouts of any method with the same rules.

    Bounding boxes are scored before they are converted to blocks.
    docs/results/layout-baselines.md defines out of bounds and collisions. A second table uses the
    rules of other methods.

    Raises:
        InputError: If a layout cannot be read.
        UsageError: If an option is invalid.
    """
    from world2minecraft.api.comparison import score_layouts
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.json_output import print_json, prints_json
    from world2minecraft.core.files import write_json

    _check_target(json_path)
    with show_progress() as progress:
        found = score_layouts(
            paths,
            truth=truth,
            by_scene=scenes,
            format=layout_format,
            px_m=px_m,
            task=task,
            assets=assets,
            progress=progress,
        )
    if prints_json(json_path):
        print_json(found.scores)
        return
    _print_tables(found, markdown)
    if json_path is not None:
        write_json(json_path, found.scores)
        print(f"figures  {json_path}")
    _print_next(found, paths[0])


def _check_target(json_path: Path | None) -> None:
    """Raise UsageError if the file named after ``--json`` is a layout."""
    from world2minecraft.api.comparison import is_layout
    from world2minecraft.core.errors import UsageError

    if json_path is not None and json_path.is_file() and is_layout(json_path):
        raise UsageError(f"--json would overwrite the layout {json_path}; move --json to the end")


def _print_tables(found: "LayoutScores", markdown: bool) -> None:
    from world2minecraft.api.agents import table_text

    tables = [table_text(one, markdown=markdown) for one in found.tables()]
    print(*tables, "\n".join(found.notes()), sep="\n\n")
    option.print_skipped(found.skipped)


def _print_next(found: "LayoutScores", first: Path) -> None:
    if found.runs and not found.uses_true_rooms:
        print(
            "note: runs were scored within their reconstructed rooms; add --truth SCAN to use "
            "the true rooms"
        )
    step = f"w2m compare judge {first} --agent gemini --out JUDGED   to grade it"
    if found.runs < found.scenes:
        step = f"w2m compare build {first} --out BUILT   to build them as blocks"
    print(f"\nnext: {step}")
