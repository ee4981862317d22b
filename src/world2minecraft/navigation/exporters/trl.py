"""Export to TRL: JSONL rows with typed content, and scripts with the paper's two recipes.

The output folder contains::

    mcvln_TASK_COMPOSITION_SPLIT.jsonl   prompt, completion, images, answer, id
    sft.py, grpo.py                      python sft.py mcvln_TASK_COMPOSITION_train.jsonl
    reward.py
    images/...

The texts equal those of the other exports, so SFT has the same losses as with LLaMA-Factory.
"""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from world2minecraft.core.files import write_text
from world2minecraft.navigation.exporters.easyr1 import GPUS, RESPONSE_TOKENS
from world2minecraft.navigation.exporters.llamafactory import rows_left_out
from world2minecraft.navigation.exporters.loader_checks import check_trl
from world2minecraft.navigation.exporters.options import (
    TRAIN_SPLIT,
    ExportedFile,
    ExportOptions,
    ItemGroup,
)
from world2minecraft.navigation.exporters.pictures import SetPictures
from world2minecraft.navigation.exporters.recipes import read_recipe, render_recipe
from world2minecraft.navigation.exporters.training_costs import (
    GRPO_BATCH,
    GRPO_EPOCHS,
    GRPO_ROLLOUTS,
    SFT_ACCUMULATED,
    SFT_BATCH,
    SFT_EPOCHS,
    sft_steps,
)
from world2minecraft.navigation.item_prompts import LETTER_ALONE, question_of
from world2minecraft.navigation.types import Item


def write_trl(
    root: Path,
    parts: Sequence[ItemGroup],
    pictures: SetPictures,
    rule: ExportOptions,
    tokens: Sequence[int],
) -> list[ExportedFile]:
    """Write the groups for TRL, and return the written files.

    Args:
        root: The output folder.
        parts: The groups of items.
        pictures: The images of the set.
        rule: The export options.
        tokens: The results of ``llamafactory.max_row_tokens`` by group, which apply here as well.

    Raises:
        OutputError: If a file cannot be written.
    """
    written = []
    for part, most in zip(parts, tokens, strict=True):
        lines = [json.dumps(row_of(item), ensure_ascii=False) + "\n" for item in part.items]
        write_text(root / f"{part.name}.jsonl", "".join(lines))
        for name in (name for item in part.items for name in item.images):
            pictures.copy(name, root)
        is_train = part.split == TRAIN_SPLIT
        steps = sft_steps(len(part.items), rule.max_samples, 1) if is_train else 0
        command = f"python sft.py {part.name}.jsonl" if is_train else ""
        notes = rows_left_out(part, rule) if is_train else ()
        written.append(ExportedFile(part.name, len(part.items), command, steps, most, notes))
    _write_scripts(root, next((p for p in parts if p.split == TRAIN_SPLIT), parts[0]), rule)
    check_trl(root)
    return written


def row_of(item: Item) -> dict[str, Any]:
    """Return the row of an item: a prompt with typed parts, the answer and the image paths."""
    question = question_of(item)
    content = [
        {"type": "text", "text": value} if kind == "text" else {"type": "image"}
        for kind, value in question.parts
    ]
    ending = f"\n{LETTER_ALONE}"
    if content[-1]["type"] == "text":
        content[-1]["text"] += ending
    else:
        content.append({"type": "text", "text": ending})
    return {
        "prompt": [{"role": "user", "content": content}],
        "completion": [
            {"role": "assistant", "content": [{"type": "text", "text": question.answer}]}
        ],
        "images": list(question.images),
        "answer": question.answer,
        "id": item.item_id,
    }


def _write_scripts(root: Path, example: ItemGroup, rule: ExportOptions) -> None:
    gpus = rule.gpus or GPUS
    common = {
        "example": f"{example.name}.jsonl",
        "model": rule.model,
        "max_pixels": rule.max_pixels,
    }
    sft = render_recipe(
        "trl_sft.py",
        **common,
        max_samples=rule.max_samples,
        epochs=SFT_EPOCHS,
        batch=SFT_BATCH,
        accumulated=SFT_ACCUMULATED,
    )
    grpo = render_recipe(
        "trl_grpo.py",
        **common,
        gpus=gpus,
        epochs=GRPO_EPOCHS,
        batch=GRPO_BATCH,
        rollouts=GRPO_ROLLOUTS,
        response_tokens=RESPONSE_TOKENS,
        letter_alone=LETTER_ALONE,
        form=read_recipe("mc.jinja").strip().splitlines()[-1],
    )
    write_text(root / "sft.py", sft)
    write_text(root / "grpo.py", grpo)
    write_text(root / "reward.py", (Path(__file__).parent / "reward.py").read_text("utf-8"))
