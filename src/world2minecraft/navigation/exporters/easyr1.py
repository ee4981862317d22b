"""Export to EasyR1: Parquet rows, the format prompt, the reward, and the paper's GRPO recipe.

The output folder contains::

    mcvln_TASK_COMPOSITION_SPLIT.parquet   content, answer, images, id
    TASK_COMPOSITION_grpo.yaml             python3 -m verl.trainer.main config=THIS
    mc.jinja                               the prompt template, which inserts ``content``
    reward.py                              compute_score
    images/...                             if ``images`` are paths

EasyR1's loader splits a rendered prompt at ``<image>``, joins paths to ``image_dir``, silently
drops prompts that are too long, and drops the last incomplete batch.
"""

import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import UsageError
from world2minecraft.core.files import write_bytes, write_text
from world2minecraft.navigation.exporters.loader_checks import check_easyr1, parquet_modules
from world2minecraft.navigation.exporters.options import (
    TRAIN_SPLIT,
    ExportedFile,
    ExportOptions,
    ItemGroup,
    validation_group,
)
from world2minecraft.navigation.exporters.pictures import SetPictures
from world2minecraft.navigation.exporters.recipes import read_recipe, render_recipe
from world2minecraft.navigation.exporters.training_costs import (
    GRPO_BATCH,
    GRPO_EPOCHS,
    GRPO_ROLLOUTS,
    GrpoPlan,
    check_longest,
    grpo_plan,
    row_tokens,
)
from world2minecraft.navigation.item_prompts import question_of
from world2minecraft.navigation.types import Item

PROMPT_TOKENS, RESPONSE_TOKENS = 4096, 1024  # The paper's.
GPUS = 8  # The paper's node.
ROWS_A_GROUP = 256  # Rows per Parquet row group, whose embedded images are in memory at once.


def max_prompt_tokens(part: ItemGroup, pictures: SetPictures, rule: ExportOptions) -> int:
    """Return the maximum number of prompt tokens of a group of items.

    Args:
        part: The group of items.
        pictures: The images of the set.
        rule: The export options.

    Raises:
        MissingExtraError: If pyarrow is not installed.
        UsageError: If a row exceeds the limit of the recipe.
        InputError: If an image is missing or has changed.
    """
    parquet_modules("writing Parquet")
    form = read_recipe("mc.jinja")
    lengths = (
        (item, row_tokens(item, question_of(item), pictures, rule.max_pixels, form))
        for item in part.items
    )
    return check_longest(lengths, PROMPT_TOKENS, "a prompt")


def write_easyr1(
    root: Path,
    parts: Sequence[ItemGroup],
    pictures: SetPictures,
    rule: ExportOptions,
    tokens: Sequence[int],
) -> list[ExportedFile]:
    """Write the groups for EasyR1, and return the written files.

    Args:
        root: The output folder.
        parts: The groups of items.
        pictures: The images of the set.
        rule: The export options.
        tokens: The results of ``max_prompt_tokens`` by group.

    Raises:
        OutputError: If a file cannot be written.
    """
    written = []
    for part, most in zip(parts, tokens, strict=True):
        write_bytes(root / f"{part.name}.parquet", _parquet(part, pictures, rule))
        if rule.image_style == "paths":
            for name in (name for item in part.items for name in item.images):
                pictures.copy(name, root)
        recipe = ExportedFile(part.name, len(part.items))
        if part.split == TRAIN_SPLIT:
            recipe = _write_recipe(root, part, validation_group(parts, part), rule)
        written.append(
            ExportedFile(part.name, recipe.rows, recipe.command, recipe.steps, most, recipe.notes)
        )
    write_text(root / "mc.jinja", read_recipe("mc.jinja"))
    write_text(root / "reward.py", _reward())
    check_easyr1(root, "." if rule.image_style == "paths" else None)
    return written


def _parquet(part: ItemGroup, pictures: SetPictures, rule: ExportOptions) -> bytes:
    pa, pq = parquet_modules("writing Parquet")
    embedded = rule.image_style == "embedded"
    kind = pa.struct({"bytes": pa.binary(), "path": pa.string()}) if embedded else pa.string()
    schema = pa.schema(
        {"content": pa.string(), "answer": pa.string(), "images": pa.list_(kind), "id": pa.string()}
    )
    buffer = io.BytesIO()
    with pq.ParquetWriter(buffer, schema, compression="zstd") as writer:
        for start in range(0, len(part.items), ROWS_A_GROUP):
            rows = [
                _row(item, pictures if embedded else None)
                for item in part.items[start : start + ROWS_A_GROUP]
            ]
            writer.write_table(pa.Table.from_pylist(rows, schema))
    return buffer.getvalue()


def _row(item: Item, pictures: SetPictures | None) -> dict[str, Any]:
    question = question_of(item)
    images: list[Any] = list(question.images)
    if pictures is not None:
        images = [{"bytes": pictures.read(name), "path": name} for name in images]
    return {
        "content": question.text,
        "answer": question.answer,
        "images": images,
        "id": item.item_id,
    }


def _write_recipe(
    root: Path, part: ItemGroup, val: ItemGroup | None, rule: ExportOptions
) -> ExportedFile:
    rows, gpus, file = len(part.items), rule.gpus or GPUS, f"{part.stem}_grpo.yaml"
    try:
        plan = grpo_plan(rows, gpus)
    except UsageError as error:  # The other parts may have enough rows.
        return ExportedFile(
            part.name, rows, notes=(f"{part.name}: no recipe was written, because {error}",)
        )
    text = render_recipe(
        "easyr1_grpo.yaml",
        file=file,
        name=part.stem,
        rows=rows,
        plan=plan,
        gpus=gpus,
        train=f"{part.name}.parquet",
        val=f"{(val or part).name}.parquet",
        has_val=val is not None,
        val_batch=min(1024, len((val or part).items)),
        image_dir="." if rule.image_style == "paths" else "null",
        prompt_tokens=PROMPT_TOKENS,
        response_tokens=RESPONSE_TOKENS,
        seed=rule.seed,
        max_pixels=rule.max_pixels,
        model=rule.model,
        rollouts=GRPO_ROLLOUTS,
        most_images=max(len(item.images) for one in (part, val or part) for item in one.items),
        epochs=GRPO_EPOCHS,
    )
    write_text(root / file, text)
    command = f"python3 -m verl.trainer.main config={file}"
    return ExportedFile(part.name, rows, command, plan.steps, notes=_notes(part, val, plan))


def _notes(part: ItemGroup, val: ItemGroup | None, plan: GrpoPlan) -> tuple[str, ...]:
    notes = []
    if plan.batch < GRPO_BATCH:
        notes.append(
            f"{part.name}: {len(part.items)} rows are fewer than the paper's batch size of "
            f"{GRPO_BATCH}; the recipe uses a batch size of {plan.batch}"
        )
    if plan.left_out:
        notes.append(
            f"{part.name}: the loader drops the incomplete last batch, which is "
            f"{plan.left_out} of {len(part.items)} rows in each epoch (different rows each "
            "time)"
        )
    if val is None:
        notes.append(f"{part.name}: the set has no held-out items, so the recipe does not validate")
    return tuple(notes)


def _reward() -> str:
    return (Path(__file__).parent / "reward.py").read_text("utf-8")
