"""The chat client against a server that keeps to the protocol, and against one that does not."""

import json
import time

import pytest
from tests.external_models.scripted_server import (
    BUSY,
    MEGABYTE,
    NO_SCHEMA,
    SLOW,
    Answer,
    completion,
    proper,
    scripted,
)

from world2minecraft.core.errors import (
    BudgetError,
    InputError,
    MissingExtraError,
    ServerError,
    UsageError,
)
from world2minecraft.external_models.chat_client import ChatModel, open_chat, retry_wait_s
from world2minecraft.external_models.chat_costs import Ledger, Price
from world2minecraft.external_models.chat_messages import Picture, Question, Turn
from world2minecraft.external_models.chat_transport import (
    BusyServerError,
    ChatTransport,
    Endpoint,
    RefusedQuestionError,
    UselessReplyError,
    resolve_endpoint,
)
from world2minecraft.external_models.reply_cache import ReplyStore

HELLO = (Turn("user", ("Hello",)),)
PICTURE = Picture(b"\xff\xd8 no real picture")


def model_at(server, *, store=None, ledger=None, attempts=3, timeout_s=5.0, waits=None):
    wire = ChatTransport(Endpoint(server.url, "scripted"), timeout_s=timeout_s)
    sleep = (lambda seconds: None) if waits is None else waits.append
    return ChatModel("scripted", wire, store=store, ledger=ledger, attempts=attempts, sleep=sleep)


def test_a_question_is_sent_as_the_protocol_says():
    with scripted(["fine"]) as server:
        turns = (Turn("system", ("Be short.",)), Turn("user", ("See:", PICTURE)))
        _, reply = model_at(server).ask(turns, form={"type": "json_object"})
    (sent,) = server.requests
    assert reply.text == "fine" and (reply.prompt_tokens, reply.completion_tokens) == (100, 10)
    assert sent["messages"] == [
        {"role": "system", "content": "Be short."},
        {
            "role": "user",
            "content": [
                {"type": "text", "text": "See:"},
                {"type": "image_url", "image_url": {"url": PICTURE.url}},
            ],
        },
    ]
    assert (sent["model"], sent["temperature"], sent["max_tokens"]) == ("scripted", 0.0, 1024)
    assert sent["response_format"] == {"type": "json_object"}


def test_the_key_goes_to_the_server_and_nowhere_else(tmp_path, monkeypatch):
    monkeypatch.setenv("MY_KEY", "sesame-4711")
    store = ReplyStore(tmp_path / "replies.jsonl")
    with scripted(["fine"]) as server:
        open_chat(server.url, model="m", key_name="MY_KEY", store=store).ask(HELLO)
    assert server.headers[0]["authorization"] == "Bearer sesame-4711"
    assert "sesame" not in (tmp_path / "replies.jsonl").read_text()


def test_a_busy_server_is_asked_again_and_no_more_than_said():
    with scripted([BUSY, BUSY, "fine"]) as server:
        _, reply = model_at(server).ask(HELLO)
        assert (reply.text, reply.attempts, len(server.requests)) == ("fine", 3, 3)
    with scripted([BUSY]) as server:
        with pytest.raises(BusyServerError, match='returned HTTP status 429: .*"slow down"'):
            model_at(server, attempts=4).ask(HELLO)
        assert len(server.requests) == 4


def test_waits_grow_and_heed_the_server():
    waits = []
    with scripted([Answer(503, b"")]) as server, pytest.raises(BusyServerError):
        model_at(server, attempts=8, waits=waits).ask(HELLO)
    longest = [1, 2, 4, 8, 16, 30, 30]
    assert all(most / 2 <= wait <= most for wait, most in zip(waits, longest, strict=True))
    waits = []
    answer = Answer(429, b"", {"Retry-After": "7"})
    with scripted([answer]) as server, pytest.raises(BusyServerError):
        model_at(server, attempts=2, waits=waits).ask(HELLO)
    assert waits == [7.0]


@pytest.mark.parametrize("header", ["1e9", "-3", "nan", "Wed, 21 Oct 2026 07:28:00 GMT"])
def test_no_server_makes_us_wait_for_ever(header):
    waits = []
    answer = Answer(429, b"", {"Retry-After": header})
    with scripted([answer]) as server, pytest.raises(BusyServerError):
        model_at(server, attempts=2, waits=waits).ask(HELLO)
    assert 0 < waits[0] <= 30


