"""Items are asked by the words of the exports, answers are read with care, and shares are right."""

import json
import time

import pytest
from tests.external_models.scripted_server import Answer as Wire
from tests.external_models.scripted_server import scripted
from tests.external_models.test_chat_client import model_at
from vln_sets import next_action, next_view, write_pictures

from world2minecraft.core.errors import InputError, ServerError, UsageError
from world2minecraft.external_models.chat_messages import Picture
from world2minecraft.external_models.structured_replies import UnreadableError
from world2minecraft.navigation.agents.question_answering import Answer, VlmAnswerer, read_answer
from world2minecraft.navigation.item_prompts import question_of
from world2minecraft.navigation.running.item_evaluation import accuracy, evaluate, write_result
from world2minecraft.navigation.running.result_tables import (
    answers_table,
    format_markdown,
    format_text,
    paired_table,
    read_result,
)

ACTIONS = {"A": "move forward", "B": "turn left", "C": "turn right", "D": "stop"}
VIEWS = dict.fromkeys("ABCD", "")
READ = [
    ("B", "B"),
    (" (b). ", "B"),
    ("**C**", "C"),
    ("turn left", "B"),
    ("Turn right.", "C"),
    ("B. turn left", "B"),
    ("(D) stop", "D"),
    ("Answer: A", "A"),
    ("I see a door.\nFinal answer: D. stop", "D"),
    ("<think>A? B!</think><answer>B</answer>", "B"),
    ("<answer>(C)</answer>\n<answer>C</answer>", "C"),
    ('{"answer": "d"}', "D"),
]
UNREADABLE = [
    "",
    "E",
    "AB",
    "A or B",
    "I turn left.",
    "A. turn left",
    "<answer>A</answer><answer>B</answer>",
    "<think>B</think>",
    '{"answer": "E"}',
    "The answer could be A.",
]


@pytest.mark.parametrize(("text", "letter"), READ)
def test_a_letter_is_read(text, letter):
    assert read_answer(text, ACTIONS) == letter


@pytest.mark.parametrize("text", UNREADABLE)
def test_no_letter_is_guessed(text):
    with pytest.raises(UnreadableError):
        read_answer(text, ACTIONS)


def test_options_that_are_pictures_have_letters_alone():
    assert read_answer("B.", VIEWS) == "B"
    for text in ("", "B. the door"):
        with pytest.raises(UnreadableError):
            read_answer(text, VIEWS)


@pytest.fixture
def folder(tmp_path):
    for scene in ("kitchen", "house"):
        write_pictures(tmp_path, scene)
    return tmp_path


def some_items():
    return [
        *(next_view("kitchen", step) for step in (2, 3, 4)),
        *(next_action("kitchen", step) for step in (0, 3, 7)),
        *(next_view("house", step, composition="extend") for step in (2, 5)),
    ]


def test_an_item_is_asked_by_the_words_of_the_exports(folder):
    item = next_view("kitchen", 3)
    with scripted([item.answer]) as server:
        answer = VlmAnswerer(model_at(server), folder).answer(item)
        (sent,) = server.requests
    parts = sent["messages"][0]["content"]
    text = "".join("<image>" if "image_url" in part else part["text"] for part in parts)
    assert text == question_of(item).text + "\nAnswer with its letter alone."
    assert (answer.letter, answer.outcome) == (item.answer, "answered")
    assert answer.details["raw"] == item.answer and len(answer.details["tries"]) == 1
    assert "response_format" not in sent


def test_other_styles_end_otherwise(folder):
    item = next_action("kitchen", 0)
    with scripted(["<think>hm</think><answer>A</answer>"]) as server:
        assert VlmAnswerer(model_at(server), folder, "think").answer(item).letter == "A"
        assert "<think> </think>" in server.requests[0]["messages"][0]["content"][-1]["text"]
    with scripted(['{"answer": "A"}']) as server:
        assert VlmAnswerer(model_at(server), folder, "json").answer(item).letter == "A"
        told = server.requests[0]["response_format"]["json_schema"]["schema"]
        assert told["properties"]["answer"]["enum"] == ["A", "B", "C", "D"]
    with scripted([""]) as server, pytest.raises(UsageError, match="no question style"):
        VlmAnswerer(model_at(server), folder, "rhyme")


