"""The reward: nine parts the right letter, one part the form, by EasyR1's ways of asking."""

import pytest

from world2minecraft.navigation.exporters.reward import REWARD_TYPE, answered, compute_score, score

THOUGHT = "<think>The piano is to the left.</think>"


@pytest.mark.parametrize(
    ("response", "letter"),
    [
        (f"{THOUGHT}<answer>B</answer>", "B"),
        (f"{THOUGHT}\n<answer> (b). </answer>\n", "B"),
        ("<answer>B. turn left</answer>", "B"),
        ("<answer>A</answer> no, <answer>B</answer>", "B"),
        ("B", ""),
        ("<answer></answer>", ""),
        ("<answer>Because of the door</answer>", ""),
        ("<answer>Z</answer>", ""),
        ("<answer>A or B</answer>", "A"),
    ],
)
def test_the_letter_of_a_response(response, letter):
    assert answered(response) == letter


@pytest.mark.parametrize(
    ("response", "accuracy", "form"),
    [
        (f"{THOUGHT}<answer>B</answer>", 1, 1),
        (f"{THOUGHT}<answer>C</answer>", 0, 1),
        ("<answer>B</answer>", 1, 0),
        (f"Well. {THOUGHT}<answer>B</answer>", 1, 0),
        ("B", 0, 0),
    ],
)
def test_right_counts_nine_times_as_much_as_form(response, accuracy, form):
    assert score(response, "B") == {
        "overall": pytest.approx(0.9 * accuracy + 0.1 * form),
        "format": form,
        "accuracy": accuracy,
    }


def test_a_batch_and_a_single_response_score_alike():
    batch = [
        {"response": text, "response_length": len(text), "ground_truth": "A"}
        for text in (f"{THOUGHT}<answer>A</answer>", "A", "")
    ]
    scores = compute_score(batch, format_weight=0.5)
    assert REWARD_TYPE == "batch"
    assert scores == [compute_score(one, format_weight=0.5) for one in batch]
    assert len({tuple(sorted(one)) for one in scores}) == 1  # The same keys for each.
    assert [one["overall"] for one in scores] == [1.0, 0.0, 0.0]


def test_a_megabyte_of_tags_takes_no_time():
    text = "<think>" * 100_000 + "<answer>" * 50_000
    assert score(text, "A")["overall"] == 0.0