def test_a_server_that_drips_ends_at_the_deadline():
    began = time.monotonic()
    with (
        scripted([SLOW]) as server,
        pytest.raises(BusyServerError, match=("did not reply within 0.3 s")),
    ):
        model_at(server, attempts=1, timeout_s=0.3).ask(HELLO)
    assert time.monotonic() - began < 2


def test_a_megabyte_is_not_read_to_its_end():
    with scripted([MEGABYTE]) as server:
        with pytest.raises(UselessReplyError, match="sent a reply of more than 262,144 bytes"):
            model_at(server).ask(HELLO)
        assert len(server.requests) == 1


def test_a_megabyte_of_failure_is_not_read_either():
    body = b"no " * (1 << 20)
    right = pytest.raises(
        ServerError, match=("returned HTTP status 401: no no .*check the API key in")
    )
    with scripted([Answer(401, body)]) as server, right as caught:
        model_at(server).ask(HELLO)
    assert len(str(caught.value)) < 500


ODD = {
    "no JSON": Answer(body=b"<html>Bad gateway"),
    "a list": Answer(body=b"[1, 2]"),
    "no choice": Answer(body=b'{"choices": []}'),
    "a choice that is none": Answer(body=b'{"choices": ["yes"]}'),
    "deep": Answer(body=b"[" * 100_000),
    "packed": Answer(body=b"x", headers={"Content-Encoding": "gzip"}),
}


@pytest.mark.parametrize("answer", ODD.values(), ids=ODD)
def test_what_is_no_reply_is_told_as_such(answer):
    with scripted([answer]) as server, pytest.raises(UselessReplyError):
        model_at(server).ask(HELLO)


def test_values_of_a_server_are_taken_with_care():
    told = json.dumps(
        {
            "choices": [
                {
                    "message": {"content": [{"type": "text", "text": "a\x1b[31m\ud800"}, 3]},
                    "finish_reason": {"odd": 1},
                }
            ],
            "usage": {"prompt_tokens": -5, "completion_tokens": 10**12},
        }
    )
    with scripted([Answer(body=told.encode())]) as server:
        _, reply = model_at(server).ask(HELLO)
    assert reply.text == "a [31m?"
    assert reply.is_estimated and 0 < reply.prompt_tokens < 10 and reply.completion_tokens < 10


def test_refusals_and_redirects_are_not_followed():
    with (
        scripted([NO_SCHEMA]) as server,
        pytest.raises(RefusedQuestionError, match=("HTTP status 400")),
    ):
        model_at(server).ask(HELLO)
    with scripted([Answer(307, b"", {"Location": "http://127.0.0.1:1/"})]) as server:
        with pytest.raises(ServerError, match="HTTP status 307"):
            model_at(server).ask(HELLO)
        assert len(server.requests) == 1


def test_a_server_that_is_away_is_told_by_its_address():
    with scripted(["fine"]) as server:
        pass
    with pytest.raises(BusyServerError, match=f"{server.url} cannot be reached"):
        model_at(server, attempts=2).ask(HELLO)


def test_a_recorded_reply_is_not_asked_for_again(tmp_path):
    path = tmp_path / "replies.jsonl"
    with scripted(["first", "second", "third"]) as server:
        model = model_at(server, store=ReplyStore(path))
        first, again = model.ask(HELLO), model.ask(HELLO)
        other = model.ask(HELLO, sample=1)
        assert (first[1].text, again[1].text, other[1].text) == ("first", "first", "second")
        assert not first[1].is_replayed and again[1].is_replayed and first[0] == again[0]
        assert (model.ledger.calls, model.ledger.replayed, len(server.requests)) == (2, 1, 2)
    replayed = open_chat("openai:scripted", store=ReplyStore(path, "replay"))  # No key, no server.
    assert replayed.ask(HELLO)[1].text == "first"
    with pytest.raises(
        InputError, match=("no reply is recorded for question .*same scene, model, prompts")
    ):
        replayed.ask((Turn("user", ("Goodbye",)),))


