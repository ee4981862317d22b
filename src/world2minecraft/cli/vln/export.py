"""Export a navigation set for trainers and simulators: ``w2m vln export``."""

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


Source = Annotated[Path, typer.Argument(help="Navigation set from w2m vln build.")]
To = Annotated[str, typer.Option("--to", help="llamafactory, easyr1, trl, vlnce or r2r.")]
Out = Annotated[Path, typer.Option("--out", "-o", help="Output folder.")]
TaskName = Annotated[
    str | None,
    typer.Option("--task", help="Export only next_view or next_action.", show_default="both"),
]
Composition = Annotated[
    str | None,
    typer.Option(
        "--composition", help="Export only base, extend or combined.", show_default="all three"
    ),
]
Model = Annotated[
    str | None,
    typer.Option(
        "--model",
        help="Model to fine-tune: a Hugging Face name or a path.",
        show_default="Qwen/Qwen2.5-VL-3B-Instruct",
    ),
]
MaxSamples = Annotated[
    int | None,
    typer.Option(
        "--max-samples",
        min=0,
        help="Number of rows in an SFT run, or 0 for all.",
        show_default="1000",
    ),
]
Gpus = Annotated[
    int | None,
    typer.Option(
        "--gpus", min=1, help="Number of GPUs in the recipe.", show_default="1 for SFT, 8 for GRPO"
    ),
]
MaxPixels = Annotated[
    int | None,
    typer.Option(
        "--max-pixels", help="Image size above which trainers downscale.", show_default="262144"
    ),
]
Images = Annotated[
    str | None,
    typer.Option(
        "--images",
        help="easyr1 only: paths, or embedded in the parquet file.",
        show_default="paths",
    ),
]
Seed = Annotated[
    int | None, typer.Option("--seed", help="Random seed of the row order.", show_default="0")
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
    """Export a set for LLaMA-Factory, EasyR1, TRL or VLN-CE, or as JSON in the R2R format.

    Each output folder contains the rows, the images, the paper's recipe and the command to run it.
    The number of training steps is printed. See docs/how-to/export-for-fine-tuning.md.
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
