"""Our values for the rows of a table, from measurements, the program or the user.

Values that the program knows, such as the number of classes, are not repeated in documentation.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import yaml

from world2minecraft.minecraft.block_states import known_blocks
from world2minecraft.minecraftocc.block_map import load_block_map
from world2minecraft.minecraftocc.plan import PRESETS
from world2minecraft.navigation.data.item_building import PAPER_HELD, PAPER_SIZE
from world2minecraft.navigation.exporters import easyr1, llamafactory
from world2minecraft.navigation.exporters import training_costs as steps
from world2minecraft.navigation.exporters.options import ExportOptions
from world2minecraft.navigation.exporters.recipes import render_recipe
from world2minecraft.paper.table_reader import Ours, PaperRow, PaperTable, Results, measured

ROWS = 1151  # Of the paper's Combined, Next-View; a recipe is written for some number of rows.
SHOWN = 3  # Blocks and words that a cell names.
Rows = dict[str, Ours]


def known_to_the_program(table: PaperTable) -> Rows:
    """Return the rows of a table whose values come from the program's code, usually none."""
    makers: dict[str, Callable[[PaperTable], Rows]] = {
        "classes": _classes,
        "hyperparameters": _hyperparameters,
        "dataset-sizes": _sizes,
    }
    return makers[table.name](table) if table.name in makers else {}


def rft_recipe() -> dict[str, Any]:
    """Return the parsed recipe that ``w2m vln export --to easyr1`` writes."""
    rule, plan = ExportOptions(), steps.grpo_plan(ROWS, easyr1.GPUS)
    text = render_recipe(
        "easyr1_grpo.yaml",
        file="recipe", name="recipe", rows=ROWS, plan=plan, gpus=easyr1.GPUS, train="train",
        val="val", has_val=True, val_batch=1, image_dir=".", prompt_tokens=easyr1.PROMPT_TOKENS,
        response_tokens=easyr1.RESPONSE_TOKENS, seed=rule.seed, max_pixels=rule.max_pixels,
        model=rule.model, rollouts=steps.GRPO_ROLLOUTS, most_images=7, epochs=steps.GRPO_EPOCHS,
    )  # fmt: skip
    return yaml.safe_load(text)


def sft_recipe() -> dict[str, Any]:
    """Return the parsed recipe that ``w2m vln export --to llamafactory`` writes."""
    rule = ExportOptions()
    taken = steps.sft_steps(ROWS, rule.max_samples, 1)
    text = render_recipe(
        "llamafactory_sft.yaml",
        file="recipe", rows=ROWS, used=min(ROWS, rule.max_samples), steps=taken,
        warmup=math.ceil(0.1 * taken), gpus=1, model=rule.model, max_pixels=rule.max_pixels,
        dataset="rows", cutoff=llamafactory.CUTOFF, max_samples=rule.max_samples,
        batch=steps.SFT_BATCH, accumulated=steps.SFT_ACCUMULATED, epochs=steps.SFT_EPOCHS,
    )  # fmt: skip
    return yaml.safe_load(text)


def _hyperparameters(table: PaperTable) -> Rows:
    rft, sft = rft_recipe(), sft_recipe()
    actor, rollout = rft["worker"]["actor"], rft["worker"]["rollout"]
    batch, held = sft["per_device_train_batch_size"], sft["gradient_accumulation_steps"]
    found: dict[str, tuple[Any, Any]] = {
        "type": (None if actor["model"]["freeze_vision_tower"] else "full", sft["finetuning_type"]),
        "precision": (None, "bfloat16" if sft["bf16"] else None),
        "algorithm": (rft["algorithm"]["adv_estimator"], sft["stage"]),
        "optimizer": (actor["optim"]["strategy"], sft.get("optim", "the trainer's own")),
        "learning-rate": (actor["optim"]["lr"], sft["learning_rate"]),
        "weight-decay": (actor["optim"]["weight_decay"], sft.get("weight_decay")),
        "scheduler": (None, sft["lr_scheduler_type"]),
        "warmup": (actor["optim"]["lr_warmup_ratio"], sft["warmup_ratio"]),
        "epochs": (rft["trainer"]["total_epochs"], int(sft["num_train_epochs"])),
        "global-batch": (actor["global_batch_size"], None),
        "device-batch": (None, batch),
        "accumulation": (None, held),
        "effective-batch": (actor["global_batch_size"], batch * held),
        "kl": (rft["algorithm"]["kl_coef"], None),
        "rollouts": (rollout["n"], None),
        "temperature": (rollout["temperature"], None),
    }
    on, command = "the exported recipes", "w2m vln export SET --to easyr1 --out GRPO"
    return {
        key: Ours({"our-rft": _text(one), "our-sft": _text(other)}, on, command)
        for key, (one, other) in found.items()
    }