def test_failures_are_replayed_but_retried_on_resume(tmp_path):
    path = tmp_path / "replies.jsonl"
    with scripted([NO_SCHEMA, MEGABYTE, Answer(503, b"")]) as server:
        model = model_at(server, store=ReplyStore(path), attempts=1)
        kinds = (RefusedQuestionError, UselessReplyError, BusyServerError)
        for sample, kind in enumerate(kinds):
            with pytest.raises(kind):
                model.ask(HELLO, sample=sample)
    replayed = open_chat("openai:scripted", store=ReplyStore(path, "replay"))
    for sample, kind in enumerate(kinds):
        with pytest.raises(kind):
            replayed.ask(HELLO, sample=sample)
    with scripted(["fine"]) as server:
        model = model_at(server, store=ReplyStore(path))
        assert [model.ask(HELLO, sample=n)[1].text for n in range(3)] == ["fine"] * 3
    assert open_chat("openai:scripted", store=ReplyStore(path, "replay")).ask(HELLO)


def test_a_line_cut_by_a_crash_is_dropped_and_written_again(tmp_path):
    path = tmp_path / "replies.jsonl"
    with scripted(["one", "two"]) as server:
        model = model_at(server, store=ReplyStore(path))
        model.ask(HELLO)
        model.ask(HELLO, sample=1)
        whole = path.read_bytes()
        path.write_bytes(whole[:-20])
        again = model_at(server, store=ReplyStore(path))
        assert again.ask(HELLO)[1].is_replayed and not again.ask(HELLO, sample=1)[1].is_replayed
    assert len(ReplyStore(path)) == 2


@pytest.mark.parametrize(
    "line", [b"{}\n", b"[[[\n", b'{"key": 1, "reply": {}}\n', b"[" * 9999 + b"\n"]
)
def test_a_damaged_record_is_named(tmp_path, line):
    path = tmp_path / "replies.jsonl"
    path.write_bytes(line)
    with pytest.raises(InputError, match="line 1 is not a valid reply record"):
        ReplyStore(path)


def test_a_replay_needs_its_file(tmp_path):
    with pytest.raises(InputError, match="not found"):
        ReplyStore(tmp_path / "none.jsonl", "replay")
    with pytest.raises(UsageError, match="must be record or replay, got 'look'"):
        ReplyStore(tmp_path / "none.jsonl", "look")


def test_keys_tell_apart_all_that_matters():
    one = Question("m", (Turn("user", ("a", PICTURE)),))
    others = [
        Question("n", one.turns),
        Question("m", (Turn("user", ("a", Picture(PICTURE.data + b"!"))),)),
        Question("m", (Turn("user", ("b", PICTURE)),)),
        Question("m", one.turns, temperature=None),
        Question("m", one.turns, max_tokens=5),
        Question("m", one.turns, form={"type": "json_object"}),
        Question("m", one.turns, sample=1),
    ]
    assert len({one.key, *(other.key for other in others)}) == len(others) + 1
    assert one.key == Question("m", (Turn("user", ("a", PICTURE)),)).key


def test_the_budget_stops_before_it_is_passed():
    price = Price(10.0, 100.0)  # 1,024 tokens of reply: at most 10.24 cents a call.
    with scripted([proper("fine", prompt_tokens=1000, completion_tokens=1000)]) as server:
        model = model_at(server, ledger=Ledger(price, max_usd=0.25))
        for sample in range(2):
            model.ask(HELLO, sample=sample)
        assert model.ledger.usd == pytest.approx(0.22)
        with pytest.raises(BudgetError, match=r"\$0.2200 has been spent .* the limit of \$0.2500"):
            model.ask(HELLO, sample=3)
        assert len(server.requests) == 2


def test_failed_calls_count_but_cost_nothing():
    with scripted([Answer(401, b"")]) as server:
        ledger = Ledger(Price(1, 1), max_usd=1, max_calls=1)
        with pytest.raises(ServerError):
            model_at(server, ledger=ledger).ask(HELLO)
        assert (ledger.calls, ledger.usd) == (1, 0)
        with pytest.raises(BudgetError, match="1 calls have been made"):
            model_at(server, ledger=ledger).ask(HELLO)


