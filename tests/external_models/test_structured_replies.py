"""The ladder of forms: how it steps down, repairs, and ends without a guess."""

import json

import pytest
from tests.external_models.scripted_server import BUSY, MEGABYTE, NO_SCHEMA, proper, scripted
from tests.external_models.test_chat_client import HELLO, model_at

from world2minecraft.external_models.chat_transport import RefusedQuestionError
from world2minecraft.external_models.structured_replies import (
    ReplyFormat,
    UnreadableError,
    ask_structured,
    extract_json_object,
    strip_reasoning,
)


def read_colour(text):
    found = extract_json_object(text)
    if found is None or found.get("colour") not in ("red", "green"):
        raise UnreadableError("colour must be red or green")
    return found["colour"]


SCHEMA = {
    "type": "object",
    "properties": {"colour": {"enum": ["red", "green"]}},
    "required": ["colour"],
    "additionalProperties": False,
}
COLOUR = ReplyFormat(
    "colour", SCHEMA, 'Reply {"colour": "red"} or {"colour": "green"}.', read_colour
)
GREEN = json.dumps({"colour": "green"})


def kinds(server):
    return [(sent.get("response_format") or {"type": "text"})["type"] for sent in server.requests]


def test_a_server_that_can_is_held_to_the_schema():
    with scripted([GREEN]) as server:
        formed = ask_structured(model_at(server), HELLO, COLOUR)
    assert (formed.value, len(formed.tries), formed.problem) == ("green", 1, "")
    told = server.requests[0]["response_format"]["json_schema"]
    assert (told["name"], told["strict"], told["schema"]) == ("colour", True, SCHEMA)
    assert "Reply" in server.requests[0]["messages"][-1]["content"]
    for asked in server.requests:  # LLaMA-Factory's server refuses two turns of one side.
        roles = [turn["role"] for turn in asked["messages"] if turn["role"] != "system"]
        assert roles == ["user", "assistant"] * (len(roles) // 2) + ["user"]


def test_a_refused_rung_is_left_for_good_and_costs_no_repair():
    def script(asked, _number):
        kind = (asked.get("response_format") or {"type": "text"})["type"]
        return NO_SCHEMA if kind != "text" else "I say " + GREEN

    with scripted(script) as server:
        model = model_at(server)
        first, second = (ask_structured(model, HELLO, COLOUR, repairs=0) for _ in range(2))
        assert (first.value, second.value) == ("green", "green")
        assert kinds(server) == ["json_schema", "json_object", "text", "text"]
    assert [one.rung for one in first.tries] == ["json_schema", "json_object", "text"]
    assert first.tries[0].problem.startswith("refused: ")


def test_a_question_refused_in_every_format_lowers_no_rung():
    with scripted([NO_SCHEMA] * 3 + [GREEN]) as server:
        model = model_at(server)
        with pytest.raises(RefusedQuestionError):
            ask_structured(model, HELLO, COLOUR)
        assert ask_structured(model, HELLO, COLOUR).value == "green"
        assert kinds(server)[-1] == "json_schema"


def test_a_bad_reply_is_shown_again_with_what_is_wrong():
    with scripted(["Let me think about that.", '{"colour": "blue"}', GREEN]) as server:
        formed = ask_structured(model_at(server), HELLO, COLOUR)
    assert formed.value == "green"
    assert [one.problem for one in formed.tries] == ["colour must be red or green"] * 2 + [""]
    last = server.requests[2]["messages"]
    assert [turn["role"] for turn in last] == ["user"] + ["assistant", "user"] * 2
    assert last[-2]["content"] == '{"colour": "blue"}'
    assert last[-1]["content"].startswith("That cannot be used: colour must be red or green.")


BAD = {
    "prose": "I would take green.",
    "an unknown value": '{"colour": "blue"}',
    "two objects": GREEN + GREEN,
    "a megabyte": MEGABYTE,
    "cut": proper(GREEN, finish="length"),
    "nothing": "",
    "null": proper(None),
}


@pytest.mark.parametrize("answer", BAD.values(), ids=BAD)
def test_what_stays_bad_ends_after_two_repairs_without_a_value(answer):
    with scripted([answer]) as server:
        formed = ask_structured(model_at(server), HELLO, COLOUR)
        assert formed.value is None and formed.problem
        assert len(formed.tries) == len(server.requests) == 3


def test_a_busy_moment_in_between_is_no_repair():
    with scripted([BUSY, GREEN]) as server:
        formed = ask_structured(model_at(server), HELLO, COLOUR)
    assert len(formed.tries) == 1 and formed.tries[0].reply.attempts == 2


@pytest.mark.parametrize(
    "reply",
    [
        '<think>{"colour": "red"}? No.</think>' + GREEN,
        'It is {"colour": "red"}. No.\n</think>\n' + GREEN,  # The template said the first tag.
        "<THINKING>{</THINKING>" + GREEN,
    ],
)
def test_what_a_model_thinks_is_no_answer(reply):
    with scripted([reply]) as server:
        formed = ask_structured(model_at(server), HELLO, COLOUR)
        assert (formed.value, len(server.requests)) == ("green", 1)
    assert formed.raw == reply  # Kept as it came.


def test_thoughts_are_taken_out_in_linear_time():
    assert strip_reasoning("<think>" * 40_000 + "x" * 40_000).endswith("x")
    assert strip_reasoning("</think>" * 40_000) == ""


def test_a_cut_reply_says_how_long_it_could_be():
    with scripted([proper("", finish="length")]) as server:
        formed = ask_structured(model_at(server), HELLO, COLOUR, repairs=0)
    assert formed.problem == "the reply was truncated at 1,024 tokens; be shorter"
