"""``w2m compare layouts``: what lies outside, collides or is missing, method by method."""

from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.cli.compare import options as option

EXAMPLES = """\
w2m compare layouts gpt4.bedroom.k-similar.k_8.px_regular.json      what LayoutGPT publishes
w2m compare layouts scene_graph.json                                I-Design
w2m compare layouts RESULT/layout.json --task room.json --assets ASSETS    LayoutVLM
w2m compare layouts OUT --truth MY_SCAN                             a reconstruction of ours
w2m compare layouts gpt.json scene_graph.json OUT --truth MY_SCAN --json compared.json
"""

Paths = Annotated[
    list[Path],
    typer.Argument(
        metavar="LAYOUT...", help="Layouts of LayoutGPT, I-Design or LayoutVLM, folders of "
        "w2m compare build, or finished runs.", show_default=False,
    ),
]  # fmt: skip
Truth = Annotated[
    Path | None,
    typer.Option(
        "--truth", metavar="SCENE", help="The true scene, for semantic integrity: a scan of "
        "w2m rooms scan, or a mended run. Of a scan, runs are held to its rooms, too.",
    ),
]  # fmt: skip
Scenes = Annotated[bool, typer.Option("--scenes", help="A row a scene, not a method.")]
Json = Annotated[
    Path | None, typer.Option("--json", metavar="FILE", help="Write every figure here, too.")
]
Markdown = Annotated[bool, typer.Option("--markdown", help="As Markdown tables.")]


def run(
    paths: Paths,
    truth: Truth = None,
    scenes: Scenes = False,
    layout_format: option.Format = "",
    px_m: option.PxM = option.DEFAULT_PX_M,
    task: option.Task = None,
    assets: option.Assets = None,
    json_path: Json = None,
    markdown: Markdown = False,
) -> None:
    """Score layouts of rooms, whoever made them, by one rule.

    Boxes are looked at before they become blocks. What counts as outside and as a collision stands
    in docs/layout-baselines.md; the rules of others stand in a second table.

    Raises:
        InputError: a layout cannot be read. UsageError: an option is wrong.
    """
    from world2minecraft.api.progress import show_progress
    from world2minecraft.core.files import write_json
    from world2minecraft.navigation.running.result_tables import format_markdown, format_text
    from world2minecraft.paper.layouts import score_scene, summary_of
    from world2minecraft.paper.layouts.importers import How, read_layouts_of
    from world2minecraft.paper.layouts.reference_scene import is_truth, true_scene
    from world2minecraft.paper.layouts.score_table import (
        NOTES,
        by_method,
        layout_table,
        other_table,
    )

    option.check_px(px_m)
    known = score_scene(true_scene(truth)) if truth is not None else None
    how = How(px_m, task, assets, truth if truth is not None and is_truth(truth) else None)
    found = [one for path in paths for one in read_layouts_of(path, how, layout_format)]
    scored = []
    with show_progress() as progress:
        for done, scene in enumerate(found):
            progress("layouts", done, len(found), scene.name)
            scored.append((scene.name if scenes else scene.method, score_scene(scene)))
        progress("layouts", len(found), len(found))
    told = {name: summary_of(some, [known] * len(some) if known else ())
            for name, some in by_method(scored).items()}  # fmt: skip
    write = format_markdown if markdown else format_text
    print(write(layout_table(told)), write(other_table(told)), "\n".join(NOTES), sep="\n\n")
    option.print_skipped(found)
    if json_path is not None:
        write_json(json_path, told)
        print(f"figures  {json_path}")
    runs = [scene for scene in found if scene.collided is not None]
    if how.truth is None and runs:
        print("note: a run was held to the rooms that it found itself; --truth SCAN holds it to "
              "the true ones")  # fmt: skip
    step = f"w2m compare judge {paths[0]} --agent gemini --out JUDGED   to have it graded"
    if len(runs) < len(found):
        step = f"w2m compare build {paths[0]} --out BUILT   to see them as blocks"
    print(f"\nnext: {step}")
