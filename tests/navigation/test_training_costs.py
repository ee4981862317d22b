"""What an export tells before it runs: tokens, steps, the order of rows."""

from collections import Counter
from dataclasses import replace
from importlib import import_module

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.navigation.vln_sets import next_action, next_view

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.navigation.exporters.options import (
    ExportOptions,
    group_items,
    shuffle_items,
    validation_group,
)
from world2minecraft.navigation.exporters.training_costs import (
    GRPO_BATCH,
    MAX_PIXELS,
    MIN_PIXELS,
    grpo_plan,
    image_tokens,
    sft_steps,
)

sides = st.integers(28, 4000)


@given(sides, sides)
def test_a_picture_takes_the_tokens_of_qwens_own_processor(width, height):
    processor = import_module("transformers.models.qwen2_vl.image_processing_pil_qwen2_vl")
    rows, columns = processor.smart_resize(height, width, 28, MIN_PIXELS, MAX_PIXELS)
    if max(width, height) / min(width, height) < 100:
        assert image_tokens(width, height, 1 << 30) == rows * columns // 28**2


@given(sides, sides, st.integers(28 * 28, 1 << 22))
def test_the_trainers_limit_holds_but_for_the_rounding(width, height, max_pixels):
    tokens = image_tokens(width, height, max_pixels)
    ratio = max(width, height) / min(width, height)
    if ratio < 4 and max_pixels > 16 * MIN_PIXELS:
        assert tokens <= 1.2 * max_pixels / 28**2


def slow_sft_steps(rows, gpus):
    """Epochs of batches of one a GPU, an update after each second batch and after the last."""
    updates = 0
    for _ in range(5):
        left, waiting = rows, 0
        while left > 0:
            left, waiting = left - gpus, waiting + 1
            if waiting == 2 or left <= 0:
                updates, waiting = updates + 1, 0
    return updates


@given(st.integers(1, 3000), st.integers(1, 16), st.integers(0, 1200))
def test_sft_steps_are_those_of_the_loop(rows, gpus, max_samples):
    used = min(rows, max_samples) if max_samples else rows
    assert sft_steps(rows, max_samples, gpus) == slow_sft_steps(used, gpus)


@given(st.integers(1, 3000), st.integers(1, 16))
def test_a_grpo_plan_has_a_step_in_each_epoch(rows, gpus):
    if rows < gpus:
        with pytest.raises(UsageError, match=f"do not fill one batch on {gpus} GPUs"):
            grpo_plan(rows, gpus)
        return
    plan = grpo_plan(rows, gpus)
    assert plan.batch <= min(GRPO_BATCH, rows) and plan.batch % gpus == 0
    assert plan.steps == 30 * plan.steps_an_epoch >= 30
    assert plan.steps_an_epoch * plan.batch + plan.left_out == rows
    assert plan.left_out < plan.batch


def test_the_papers_own_sizes():
    # Base of Next-View has 249 rows: EasyR1's batch of 512 would leave none.
    assert grpo_plan(249, 8).steps == 30 and grpo_plan(594, 8).steps == 120
    assert [sft_steps(rows, 1000, 1) for rows in (249, 594, 902, 1042, 1151, 1636)] == [
        *(625, 1485, 2255),
        *(2500, 2500, 2500),
    ]


MANY = [
    replace(next_action("villa", step, composition=kind), item_id=f"{kind}-{number}-{step}")
    for kind in ("base", "extend")
    for number in range(40)
    for step in range(8)
]


def test_the_order_is_of_chance_and_of_nothing_else():
    order = shuffle_items(MANY, 0)
    assert order == shuffle_items(reversed(MANY), 0)
    assert order != shuffle_items(MANY, 1)
    assert sorted(item.item_id for item in order) == sorted(item.item_id for item in MANY)
    first = Counter(item.composition for item in order[:320])
    assert 120 < first["base"] < 200  # Of 320; a file that is not shuffled has all.


def test_combined_is_the_union_and_only_of_two():
    parts = group_items(MANY, ExportOptions())
    assert [(part.composition, len(part.items)) for part in parts] == [
        ("base", 320),
        ("extend", 320),
        ("combined", 640),
    ]
    alone = group_items([item for item in MANY if item.composition == "base"], ExportOptions())
    assert [part.composition for part in alone] == ["base"]


def test_scenes_not_seen_validate_before_ways_not_seen():
    items = [
        next_view(step=2),
        next_view("attic", 2, "val_seen"),
        next_view("barn", 2, "val_unseen"),
        next_action("barn", 2, "val_unseen"),
    ]
    parts = group_items(items, ExportOptions())
    assert validation_group(parts, parts[0]).name == "mcvln_next_view_base_val_unseen"
    parts = group_items(items[:2], ExportOptions())
    assert validation_group(parts, parts[0]).split == "val_seen"
    assert validation_group(parts[:1], parts[0]) is None


def test_a_set_without_what_is_wanted_is_told():
    with pytest.raises(UsageError) as caught:
        group_items(
            [next_view(step=2)], ExportOptions(tasks=("next_action",), compositions=("base",))
        )
    assert str(caught.value) == (
        "the set has no next_action items of composition base; it contains base next_view"
    )


@pytest.mark.parametrize(
    ("choice", "reason"),
    [
        ({"tasks": ("next_viev",)}, "no task is named 'next_viev'; did you mean 'next_view'?"),
        ({"compositions": ("all",)}, "no composition is named 'all'; known: base, combined, ext"),
        ({"image_style": "inline"}, "no image style is named 'inline'; known: embedded, paths"),
        ({"max_pixels": 5}, "the pixel limit (--max-pixels) must be 784 to 16777216, got 5"),
        ({"gpus": 0}, "gpus must be 1 to 4096, got 0"),
        ({"max_samples": -1}, "the row limit (--max-samples) must be 0 (all rows) or more, got -1"),
        (
            {"model": "a\nb"},
            ("model must be a model name such as Qwen/Qwen2.5-VL-3B-Instruct, or a folder"),
        ),
    ],
)
def test_choices_that_cannot_be_are_refused(choice, reason):
    with pytest.raises((UsageError, UnknownNameError)) as caught:
        ExportOptions(**choice)
    assert reason in str(caught.value)
