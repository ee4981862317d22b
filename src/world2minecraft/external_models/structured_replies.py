"""Structured replies: from a strict JSON schema down to plain text, with two repairs.

A server that can is held to a JSON schema; one that refuses is asked for any JSON object, and the
next for plain text. What comes is read with care whatever the rung, for servers differ in what
they promise and what they do. A reply that cannot be read is answered with what is wrong about it,
twice at most; then there is no value, and the tries tell why. Nothing is ever guessed.
"""

import json
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from world2minecraft.external_models.chat_client import ChatModel
from world2minecraft.external_models.chat_messages import Reply, Turn
from world2minecraft.external_models.chat_transport import RefusedQuestionError, UselessReplyError

RUNGS = ("json_schema", "json_object", "text")
REPAIRS = 2
MAX_QUOTED = 2000  # Characters of a bad reply that it is shown again.
_THOUGHT = re.compile(r"<think(?:ing)?>(?:(?!<think).)*?</think(?:ing)?>", re.S | re.I)
_THOUGHT_END = re.compile(r"</think(?:ing)?>", re.I)

Value = TypeVar("Value")


class UnreadableError(Exception):
    """A reply is not of the form; the text says what is wrong, to the model."""


@dataclass(frozen=True)
class ReplyFormat(Generic[Value]):
    """What a reply must be.

    ``read`` takes the text of a reply and returns the value; it raises UnreadableError.
    ``words`` say the form to a model that is not held to the schema; with ``is_said`` the question
    has them already. ``rung`` is the first that is tried, 0 the strictest.
    """

    name: str
    schema: dict[str, Any]
    words: str
    read: Callable[[str], Value]
    is_said: bool = False
    rung: int = 0

    def to_api(self, rung: str) -> dict[str, Any] | None:
        """Return the ``response_format`` of a rung."""
        if rung == "json_schema":
            named = {"name": self.name, "strict": True, "schema": self.schema}
            return {"type": "json_schema", "json_schema": named}
        return {"type": "json_object"} if rung == "json_object" else None


@dataclass(frozen=True)
class Attempt:
    """One question of a ladder: its rung and key, the reply or none, and what was wrong."""

    rung: str
    key: str
    reply: Reply | None
    problem: str = ""


@dataclass(frozen=True)
class StructuredReply(Generic[Value]):
    """The outcome of all attempts: a value, or None, and the attempts."""

    value: Value | None
    tries: tuple[Attempt, ...]

    @property
    def raw(self) -> str:
        """The last text that came, empty where none did."""
        texts = [one.reply.text for one in self.tries if one.reply is not None]
        return texts[-1] if texts else ""

    @property
    def problem(self) -> str:
        """What was wrong with the last try, empty where there is a value."""
        return self.tries[-1].problem if self.tries and self.value is None else ""


def ask_structured(
    model: ChatModel,
    turns: tuple[Turn, ...],
    form: ReplyFormat[Value],
    *,
    repairs: int = REPAIRS,
    sample: int = 0,
) -> StructuredReply[Value]:
    """Ask for a value of a form.

    ``sample`` tells apart the times that the same is asked on purpose.

    A rung that is refused where the next one is taken is left for good (``model.rung``); that
    costs no repair.

    Raises:
        RefusedQuestionError: even plain text is refused. BudgetError, ServerError, InputError: as
        ``ChatModel.ask``; a reply that is no reply counts as an unreadable one.
    """
    tries: list[Attempt] = []
    request = turns if form.is_said else _with_words(turns, form.words)
    left, rung = repairs, max(model.rung, form.rung)
    while True:
        try:
            tried, value = _ask_once(model, request, form, RUNGS[rung], sample)
        except RefusedQuestionError as error:
            if rung == len(RUNGS) - 1:
                raise
            tries.append(Attempt(RUNGS[rung], "", None, f"refused: {error}"))
            rung += 1
            continue
        tries.append(tried)
        if tried.reply is not None and rung > form.rung:
            model.rung = max(model.rung, rung)  # This rung is taken, those above were not.
        if value is not None or left == 0:
            return StructuredReply(value, tuple(tries))
        left -= 1
        request = (*request, *_repair(tried, form))


def _with_words(turns: tuple[Turn, ...], words: str) -> tuple[Turn, ...]:
    """Return turns that end with some words, in the user's last turn where that ends them.

    Chat templates of many models, and LLaMA-Factory's server, take no two turns of one side.
    """
    if turns and turns[-1].role == "user":
        return (*turns[:-1], Turn("user", (*turns[-1].parts, f"\n{words}")))
    return (*turns, Turn("user", (words,)))


def _ask_once(
    model: ChatModel, turns: tuple[Turn, ...], form: ReplyFormat[Value], rung: str, sample: int
) -> tuple[Attempt, Value | None]:
    try:
        key, reply = model.ask(turns, form=form.to_api(rung), sample=sample)
    except UselessReplyError as error:
        return Attempt(rung, "", None, str(error)), None
    if reply.finish == "length":
        problem = f"the reply was cut at {model.max_tokens:,} tokens; be shorter"
        return Attempt(rung, key, reply, problem), None
    try:
        return Attempt(rung, key, reply), form.read(strip_reasoning(reply.text))
    except UnreadableError as error:
        return Attempt(rung, key, reply, str(error)), None


def _repair(tried: Attempt, form: ReplyFormat[Any]) -> tuple[Turn, ...]:
    quoted = tried.reply.text[:MAX_QUOTED] if tried.reply is not None else ""
    problem = f"That cannot be used: {tried.problem}. {form.words}"
    answer = Turn("assistant", (quoted or "(nothing that can be read)",))
    return (answer, Turn("user", (problem,)))


def strip_reasoning(text: str) -> str:
    """Return the text of a reply without the reasoning before it.

    Servers that do not separate it leave ``<think>`` around thoughts, or its end alone, where their
    template has said the beginning.

    Example:
        >>> texts = ("<think>B? No.</think> A", "Not B.</think>A", "<b>C</b>")
        >>> [strip_reasoning(text) for text in texts]
        [' A', 'A', '<b>C</b>']
    """
    return _THOUGHT_END.split(_THOUGHT.sub("", text))[-1]


def extract_json_object(text: str) -> dict[str, Any] | None:
    """Return the one JSON object of a text, bare or between other words, else None.

    Example:
        >>> texts = ('Sure! ```json {"a": 1} ```', '{"a": 1} {"b": 2}')
        >>> [extract_json_object(text) for text in texts]
        [{'a': 1}, None]
    """
    start, end = text.find("{"), text.rfind("}")
    if start < 0 or end < start:
        return None
    try:
        found = json.loads(text[start : end + 1])
    except (ValueError, RecursionError):
        return None
    return found if isinstance(found, dict) else None