def test_the_think_style_is_that_of_the_export():
    recipes = pytest.importorskip("world2minecraft.navigation.exporters.recipes")
    from world2minecraft.navigation.agents.question_answering import THINK

    assert recipes.read_recipe("mc.jinja").strip().splitlines()[-1] == THINK


def test_a_changed_picture_is_refused(folder):
    item = next_action("kitchen", 0)
    (folder / item.current).write_bytes(b"\xff\xd8\xff another")
    with scripted(["A"]) as server:
        answerer = VlmAnswerer(model_at(server), folder)
        with pytest.raises(
            InputError, match=("does not match the one recorded for item kitchen-t0-na-0")
        ):
            answerer.answer(item)
        (folder / item.current).write_bytes(b"GIF89a")
        with pytest.raises(InputError, match="not a JPEG, PNG or WebP image"):
            answerer.answer(item)
        (folder / item.current).unlink()
        with pytest.raises(InputError, match="cannot be read"):
            answerer.answer(item)
        assert not server.requests


class Scripted:
    """Answers by a function of the item, late for the first ones."""

    name = "scripted"

    def __init__(self, letter, pause_s=0.0):
        self.letter, self.pause_s = letter, pause_s

    def answer(self, item):
        time.sleep(self.pause_s * (item.step == 2))
        letter = self.letter(item)
        outcome = {"": "invalid", "!": "failed"}.get(letter, "answered")
        return Answer(letter if outcome == "answered" else "", outcome, {})


def test_accuracy_by_task_and_composition_sums_to_combined():
    items = some_items()
    found = evaluate(items, Scripted(lambda item: item.answer if item.step != 3 else ""))
    table = accuracy(found)
    cells = {(task, one): (cell["hits"], cell["total"], cell["invalid"])
             for task, row in table.items() for one, cell in row.items()}  # fmt: skip
    assert cells == {
        ("next_view", "base"): (2, 3, 1),
        ("next_view", "extend"): (2, 2, 0),
        ("next_view", "combined"): (4, 5, 1),
        ("next_action", "base"): (2, 3, 1),
        ("next_action", "combined"): (2, 3, 1),
    }
    assert table["next_view"]["combined"]["chance"] == 0.25
    cell = table["next_view"]["combined"]
    assert 0 < cell["low"] < cell["share"] < cell["high"] < 1


def test_many_at_once_give_the_same_in_the_same_order():
    items = some_items()
    one = evaluate(items, Scripted(lambda item: "A"))
    many = evaluate(items, Scripted(lambda item: "A", 0.05), jobs=4)
    assert [found.item for found in many] == items and many == one


def test_a_server_that_fails_and_fails_ends_the_run():
    items = some_items()
    with pytest.raises(ServerError, match="5 items in a row were not answered"):
        evaluate(items, Scripted(lambda item: "!"))
    found = evaluate(items, Scripted(lambda item: "!" if item.step == 3 else "A"))
    assert [one.answer.outcome for one in found].count("failed") == 2
    with pytest.raises(UsageError, match="no items to answer"):
        evaluate([], Scripted(lambda item: "A"))


def test_a_misbehaving_server_is_scored_as_it_answers(folder):
    """Prose, unknown letters, a refusal: wrong and counted; a busy moment costs nothing."""
    items = some_items()
    shown = {
        tuple(Picture((folder / name).read_bytes()).url for name in item.images): item
        for item in items
    }

    def script(asked, number):
        if number == 0:
            return Wire(429, b"slow down", {"Retry-After": "0"})
        parts = asked["messages"][0]["content"]
        urls = [part["image_url"]["url"] for part in parts if "image_url" in part]
        item = shown[tuple(urls)]
        bad = {4: "I cannot tell.", 5: "Z", 7: Wire(400, b"too large")}
        return bad.get(item.step, item.answer)

    with scripted(script) as server:
        found = evaluate(items, VlmAnswerer(model_at(server), folder))
    assert [one.answer.outcome for one in found] == [
        "answered", "answered", "invalid", "answered", "answered", "failed", "answered", "invalid",
    ]  # fmt: skip
    assert [one.is_right for one in found] == [one.answer.outcome == "answered" for one in found]


