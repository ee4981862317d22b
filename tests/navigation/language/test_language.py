"""Instructions: true to the way, found again in their words, checked when others write them."""

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.navigation.landmarks import Landmark
from world2minecraft.navigation.language.human_instructions import (
    read_annotations,
    with_annotations,
)
from world2minecraft.navigation.language.instruction_generation import (
    generate_instructions,
    goal_text,
    landmark_text,
)
from world2minecraft.navigation.language.instruction_parsing import parse_instruction
from world2minecraft.navigation.language.landmark_grounding import (
    matching_landmarks,
    unambiguous_landmarks,
)
from world2minecraft.navigation.language.rewriting import rewrite
from world2minecraft.navigation.language.route_events import (
    ObservedWalk,
    Route,
    RouteSegment,
    describe_route,
)
from world2minecraft.navigation.types import Instruction, Keyframe, Move, Stance, Trajectory

NAMES = ["bed", "sofa", "coffee table", "table", "red chair", "chair beside the sofa", "desk"]


def thing(name, x, y, number=1, noun="", colour="grey", side=0.6):
    return Landmark(
        number, name, noun or name, 5, colour, np.array([x, y, 0.4]), np.array([side, side, 0.8])
    )


def walked(corners, yaws, looks=frozenset(), step=0.25, rooms=()):
    """Stances along straight lines between corners; ``yaws`` are those at the first and last."""
    places, angles = [np.array(corners[0], float)], [float(yaws[0])]
    for corner in corners[1:]:
        away = np.array(corner) - places[-1]
        count = round(float(np.linalg.norm(away)) / step)
        places += [places[-1] + away * (n + 1) / count for n in range(count)]
        angles += [float(np.degrees(np.arctan2(-away[0], -away[1])))] * count
    angles[-1] = yaws[1]
    seen = dict.fromkeys(range(len(places)), frozenset(looks))
    return ObservedWalk(np.array(places), np.array(angles), seen, rooms)


# In the room the game's yaw 0 looks to -y, 90 to -x, -90 to +x.
def test_a_turn_to_the_left_is_told_as_one():
    way = describe_route(walked([(0, 0), (0, -2), (2, -2)], (0, -90)), [])
    assert way.turns == ("left",)  # From -y to +x, seen from above: counter-clockwise.
    way = describe_route(walked([(0, 0), (0, -2), (-2, -2)], (0, 90)), [])
    assert way.turns == ("right",)
    way = describe_route(walked([(0, 0), (0, 2)], (0, 180)), [])
    assert way.turns == ("around",)
    way = describe_route(walked([(0, 0), (0, -2)], (0, 90)), [])
    assert way.turns == ("right",)


def test_the_side_of_what_is_passed_is_the_walkers():
    left, right = thing("sofa", 1.2, -2.0, 1), thing("desk", -1.2, -2.5, 2)
    walk = walked([(0, 0), (0, -4)], (0, 0), {1, 2})
    (stretch,) = describe_route(walk, [left, right]).stretches
    assert stretch.passing == (("sofa", "left"), ("desk", "right"))
    turned = walked([(0, -4), (0, 0)], (180, 180), {1, 2})
    (stretch,) = describe_route(turned, [left, right]).stretches
    assert stretch.passing == (("desk", "left"), ("sofa", "right"))


def test_what_is_not_seen_is_not_spoken_of():
    bed = thing("bed", 0, -3.0)
    assert describe_route(walked([(0, 0), (0, -2)], (0, 0), {1}), [bed]).stop == "bed"
    blind = describe_route(walked([(0, 0), (0, -2)], (0, 0)), [bed])
    assert (blind.stop, blind.stretches[0].towards) == ("", "")


def test_the_end_is_before_or_beside_a_thing():
    bed = thing("bed", 0, -3.0)
    assert describe_route(walked([(0, 0), (0, -2)], (0, 0), {1}), [bed], "bed").stop_side == "front"
    assert describe_route(walked([(0, 0), (0, -2)], (0, 90), {1}), [bed], "bed").stop_side == "left"
    assert (
        describe_route(walked([(0, 0), (0, -2)], (0, -90), {1}), [bed], "bed").stop_side == "right"
    )


def test_corrections_are_no_turns():
    zigzag = [(0, 0), (0.1, -0.5), (0, -1), (-0.1, -1.5), (0, -2)]
    assert describe_route(walked(zigzag, (0, 0)), []).turns == ()
    assert len(describe_route(walked(zigzag, (0, 0)), []).stretches) == 1


def test_rooms_are_named_where_one_comes_into_them():
    rooms = ["hall"] * 8 + ["kitchen"] * 9
    way = describe_route(walked([(0, 0), (0, -4)], (0, 0), rooms=rooms), [])
    assert way.stretches[0].into == "kitchen"


stretches = st.builds(
    RouteSegment,
    st.sampled_from([-190.0, -90.0, -40.0, 0.0, 45.0, 90.0, 135.0]),
    st.floats(0.5, 8.0),
    st.sampled_from(["", "sofa"]),
    st.sampled_from(["", "desk", "bed"]),
    st.sampled_from([(), (("table", "left"),), (("coffee table", "right"), ("red chair", "left"))]),
    st.sampled_from(["", "kitchen", "bedroom 2"]),
)
ways = st.builds(
    Route,
    st.lists(stretches, min_size=1, max_size=5).map(tuple),
    st.sampled_from([0.0, -60.0, 90.0]),
    st.sampled_from(["", "bed", "chair beside the sofa"]),
    st.sampled_from(["front", "left", "right"]),
)


