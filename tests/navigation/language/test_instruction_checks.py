"""What is told to a person who writes an instruction."""

import pytest

from world2minecraft.core.errors import UsageError
from world2minecraft.navigation.language.instruction_checking import (
    Mention,
    check_instruction,
    find_mentions,
    goal_name,
    landmark_names_of,
)
from world2minecraft.navigation.types import Instruction, Keyframe, Stance, Trajectory

NAMES = ("blue chair", "red chair", "red chair beside the piano", "upright piano")
TOLD = (
    Instruction("Go to the upright piano.", level="goal", landmarks=("upright piano",)),
    Instruction("Turn left and walk two metres. Turn right and stop.", level="route"),
    Instruction(
        "Turn left at the red chair, walk to the upright piano and stop.",
        landmarks=("red chair", "upright piano"),
    ),
)


def a_walk(told=TOLD, name="t0", scene="flat"):
    frame = Keyframe("images/flat/t0/000.jpg", Stance(0, 64, 0), "stop", ())
    return Trajectory(name, scene, (frame,), told, 2.0)


def said(text, level):
    return [(one.is_wrong, one.text) for one in check_instruction(text, level, a_walk(), NAMES)]


@pytest.mark.parametrize(
    ("level", "text"),
    [
        ("goal", "Please go to the piano over there."),
        ("route", "Go left, two metres on turn right and stop."),
        ("landmark", "Take a left at the blue chair, then right, and stop at the upright piano."),
        ("landmark", "Left past the red chair beside the piano, right, stop at the piano."),
    ],
)
def test_nothing_is_said_of_what_is_right(level, text):
    assert said(text, level) == []


@pytest.mark.parametrize(
    ("level", "text", "expected"),
    [
        ("goal", "  \n ", [(True, "the instruction is empty")]),
        ("goal", "x" * 5000, [(True, "the instruction has 5,000 characters, the limit is 4,000")]),
        ("goal", "Go to the blue chair.",
         [(True, "the instruction must name the goal: the upright piano")]),
        ("goal", "The piano!", [
            (False, "the instruction has 10 characters, but those of the paper have 15 to 334")]),
        ("goal", "Go to the pianos over there.",
         [(True, "the instruction must name the goal: the upright piano")]),
        ("route", "Turn right, walk two metres and stop.",
         [(False, "the walk turns left, right, but the instruction says right")]),
        ("route", "Turn left, walk to the piano, turn right.",
         [(False, "a route must use only turns and distances, but 'piano' is a landmark")]),
        ("landmark", "Turn left, turn right and stop at the piano.",
         [(False, "the instruction names only the goal, but no landmark on the way")]),
        ("landmark", "Turn left at the chair, turn right at the piano.",
         [(False, "'chair' matches 3 landmarks; use one of blue chair, red chair, red chair beside "
           "the piano")]),
        ("landmark", "Walk past the blue chair.",
         [(True, "the instruction must name the goal: the upright piano"),
          (False, "the walk turns left, right, but the instruction says nowhere")]),
    ],
)  # fmt: skip
def test_what_is_wrong_is_told_first(level, text, expected):
    assert said(text, level) == expected


def test_there_are_three_levels():
    with pytest.raises(UsageError, match="instruction level must be one of"):
        check_instruction("Go.", "dance", a_walk(), NAMES)


def test_a_goal_that_shares_its_name_is_told_apart():
    told = (Instruction("Go to the red chair.", level="goal", landmarks=("red chair",)),)
    found = check_instruction("Please go to the chair.", "goal", a_walk(told), NAMES)
    assert [one.text for one in found if one.is_wrong] == [
        "the instruction must name the goal: the red chair"
    ]
    assert "'chair' matches 3 landmarks" in found[1].text


def test_a_walk_that_nothing_is_told_of_asks_for_no_goal():
    assert goal_name(a_walk(())) == ""
    assert check_instruction("Walk on until you are there.", "landmark", a_walk(()), ()) == [
        (False, "the instruction names only the goal, but no landmark on the way")
    ]
    assert check_instruction("Walk on until you are there.", "goal", a_walk(()), ()) == []


def test_names_are_those_of_the_scene():
    other = Instruction("Go to the bed.", level="goal", landmarks=("bed",))
    walks = [a_walk(), a_walk((other,), "t1"), a_walk((other,), "t2", "loft")]
    assert landmark_names_of(walks, "flat") == ("bed", "red chair", "upright piano")
    assert landmark_names_of(walks, "loft") == ("bed",)


def test_the_longest_phrase_counts():
    assert find_mentions("the RED chair beside the piano", NAMES) == [
        Mention("red chair beside the piano", ("red chair beside the piano",))
    ]
    assert find_mentions("a piano-stool", ()) == []
