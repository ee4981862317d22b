"""Structured replies, from a strict JSON schema down to plain text, with up to two repairs.

Servers that support it are held to a JSON schema. If a server rejects that, any JSON object is
requested, and then plain text. Replies are always validated, because servers do not reliably follow
their format. An invalid reply is sent back with a description of the problem, at most twice. After
that there is no value, and the attempts contain the reasons. Values are never guessed.
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
    """An error for a reply without the requested format, with a description for the model."""


@dataclass(frozen=True)
class ReplyFormat(Generic[Value]):
    """The required format of a reply.

    Attributes:
        name: The name of the format.
        schema: The JSON schema.
        words: A description of the format for models that are not held to the schema.
        read: The parser of a reply's text, which raises UnreadableError for an invalid reply.
        is_said: Whether the question already contains ``words``.
        rung: The index in ``RUNGS`` of the strictest format to try.
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
    """A single query with its rung, its key, the reply if there was one, and the problem."""

    rung: str
    key: str
    reply: Reply | None
    problem: str = ""


@dataclass(frozen=True)
class StructuredReply(Generic[Value]):
    """The value of a structured query, or None, with all attempts."""

    value: Value | None
    tries: tuple[Attempt, ...]

    @property
    def raw(self) -> str:
        """The text of the last reply, or ""."""
        texts = [one.reply.text for one in self.tries if one.reply is not None]
        return texts[-1] if texts else ""

    @property
    def problem(self) -> str:
        """The problem of the last attempt, or "" if there is a value."""
        return self.tries[-1].problem if self.tries and self.value is None else ""


def ask_structured(
    model: ChatModel,
    turns: tuple[Turn, ...],
    form: ReplyFormat[Value],
    *,
    repairs: int = REPAIRS,
    sample: int = 0,
) -> StructuredReply[Value]:
    """Query a model for a value in a given format.

    If a rung is rejected and the next one is accepted, the model does not try the rejected one
    again (``model.rung``). This does not count as a repair.

    Args:
        model: The model.
        turns: The messages.
        form: The format of the reply.
        repairs: The maximum number of repair attempts.
        sample: A number that distinguishes intended repetitions of the same question.

    Raises:
        RefusedQuestionError: If the server rejects even plain text.
        BudgetError: If the limit on calls or cost is reached.
        ServerError: If the server does not reply.
        InputError: If the cache only replays and has no reply.
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
    """Append a text to the last user turn, or as a new user turn.

    Many chat templates, and LLaMA-Factory's server, do not accept two consecutive turns of one
    role.
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
        problem = f"the reply was truncated at {model.max_tokens:,} tokens; be shorter"
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
    """Return the text of a reply without the model's reasoning.

    Servers that do not separate it leave ``<think>`` tags around it, or only the closing tag if the
    chat template contains the opening one.

    Example:
        >>> texts = ("<think>B? No.</think> A", "Not B.</think>A", "<b>C</b>")
        >>> [strip_reasoning(text) for text in texts]
        [' A', 'A', '<b>C</b>']
    """
    return _THOUGHT_END.split(_THOUGHT.sub("", text))[-1]


def extract_json_object(text: str) -> dict[str, Any] | None:
    """Return the only JSON object in a text, alone or surrounded by other text, or None.

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