def _text(value: Any) -> str:
    """Format a value as in the paper.

    Example:
        >>> _text(1e-6), _text(0.1), _text(None), _text(30)
        ('1.0e-6', '0.1', '--', '30')
    """
    if value is None:
        return "--"
    if isinstance(value, float) and 0 < value < 0.1:
        return f"{value:.1e}".replace("e-0", "e-")
    return str(value)


def _classes(table: PaperTable) -> Rows:
    rules = load_block_map("paper")
    blocks: dict[str, list[str]] = {}
    for block in known_blocks():
        blocks.setdefault(rules.meaning(block), []).append(block.removeprefix("minecraft:"))
    words: dict[str, list[str]] = {}
    for group in rules.words:
        for word, meaning in group.meanings.items():
            words.setdefault(meaning, []).append(word)
    examples = list(table.columns).index("examples")
    on, command = "the built-in block map", "w2m dataset map --map paper --json paper.json"
    return {
        row.key: Ours(
            {
                "map": _meanings(rules, row.cells[examples].split()),
                "words": (
                    _some("block", blocks.get(row.key, [])) + _some("word", words.get(row.key, []))
                ).strip(),
            },
            on,
            command,
        )
        for row in table.rows
    }


def _meanings(rules: Any, blocks: list[str]) -> str:
    """Return the classes that a map assigns to blocks. A name may end in ``...`` as a wildcard."""
    found = (name for block in blocks for name in rules.classes_of(block.removesuffix("...")))
    return ", ".join(dict.fromkeys(found))


def _some(what: str, names: list[str]) -> str:
    """Return the first names and the number of the others as a sentence."""
    if not names:
        return ""
    more = f" and {len(names) - SHOWN} more" if len(names) > SHOWN else ""
    return f"{what.capitalize()}s: {', '.join(names[:SHOWN])}{more}. "


def _sizes(table: PaperTable) -> Rows:
    on = "the sizes of the built-in presets"
    rows = {
        f"occ-{name}": Ours(
            _counts(one.train, one.test), on, f"w2m dataset build DATA --preset {name}"
        )
        for name, one in PRESETS.items()
    }
    parts = {(c, t): (PAPER_SIZE[t, c], PAPER_HELD[t, c]) for t, c in PAPER_SIZE}
    for task in {t for t, _ in PAPER_SIZE}:
        both = [parts[c, task] for c in ("base", "extend")]
        parts["combined", task] = (sum(one for one, _ in both), sum(held for _, held in both))
    command = "w2m vln build --rooms 15 --houses 5 --paper-size --paper-split --out SET"
    for (composition, task), (count, held) in parts.items():
        key = f"{composition}-{task.replace('_', '-')}"
        rows[key] = Ours(
            _counts(count - held, held),
            f"{on}, with the paper's swapped Base and Extend rows corrected",
            command,
        )
    return rows


def _counts(train: int, test: int) -> dict[str, str]:
    return {"train": f"{train:,}", "test": f"{test:,}", "all": f"{train + test:,}"}


def fill_table(
    table: PaperTable, results: Results | None = None
) -> tuple[PaperTable, dict[str, Ours]]:
    """Combine a table with our values by row key, adding rows that the user's results define.

    A row in ``results`` replaces our row completely, so that no row mixes two measurements.
    """
    own = (results or {}).get(table.name, {})
    ours = {**known_to_the_program(table), **measured().get(table.name, {}), **own}
    known = {row.key for row in table.rows}
    new = tuple(_new(key, ours[key].label, table) for key in own if key not in known)
    return replace(table, rows=(*table.rows, *new)), ours


def _new(key: str, label: str, table: PaperTable) -> PaperRow:
    cells = [part.strip() for part in label.split("|")][: table.stub]
    return PaperRow(key, (*cells, *[""] * (len(table.columns) - len(cells))), {}, is_printed=False)
