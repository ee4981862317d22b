"""Training costs: optimizer steps as in the trainers' own loops, and tokens per row for Qwen2.5-VL.

An image token represents 28 x 28 pixels (patches of 14 pixels, merged two by two). A text has at
most as many tokens as bytes, because the tokenizer is byte-level, so a row that fits by this upper
bound always fits.
"""

import math
import unicodedata
from collections.abc import Iterable
from dataclasses import dataclass

from world2minecraft.core.errors import UsageError
from world2minecraft.navigation.exporters.pictures import SetPictures
from world2minecraft.navigation.item_prompts import IMAGE, Question
from world2minecraft.navigation.types import Item

# From the paper's tables.
SFT_EPOCHS, SFT_BATCH, SFT_ACCUMULATED = 5, 1, 2
GRPO_EPOCHS, GRPO_BATCH, GRPO_ROLLOUTS = 30, 128, 5
PIXELS_A_TOKEN_SIDE = 28
MIN_PIXELS = 56 * 56  # Qwen2.5-VL's own processor enlarges smaller images
MAX_PIXELS = 14 * 14 * 4 * 1280  # and shrinks larger ones; the trainer's limit is lower.
CHAT_TOKENS = 64  # For system prompt, roles and ends of turns, 30 in the model's own template.


@dataclass(frozen=True)
class GrpoPlan:
    """The batch size and step counts of GRPO training.

    The loader shuffles the rows in each epoch and drops the incomplete last batch, so the dropped
    rows change from epoch to epoch.

    Attributes:
        batch: The number of prompts per step.
        steps_an_epoch: The number of steps per epoch.
        steps: The total number of steps.
        left_out: The number of rows dropped per epoch.
    """

    batch: int
    steps_an_epoch: int
    steps: int
    left_out: int


def sft_steps(rows: int, max_samples: int, gpus: int) -> int:
    """Return the number of optimizer steps of the SFT recipe.

    Example:
        >>> sft_steps(1151, 1000, 1), sft_steps(249, 1000, 8)
        (2500, 80)
    """
    used = min(rows, max_samples) if max_samples else rows
    batches = math.ceil(used / (gpus * SFT_BATCH))
    return math.ceil(batches / SFT_ACCUMULATED) * SFT_EPOCHS


def grpo_plan(rows: int, gpus: int) -> GrpoPlan:
    """Return the batch size and steps of EasyR1's GRPO training.

    The loader drops incomplete batches, and EasyR1's default batch size of 512 would leave no batch
    of the paper's Base set. The batch size is therefore the paper's 128, or less for fewer rows,
    and a multiple of the number of GPUs.

    Raises:
        UsageError: If there are fewer rows than GPUs.

    Example:
        >>> grpo_plan(249, 8)
        GrpoPlan(batch=128, steps_an_epoch=1, steps=30, left_out=121)
    """
    batch = min(GRPO_BATCH, rows) // gpus * gpus
    if batch == 0:
        raise UsageError(
            f"{rows} rows do not fill one batch on {gpus} GPUs; use {rows or 1} or fewer (--gpus)"
        )
    steps = rows // batch
    return GrpoPlan(batch, steps, steps * GRPO_EPOCHS, rows - steps * batch)


def image_tokens(width_px: int, height_px: int, max_pixels: int) -> int:
    """Return the number of tokens of an image, without the enclosing special tokens.

    Args:
        width_px: The image width in pixels.
        height_px: The image height in pixels.
        max_pixels: The number of pixels above which the trainer downscales an image.

    Example:
        >>> image_tokens(640, 360, 262_144), image_tokens(1280, 720, 262_144)
        (299, 336)
    """
    if width_px * height_px > max_pixels:
        factor = math.sqrt(max_pixels / (width_px * height_px))
        width_px, height_px = int(width_px * factor), int(height_px * factor)
    side = PIXELS_A_TOKEN_SIDE
    rows, columns = (max(1, round(length / side)) for length in (height_px, width_px))
    pixels = width_px * height_px
    if rows * columns * side * side > MAX_PIXELS:
        factor = math.sqrt(pixels / MAX_PIXELS)
        rows, columns = (max(1, int(n / factor / side)) for n in (height_px, width_px))
    elif rows * columns * side * side < MIN_PIXELS:
        factor = math.sqrt(MIN_PIXELS / pixels)
        rows, columns = (math.ceil(n * factor / side) for n in (height_px, width_px))
    return rows * columns


def row_tokens(
    item: Item, question: Question, pictures: SetPictures, max_pixels: int, more_text: str = ""
) -> int:
    """Return an upper bound of the number of tokens of an item's row.

    Args:
        item: The item.
        question: The question of the item.
        pictures: The images of the set.
        max_pixels: The number of pixels above which the trainer downscales an image.
        more_text: Additional text of the row.

    Raises:
        InputError: If an image is missing or has changed.
    """
    sizes = (pictures.size(name, item.sha256.get(name, "")) for name in question.images)
    shown = sum(image_tokens(*size, max_pixels) + 2 for size in sizes)
    text = unicodedata.normalize("NFC", question.text.replace(IMAGE, "") + more_text)
    return shown + len(text.encode()) + CHAT_TOKENS


def check_longest(lengths: Iterable[tuple[Item, int]], limit: int, what: str) -> int:
    """Return the maximum row length in tokens.

    Trainers silently truncate or drop rows that exceed the limit.

    Args:
        lengths: The number of tokens of each item.
        limit: The maximum number of tokens of a row.
        what: The name of the limit for the error message.

    Raises:
        UsageError: If a row exceeds the limit.
    """
    item, most = max(lengths, key=lambda pair: pair[1])
    if most > limit:
        raise UsageError(
            f"item {item.item_id} needs up to {most:,} tokens, more than the {limit:,} of "
            f"{what}; export with a lower pixel limit (--max-pixels)"
        )
    return most