def write_run(folder, name, training, letter, items=None):
    found = evaluate(some_items() if items is None else items, Scripted(letter))
    write_result(folder, found, {"agent": name, "training": training})
    return folder


def test_what_a_server_did_not_answer_stands_in_the_table(tmp_path):
    said = {2: "!", 3: ""}
    run = write_run(tmp_path / "a", "tiny", "none", lambda item: said.get(item.step, "A"))
    result = read_result(run)
    for task, cells in result["accuracy"].items():
        cell = cells["combined"]
        column = 4 if task == "next_view" else 7
        shown = answers_table([result])[1][column]
        assert (f" {cell['failed']} failed" in shown) == bool(cell["failed"])
        assert (f" {cell['invalid']}!" in shown) == bool(cell["invalid"])
    assert sum(cells["combined"]["failed"] for cells in result["accuracy"].values()) > 0


def test_each_reply_is_kept_and_the_table_is_the_papers(tmp_path):
    bare = write_run(tmp_path / "a", "tiny", "none", lambda item: "A")
    tuned = write_run(tmp_path / "b", "tiny", "sft", lambda item: item.answer)
    chance = write_run(tmp_path / "c", "majority", "baseline", lambda item: "B")
    lines = [json.loads(line) for line in (bare / "answers.jsonl").read_text().splitlines()]
    assert [line["item_id"] for line in lines] == [item.item_id for item in some_items()]
    assert {line["said"] for line in lines} == {"A"}
    results = [read_result(path) for path in (tuned, bare, chance)]
    table = answers_table(results)
    assert table[0] == [
        "model", "training", "Next-View Base", "Next-View Extend", "Next-View Combined",
        "Next-Action Base", "Next-Action Extend", "Next-Action Combined",
    ]  # fmt: skip
    assert [row[:2] for row in table[1:]] == [
        ["majority", "baseline"], ["tiny", "none"], ["tiny", "sft"],
    ]  # fmt: skip
    assert table[3][2] == "100.0 [44, 100] n=3" and table[3][6] == "-"
    assert format_text(table).splitlines()[0].startswith("model     training")
    assert format_markdown(table).splitlines()[1].startswith("| --- | ---: |")
    pairs = {(row[0], row[1]): row[2:] for row in paired_table(results)[1:]}
    only_tuned = sum(item.answer != "A" for item in some_items())
    assert pairs["tiny (none)", "tiny (sft)"][:3] == ["8", "0", str(only_tuned)]


DAMAGE = [
    ("kind", "song"),
    ("training", "magic"),
    ("accuracy", {"next_view": {"base": {"share": "much"}}}),
    ("accuracy", []),
    ("right", {"a": 1}),
    ("right", None),
    (
        "accuracy",
        {"next_view": {"base": {"share": 1, "low": 0, "high": 1, "invalid": 0, "total": 1e999}}},
    ),
]


@pytest.mark.parametrize(("name", "value"), DAMAGE)
def test_a_result_of_anyone_is_checked(tmp_path, name, value):
    path = write_run(tmp_path, "tiny", "none", lambda item: "A") / "result.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | {name: value}))
    with pytest.raises(InputError, match=r"not a result of|not a complete result"):
        read_result(tmp_path)


def test_a_run_that_is_not_done_is_told(tmp_path):
    with pytest.raises(InputError, match=r"result.json: not found; w2m vln run and w2m vln ev"):
        read_result(tmp_path)


def test_the_same_answers_are_written_as_the_same_bytes(tmp_path):
    one, other = (write_run(tmp_path / n, "tiny", "none", lambda item: "A") for n in "ab")
    for name in ("answers.jsonl", "result.json"):
        assert (one / name).read_bytes() == (other / name).read_bytes()