def test_a_turn_is_told_by_the_side_it_was_made_by():
    """Left by 190 degrees ends where right by 170 does."""
    yaws = np.array([0.0, -60.0, -120.0, -180.0, 170.0, 170.0, 170.0, 170.0])
    line = [(0.0, 0.0)] * 5 + [(-0.1, 0.6), (-0.2, 1.2), (-0.3, 1.8)]
    looks = dict.fromkeys(range(len(line)), frozenset())
    assert (
        describe_route(ObservedWalk(np.array(line), yaws, looks), []).stretches[0].turn_deg < -180
    )


@given(ways, st.integers(0, 99))
@settings(max_examples=200, deadline=None)
def test_what_is_written_is_read_again(way, seed):
    for instruction in generate_instructions(way, np.random.default_rng(seed)):
        told = parse_instruction(instruction.text, NAMES)
        assert told.landmarks == instruction.landmarks
        assert instruction.text[0].isupper()
        assert instruction.text.endswith(".")
        assert ".." not in instruction.text
        if instruction.level == "route":
            assert told.turns == way.turns
        if instruction.level == "landmark":
            assert told.turns == way.turns


def test_the_words_are_english():
    rng = np.random.default_rng(0)
    way = Route(
        (
            RouteSegment(-90, 3.0, passing=(("table", "right"),)),
            RouteSegment(90, 2.4, "sofa", "piano"),
        ),
        0.0,
        "piano",
        "front",
    )
    assert landmark_text(way, rng)[0] == (
        "Turn left and walk past the table on your right, turn right at the sofa, "
        "walk to the piano and stop in front of it."
    ) or landmark_text(way, rng)[0].count(".") in (1, 2)
    assert goal_text(way, np.random.default_rng(1))[0] in (
        "Go to the piano.",
        "Walk to the piano.",
        "Find the piano and stop in front of it.",
    )


@pytest.mark.parametrize(
    ("text", "turns"),
    [
        ("Take a left, then make a right turn.", ("left", "right")),
        ("The bed is on your left.", ()),
        ("Keep the bed to your right and go left.", ("left",)),
        ("Turn right around and leave.", ("around",)),
        ("Turn around, go left.", ("around", "left")),
        ("Walk to the right-hand side.", ()),
        ("Stop right in front of the bed.", ()),
        ("Walk around the table.", ()),
    ],
)
def test_turns_of_other_words_are_read(text, turns):
    assert parse_instruction(text, NAMES).turns == turns


def test_longer_names_are_read_first():
    assert parse_instruction("Pass the coffee table and the table.", NAMES).landmarks == (
        "coffee table",
        "table",
    )


def test_a_name_that_could_mean_two_things_is_not_plain():
    table, coffee = thing("table", 0, 0, 1), thing("coffee table", 3, 0, 2)
    assert matching_landmarks("table", [table, coffee]) == [table, coffee]
    assert unambiguous_landmarks([table, coffee]) == [coffee]
    red = thing("red chair", 0, 0, 1, noun="chair", colour="red")
    blue = thing("blue chair", 2, 0, 2, noun="chair", colour="blue")
    assert unambiguous_landmarks([red, blue]) == [red, blue]
    by_sofa = thing("chair beside the sofa", 0, 0, 1, noun="chair")
    by_door = thing("chair beside the desk", 0.5, 0, 2, noun="chair")
    sofa, desk = thing("sofa", 1.2, 0, 3), thing("desk", -9, 0, 4)
    assert by_sofa not in unambiguous_landmarks(
        [by_sofa, by_door, sofa, desk]
    )  # Both stand beside the sofa.


@pytest.mark.parametrize(
    ("reply", "refusal"),
    [
        ('"At the sofa, hang a left and stop by the bed."', ""),
        ("Turn right at the sofa, stop at the bed.", "other turns"),
        ("Turn left at the bed, stop at the sofa.", "other landmarks"),
        ("Turn left at the sofa, pass the desk, stop at the bed.", "other landmarks"),
        ("", "empty"),
        ("x" * 1_000_000, "too long"),
    ],
)
def test_a_model_may_change_the_words_alone(reply, refusal):
    told = Instruction("Turn left at the sofa and stop in front of the bed.")
    made = rewrite(told, NAMES, lambda _: reply)
    assert made.refusal == refusal
    if not refusal:
        assert made.instruction is not None
        assert made.instruction.source == "llm"
        assert made.instruction.text == "At the sofa, hang a left and stop by the bed."


def test_people_are_added_and_replace_nobody(tmp_path):
    frame = Keyframe("a.jpg", Stance(0, 0, 0), "stop", (Move.STOP,))
    own = Instruction("Go to the bed.")
    trajectory = Trajectory("t1", "s", (frame,), (own,), 2.0)
    path = tmp_path / "said.csv"
    path.write_text("trajectory_id,instruction,annotator_id\nt1,Over to the  bed,ann\n")
    notes = read_annotations(path)
    (more,) = with_annotations([trajectory], notes, "said.csv")
    assert [one.text for one in more.instructions] == ["Go to the bed.", "Over to the bed"]
    assert more.instructions[1].annotator == "ann"
    assert with_annotations([more], notes, "said.csv") == [more]
    lines = tmp_path / "said.jsonl"
    lines.write_text(json.dumps({"trajectory_id": "t9", "instruction": "Go"}) + "\n")
    with pytest.raises(
        InputError, match=("refers to trajectory 't9', which the set does not contain")
    ):
        with_annotations([trajectory], read_annotations(lines), "said.jsonl")
    lines.write_text('{"trajectory_id": "t1"}\n')
    with pytest.raises(
        DamagedFileError, match=("line 1: instruction must be a string of at most 4000")
    ):
        read_annotations(lines)
