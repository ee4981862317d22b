"""``w2m vln export``: a set of navigation data as trainers and simulators read it."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.navigation.exporters import ExportResult

EXAMPLES = """\
w2m vln export SET --to llamafactory --out SFT         rows, dataset_info.json and the SFT recipe
w2m vln export SET --to easyr1 --out GRPO              parquet, mc.jinja, reward.py and the recipe
w2m vln export SET --to trl --out TRL                  rows and two plain scripts
w2m vln export SET --to vlnce --out data/datasets/mc   episodes for VLN-CE
w2m vln export SET --to r2r --out R2R                  paths as R2R writes them
w2m vln export SET --to llamafactory --task next_view --composition base --out NV
"""


def run(
    source: Annotated[Path, typer.Argument(help="The folder of a set, of w2m vln build.")],
    to: Annotated[str, typer.Option("--to", help="llamafactory, easyr1, trl, vlnce or r2r.")],
    out: Annotated[Path, typer.Option("--out", help="The folder to write.")],
    task: Annotated[
        str | None, typer.Option("--task", help="next_view or next_action alone.")
    ] = None,
    composition: Annotated[
        str | None, typer.Option("--composition", help="base, extend or combined alone.")
    ] = None,
    model: Annotated[
        str | None, typer.Option("--model", help="What is tuned: a name on the hub, or a path.")
    ] = None,
    max_samples: Annotated[
        int | None,
        typer.Option(
            "--max-samples", min=0, help="Rows of one SFT run; 1000 as the paper; 0: all."
        ),
    ] = None,
    gpus: Annotated[
        int | None, typer.Option("--gpus", min=1, help="Of the recipe: 1 for SFT, 8 for GRPO.")
    ] = None,
    max_pixels: Annotated[
        int | None, typer.Option("--max-pixels", help="Trainers shrink what has more; 262144.")
    ] = None,
    images: Annotated[
        str | None, typer.Option("--images", help="easyr1: paths, or embedded in the parquet.")
    ] = None,
    seed: Annotated[int | None, typer.Option("--seed", help="Of the order of rows; 0.")] = None,
) -> None:
    """Write a set for LLaMA-Factory, EasyR1, TRL, VLN-CE, or as R2R's JSON.

    Each folder has the rows, the pictures, the paper's recipe and the command that runs it; the
    steps that it will take are told here, before a GPU is rented. docs/vln-finetuning.md has more.
    """
    from world2minecraft.api.progress import show_progress
    from world2minecraft.navigation.exporters import ExportOptions, export_set

    choices = {
        "tasks": None if task is None else (task,),
        "compositions": None if composition is None else (composition,),
        "model": model,
        "max_samples": max_samples,
        "gpus": gpus,
        "max_pixels": max_pixels,
        "image_style": images,
        "seed": seed,
    }
    rule = ExportOptions(**{name: value for name, value in choices.items() if value is not None})
    with show_progress() as progress:
        handoff = export_set(source, to, out, rule, progress=progress)
    _print_summary(handoff)


def _print_summary(handoff: "ExportResult") -> None:
    for one in handoff.written:
        steps = f", {one.steps:,} steps" if one.steps else ""
        tokens = f", at most {one.tokens:,} tokens a row" if one.tokens else ""
        print(f"{one.name}: {one.rows:,} rows{tokens}{steps}")
    for note in handoff.notes:
        print(f"note: {note}")
    commands = [one.command for one in handoff.written if one.command]
    if commands:
        print(f"next: cd {handoff.out} && {commands[0]}")
    else:
        print(f"next: read {handoff.out / 'README.md'}")
