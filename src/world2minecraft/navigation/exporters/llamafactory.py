"""Export to LLaMA-Factory: sharegpt rows, ``dataset_info.json`` and the paper's SFT recipe.

The output folder contains::

    dataset_info.json          the names of the data sets, one per task, composition and split
    mcvln_TASK_COMPOSITION_SPLIT.json
    TASK_COMPOSITION_sft.yaml  llamafactory-cli train THIS
    ds_z3.json                 DeepSpeed ZeRO 3
    images/...

LLaMA-Factory's converter drops rows whose turns do not alternate, and fails late if the numbers of
placeholders and images differ. Relative image paths are resolved beside ``dataset_info.json``.
"""

import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from world2minecraft.core.files import write_json, write_text
from world2minecraft.navigation.exporters.loader_checks import check_llamafactory
from world2minecraft.navigation.exporters.options import (
    TRAIN_SPLIT,
    ExportedFile,
    ExportOptions,
    ItemGroup,
)
from world2minecraft.navigation.exporters.pictures import SetPictures
from world2minecraft.navigation.exporters.recipes import read_recipe, render_recipe
from world2minecraft.navigation.exporters.training_costs import (
    SFT_ACCUMULATED,
    SFT_BATCH,
    SFT_EPOCHS,
    check_longest,
    row_tokens,
    sft_steps,
)
from world2minecraft.navigation.item_prompts import LETTER_ALONE, question_of
from world2minecraft.navigation.types import Item

CUTOFF = 8192  # The paper's.
COLUMNS = {"messages": "messages", "images": "images"}
TAGS = {
    "role_tag": "role",
    "content_tag": "content",
    "user_tag": "user",
    "assistant_tag": "assistant",
}


def max_row_tokens(part: ItemGroup, pictures: SetPictures, rule: ExportOptions) -> int:
    """Return the maximum number of tokens of the rows of a group of items.

    Args:
        part: The group of items.
        pictures: The images of the set.
        rule: The export options.

    Raises:
        UsageError: If a row exceeds the limit of the recipe.
        InputError: If an image is missing or has changed.
    """
    lengths = (
        (item, row_tokens(item, question_of(item), pictures, rule.max_pixels, LETTER_ALONE))
        for item in part.items
    )
    return check_longest(lengths, CUTOFF, "cutoff_len")


def write_llamafactory(
    root: Path,
    parts: Sequence[ItemGroup],
    pictures: SetPictures,
    rule: ExportOptions,
    tokens: Sequence[int],
) -> list[ExportedFile]:
    """Write the groups for LLaMA-Factory, and return the written files.

    Args:
        root: The output folder.
        parts: The groups of items.
        pictures: The images of the set.
        rule: The export options.
        tokens: The results of ``max_row_tokens`` by group.

    Raises:
        OutputError: If a file cannot be written.
    """
    written = []
    for part, most in zip(parts, tokens, strict=True):
        _write_rows(root, part, pictures)
        recipe = (
            _write_recipe(root, part, rule) if part.split == TRAIN_SPLIT else ExportedFile("", 0)
        )
        written.append(
            ExportedFile(
                part.name, len(part.items), recipe.command, recipe.steps, most, recipe.notes
            )
        )
    write_json(root / "dataset_info.json", {part.name: _entry(part) for part in parts})
    write_text(root / "ds_z3.json", read_recipe("ds_z3.json"))
    check_llamafactory(root)
    return written


def row_of(item: Item) -> dict[str, Any]:
    """Return the sharegpt row of an item."""
    question = question_of(item)
    return {
        "messages": [
            {"role": "user", "content": f"{question.text}\n{LETTER_ALONE}"},
            {"role": "assistant", "content": question.answer},
        ],
        "images": list(question.images),
        "id": item.item_id,  # The converter ignores unknown columns.
    }


def rows_left_out(part: ItemGroup, rule: ExportOptions) -> tuple[str, ...]:
    """Return a note about the rows that ``max_samples`` omits, if any."""
    left_out = len(part.items) - rule.max_samples
    if not rule.max_samples or left_out <= 0:
        return ()
    return (
        (
            f"{part.name}: --max-samples {rule.max_samples} omits the same {left_out} rows in "
            "every epoch, as in the paper; use --max-samples 0 for all rows"
        ),
    )


def _write_rows(root: Path, part: ItemGroup, pictures: SetPictures) -> None:
    rows = []
    for item in part.items:
        rows.append(json.dumps(row_of(item), ensure_ascii=False))
        for name in item.images:
            pictures.copy(name, root)
    write_text(root / f"{part.name}.json", "[\n" + ",\n".join(rows) + "\n]\n")


def _entry(part: ItemGroup) -> dict[str, Any]:
    return {
        "file_name": f"{part.name}.json",
        "formatting": "sharegpt",
        "columns": COLUMNS,
        "tags": TAGS,
    }


def _write_recipe(root: Path, part: ItemGroup, rule: ExportOptions) -> ExportedFile:
    rows, gpus, file = len(part.items), rule.gpus or 1, f"{part.stem}_sft.yaml"
    steps = sft_steps(rows, rule.max_samples, gpus)
    used = min(rows, rule.max_samples) if rule.max_samples else rows
    text = render_recipe(
        "llamafactory_sft.yaml",
        file=file,
        rows=rows,
        used=used,
        steps=steps,
        warmup=math.ceil(0.1 * steps),
        gpus=gpus,
        model=rule.model,
        max_pixels=rule.max_pixels,
        dataset=part.name,
        cutoff=CUTOFF,
        max_samples=rule.max_samples,
        batch=SFT_BATCH,
        accumulated=SFT_ACCUMULATED,
        epochs=SFT_EPOCHS,
    )
    write_text(root / file, text)
    command = f"llamafactory-cli train {file}"
    return ExportedFile(part.name, rows, command, steps, notes=rows_left_out(part, rule))
