"""The reward of an answer for EasyR1 and TRL: 90 percent accuracy and 10 percent format.

This file is self-contained. Exports copy it beside the data, and trainers import it from there.
"""

import re
from typing import Any

REWARD_NAME = "minecraft_vln"
REWARD_TYPE = "batch"
FORMAT_WEIGHT = 0.1

_FORM = re.compile(r"\s*<think>.*?</think>\s*<answer>\s*\(?[A-H]\)?\.?\s*</answer>\s*", re.DOTALL)
_LETTER = re.compile(r"\(?([A-Ha-h])\)?(?:[.:)]|\s|$)")


def answered(response: str) -> str:
    """Return the letter within the last ``<answer>`` tag of a response, or ""."""
    end = response.rfind("</answer>")
    start = response.rfind("<answer>", 0, max(end, 0))
    letter = _LETTER.match(response[start + len("<answer>") : end].strip()) if start >= 0 else None
    return letter.group(1).upper() if letter else ""


def score(
    response: str, ground_truth: str, format_weight: float = FORMAT_WEIGHT
) -> dict[str, float]:
    """Return the reward ``overall`` with its parts ``format`` and ``accuracy``, each 0 to 1.

    Args:
        response: The reply of the model.
        ground_truth: The letter of the correct option.
        format_weight: The weight of the format reward.
    """
    accuracy = float(answered(response) == ground_truth.strip().upper())
    form = float(_FORM.fullmatch(response) is not None)
    overall = (1 - format_weight) * accuracy + format_weight * form
    return {"overall": overall, "format": form, "accuracy": accuracy}


def compute_score(reward_inputs: Any, format_weight: float = FORMAT_WEIGHT) -> Any:
    """Compute the rewards of a batch, or of a single response for older versions of EasyR1.

    Args:
        reward_inputs: A list of {"response", "response_length", "ground_truth"}, or one such entry.
        format_weight: The weight of the format reward.
    """
    if isinstance(reward_inputs, dict):
        return compute_score([reward_inputs], format_weight)[0]
    return [score(one["response"], one["ground_truth"], format_weight) for one in reward_inputs]
