"""``w2m vln export``: write a navigation set for trainers and simulators."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.api.navigation import ExportResult

EXAMPLES = """\
w2m vln export SET --to llamafactory -o SFT            rows, dataset_info.json and the SFT recipe
w2m vln export SET --to easyr1 -o GRPO                 parquet, mc.jinja, reward.py and the recipe
w2m vln export SET --to trl -o TRL                     rows and two plain scripts
w2m vln export SET --to vlnce -o data/datasets/mc      episodes for VLN-CE
w2m vln export SET --to r2r -o R2R                     paths in the format of R2R
w2m vln export SET --to llamafactory --task next_view --composition base -o NV
"""


Source = Annotated[Path, typer.Argument(help="A set of w2m vln build.")]
To = Annotated[str, typer.Option("--to", help="llamafactory, easyr1, trl, vlnce or r2r.")]
Out = Annotated[Path, typer.Option("--out", "-o", help="Write to this folder.")]
TaskName = Annotated[
    str | None,
    typer.Option("--task", help="next_view or next_action alone.", show_default="both"),
]
Composition = Annotated[
    str | None,
    typer.Option("--composition", help="base, extend or combined alone.", show_default="all three"),
]
Model = Annotated[
    str | None,
    typer.Option(
        "--model",
        help="The model to tune: a name on the hub, or a path.",
        show_default="Qwen/Qwen2.5-VL-3B-Instruct",
    ),
]
MaxSamples = Annotated[
    int | None,
    typer.Option(
        "--max-samples", min=0, help="Rows of one SFT run; 0 for all.", show_default="1000"
    ),
]
Gpus = Annotated[
    int | None,
    typer.Option("--gpus", min=1, help="GPUs of the recipe.", show_default="1 for SFT, 8 for GRPO"),
]
MaxPixels = Annotated[
    int | None,
    typer.Option("--max-pixels", help="Trainers reduce larger pictures.", show_default="262144"),
]
Images = Annotated[
    str | None,
    typer.Option(
        "--images", help="easyr1: paths, or embedded in the parquet file.", show_default="paths"
    ),
]
Seed = Annotated[
    int | None, typer.Option("--seed", help="The seed of the order of rows.", show_default="0")
]


def run(
    source: Source,
    to: To,
    out: Out,
    task: TaskName = None,
    composition: Composition = None,
    model: Model = None,
    max_samples: MaxSamples = None,
    gpus: Gpus = None,
    max_pixels: MaxPixels = None,
    images: Images = None,
    seed: Seed = None,
) -> None:
    """Write a set for LLaMA-Factory, EasyR1, TRL or VLN-CE, or as R2R's JSON.

    Each folder has the rows, the pictures, the paper's recipe and the command that runs it; the
    number of training steps is printed. docs/vln-finetuning.md has more.
    """
    from world2minecraft.api import export_navigation_set
    from world2minecraft.api.progress import show_progress

    with show_progress() as progress:
        result = export_navigation_set(
            source,
            out,
            to,
            task=task,
            composition=composition,
            model=model,
            max_samples=max_samples,
            gpus=gpus,
            max_pixels=max_pixels,
            images=images,
            seed=seed,
            progress=progress,
        )
    _print_summary(result)


def _print_summary(result: "ExportResult") -> None:
    for one in result.written:
        steps = f", {one.steps:,} steps" if one.steps else ""
        tokens = f", at most {one.tokens:,} tokens a row" if one.tokens else ""
        print(f"{one.name}: {one.rows:,} rows{tokens}{steps}")
    for note in result.notes:
        print(f"note: {note}")
    commands = [one.command for one in result.written if one.command]
    if commands:
        print(f"next: cd {result.out} && {commands[0]}")
    else:
        print(f"next: read {result.out / 'README.md'}")
