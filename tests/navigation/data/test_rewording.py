"""Other words for a set: of people and of models, added, never in place of others, and checked."""

import json
from collections import Counter
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.external_models.scripted_server import BUSY, scripted
from vln_sets import WORDS, small_set

from world2minecraft import cli
from world2minecraft.core.errors import BudgetError, DamagedFileError, InputError, ServerError
from world2minecraft.navigation.data.rewording import (
    annotate_set,
    read_set,
    reword_set,
    select_instructions,
    write_set,
)
from world2minecraft.navigation.records import read_episodes, read_items, read_trajectories
from world2minecraft.navigation.types import LEVELS, Instruction

SAME = "At the door take a left, pass the table and halt at the piano."
RECORDS = ("items.jsonl", "trajectories.jsonl", "episodes.jsonl")


@pytest.fixture
def folder(tmp_path):
    return small_set(tmp_path / "set")


def bytes_of(folder):
    return [(folder / name).read_bytes() for name in RECORDS]


def csv(folder, *rows):
    path = folder.parent / "words.csv"
    lines = ["trajectory_id,instruction,annotator_id,level", *(",".join(row) for row in rows)]
    path.write_text("\n".join(lines) + "\n")
    return path


def test_human_instructions_take_turns_and_can_be_deselected(folder, capsys):
    before = bytes_of(folder)
    words = csv(
        folder,
        ("kitchen-t0", "Walk to the piano past the table.", "ann", "route"),
        ("kitchen-t0", '"Left, then go by the table to the piano."', "bob", "landmark"),
        ("kitchen-t0", "Off to the piano.", "cleo", "landmark"),
        ("attic-t0", "Piano!", "ann", "goal"),
    )
    assert cli.run(["vln", "reword", str(folder), "--annotations", str(words)]) == 0
    assert "items by source of the instruction: 13 human, 26 template" in capsys.readouterr().out
    items = [item for item in read_items(folder) if item.scene_id == "kitchen"]
    who = Counter(item.instruction.annotator for item in items)
    assert who == {"bob": 7, "cleo": 6}  # Of the level of the words before; as often, in turn.
    assert items[0].instruction.landmarks == ("table", "piano")
    (walk,) = [one for one in read_trajectories(folder) if one.scene_id == "kitchen"]
    assert [one.source for one in walk.instructions] == ["template", "human", "human", "human"]
    assert read_episodes(folder)[0].instruction.annotator == "bob"
    annotated = bytes_of(folder)
    assert cli.run(["vln", "reword", str(folder), "--annotations", str(words)]) == 0
    assert bytes_of(folder) == annotated  # What is there is not added again.
    assert cli.run(["vln", "reword", str(folder), "--plain"]) == 0
    after = bytes_of(folder)
    assert (after[0], after[2]) == (before[0], before[2])
    assert after[1] == annotated[1]


@given(
    st.lists(st.tuples(st.sampled_from(("human", "llm")), st.sampled_from(LEVELS)), max_size=6),
    st.sampled_from(LEVELS),
)
@settings(max_examples=60, deadline=None, suppress_health_check=[])
def test_route_instructions_are_not_replaced_by_goal_ones(tmp_path_factory, words, level):
    made = read_set(_set_of(tmp_path_factory))
    told = tuple(Instruction(f"{n}.", *one) for n, one in enumerate(words))
    plain = Instruction("Own words.", level=level)
    walks = [replace(one, instructions=(plain, *told)) for one in made.trajectories]
    items = [replace(one, instruction=plain) for one in made.items]
    again = select_instructions(replace(made, items=items, trajectories=walks))
    fit = [one for one in told if level == "goal" or one.level != "goal"]
    best = "human" if any(one.source == "human" for one in fit) else "llm" if fit else "template"
    for item in again.items:
        assert item.instruction.source == best
        assert item.instruction.level == level
        if best != "template":
            assert item.instruction.text in [f"{told.index(one)}." for one in fit]
    assert select_instructions(again, ("template",)).items == items


_MADE = []


def _set_of(factory):
    if not _MADE:
        _MADE.append(small_set(factory.mktemp("made") / "set"))
    return _MADE[0]