def test_an_attempt_without_reply_costs_its_maximum():
    """A server that is late, or says what is no reply, has worked, and is paid."""
    price = Price(0.0, 100.0)  # 1,024 tokens of reply: at most 10.24 cents an attempt.
    ledger = Ledger(price, max_usd=0.25)
    with scripted([SLOW]) as server:
        with pytest.raises(BudgetError, match=r"\$0.2048 has been spent .* the limit of \$0.2500"):
            model_at(server, ledger=ledger, attempts=5, timeout_s=0.3).ask(HELLO)
        assert len(server.requests) == 2
    assert (ledger.calls, ledger.usd) == (1, pytest.approx(0.2048))
    ledger = Ledger(price, max_usd=1.0)
    with scripted([MEGABYTE]) as server, pytest.raises(UselessReplyError):
        model_at(server, ledger=ledger).ask(HELLO)
    with scripted([BUSY]) as server, pytest.raises(BusyServerError):  # Not begun, so not paid,
        model_at(server, ledger=ledger).ask(HELLO)
    with pytest.raises(BusyServerError):  # and nobody is there any more.
        model_at(server, ledger=ledger).ask(HELLO)
    assert ledger.usd == pytest.approx(0.1024)


def test_reasoning_tokens_counted_only_in_the_total_are_paid():
    told = completion("fine", prompt_tokens=21, completion_tokens=2)
    told["usage"]["total_tokens"] = 83  # Gemini's: 60 tokens of thought.
    with scripted([Answer(body=json.dumps(told).encode())]) as server:
        _, reply = model_at(server).ask(HELLO)
    assert (reply.prompt_tokens, reply.completion_tokens, reply.is_estimated) == (21, 62, False)


def test_an_echoed_key_is_in_no_error_and_no_record(tmp_path, monkeypatch):
    monkeypatch.setenv("MY_KEY", "sesame-4711")
    store = ReplyStore(tmp_path / "replies.jsonl")
    echo = b"what is Bearer sesame-4711?"
    for answer in (Answer(400, echo), Answer(401, echo), Answer(body=echo)):
        with scripted([answer]) as server:
            model = open_chat(server.url, model="m", key_name="MY_KEY", store=store)
            with pytest.raises(ServerError, match=r"Bearer \(the key\)") as caught:
                model.ask(HELLO)
        assert "sesame" not in str(caught.value)
    assert "sesame" not in (tmp_path / "replies.jsonl").read_text()


@pytest.mark.parametrize("text", ["my notes", "{}", '{"keys": 1', "[\n  1\n]"])
def test_a_file_that_is_no_record_is_left_as_it_is(tmp_path, text):
    path = tmp_path / "replies.jsonl"
    path.write_text(text)
    with pytest.raises(InputError, match="not a (valid reply|recorded reply)"):
        ReplyStore(path)
    assert path.read_text() == text


def test_money_cannot_be_capped_at_an_unknown_price():
    with pytest.raises(UsageError, match="price of this model is unknown"):
        Ledger(None, max_usd=1.0)
    assert Ledger().usd is None


def test_endpoints_are_names_or_addresses():
    assert resolve_endpoint("gemini").url.endswith("/v1beta/openai/")
    assert resolve_endpoint("openai", model="gpt-4.1").model == "gpt-4.1"
    for text, error in [
        ("gemni", "did you mean 'gemini'"),
        ("http://", "is not a valid server address"),
        ("ftp://host/v1", "is not a valid server address"),
        ("http://host:99999/v1", "is not a valid server address"),
        ("https://me:secret@host/v1", "--key-env NAME"),
    ]:
        with pytest.raises(UsageError, match=error):
            resolve_endpoint(text)
    with pytest.raises(UsageError, match="export GEMINI_API_KEY="):
        resolve_endpoint("gemini").key({})


def test_the_only_model_of_a_server_needs_no_name():
    with scripted(["fine"], models=("tiny",)) as server:
        assert open_chat(server.url).name == "tiny"
    several = pytest.raises(
        ServerError, match=("provides several models: a, b; choose one .--model")
    )
    with scripted(["fine"], models=("a", "b")) as server, several:
        open_chat(server.url)


def test_without_the_sdk_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "openai", None)
    with pytest.raises(MissingExtraError, match=r"world2minecraft\[vln\]"):
        ChatTransport(Endpoint("http://localhost/v1"), timeout_s=1)


def test_waits_are_bounded_by_any_state():
    class State:
        attempt_number = 60

        class outcome:
            @staticmethod
            def exception():
                return BusyServerError("busy")

    assert 15 <= retry_wait_s(State()) <= 30