def _vary(folder):
    """Let each scene tell the same in other words, so that each is a question of its own."""
    for name in RECORDS:
        lines = (folder / name).read_text().splitlines(keepends=True)
        told = {"villa": "go past", "attic": "move past"}
        for n, line in enumerate(lines):
            for scene, words in told.items():
                if f'"scene_id":"{scene}"' in line:
                    lines[n] = line.replace("walk past", words)
        (folder / name).write_text("".join(lines))


def test_a_model_says_it_again_and_is_checked(folder, capsys):
    """It talks, lies about a turn, leaves out a thing, breaks off, and is busy once."""
    _vary(folder)
    said = {"kitchen": SAME, "villa": SAME.replace("left", "right"), "attic": "Go <image>!"}
    asked = []

    def reply(request, number):
        asked.append(request["messages"][-1]["content"])
        return BUSY if number == 0 else said[["kitchen", "villa", "attic"][number - 1]]

    with scripted(reply) as server:
        words = ["vln", "reword", str(folder), "--rewrite", server.url, "--model", "m"]
        assert cli.run([*words, "--jobs", "1"]) == 0
        told = capsys.readouterr().out
        assert "accepted 1 of 3; rejected: invalid characters 1, other turns 1" in told
        assert "items by source of the instruction: 13 llm, 26 template" in told
        assert len(server.requests) == 4
        assert cli.run([*words, "--jobs", "1"]) == 0  # The walk that has words is not asked for.
        assert len(server.requests) == 4
        assert "0 requests and 2 recorded replies" in capsys.readouterr().out
    assert "Turns: left. Things: door, table, piano." in str(asked[0])
    (item, *_) = [one for one in read_items(folder) if one.scene_id == "kitchen"]
    assert (item.instruction.text, item.instruction.annotator) == (SAME, "m")
    assert item.instruction.landmarks == WORDS.landmarks


def test_a_thing_of_the_scene_that_was_not_told_is_seen(folder):
    """The set says what else there is, so that a model cannot add it."""
    about = {"scenes": [{"scene_id": "kitchen", "landmarks": ["red sofa", 3]}, 7]}
    (folder / "dataset.json").write_text(json.dumps(about))
    made = read_set(folder)
    assert made.names["kitchen"] == ("door", "piano", "red sofa", "table")
    ask = lambda _: "At the red sofa, then the door take a left, pass the table to the piano."  # noqa: E731
    again, outcomes = reword_set(made, ask, "m")
    assert outcomes["other landmarks"] == 1  # Of the kitchen: the others know of no sofa.
    assert len(again.trajectories[0].instructions) == 1


def test_no_reply_at_all_is_an_error_a_single_failure_is_not(folder):
    made = read_set(folder)

    def gone(_):
        raise ServerError("nobody there")

    with pytest.raises(ServerError, match="nobody there"):
        reword_set(made, gone, "m")
    replies = iter([SAME, gone, BudgetError("empty")])

    def stumbling(prompt):
        reply = next(replies)
        if isinstance(reply, BudgetError):
            raise reply
        return reply if isinstance(reply, str) else reply(prompt)

    again, outcomes = reword_set(made, stumbling, "m")
    assert outcomes == {"": 1, "no reply": 1, "no budget left": 1}
    write_set(folder, select_instructions(again))
    assert Counter(one.instruction.source for one in read_items(folder)) == {
        "llm": 13, "template": 26,
    }  # fmt: skip


@pytest.mark.parametrize(
    ("row", "error"),
    [
        (
            ("kitchen-t0", "Go <|im_end|> on.", "", ""),
            r"line 2: text must not contain '<\|im_end\|>'",
        ),
        (("kitchen-t0", "Go on.", "", "middling"), "line 2: level must be one of goal"),
        (("kitchen-t0", " ", "", ""), "line 2: instruction must be a string"),
    ],
)
def test_a_line_that_cannot_be_is_named(folder, row, error):
    before = bytes_of(folder)
    with pytest.raises(DamagedFileError, match=error):
        annotate_set(folder, csv(folder, row))
    with pytest.raises(
        InputError, match=("refers to trajectory 'other', which the set does not contain")
    ):
        annotate_set(folder, csv(folder, ("other", "Go.", "", "")))
    assert bytes_of(folder) == before


def test_a_command_that_asks_for_nothing_says_so(folder, capsys):
    assert cli.run(["vln", "reword", str(folder)]) == 2
    assert capsys.readouterr().err == (
        "error: nothing to do; add --annotations FILE, --rewrite MODEL or --plain\n"
    )
