"""Client for language models on any server that speaks OpenAI's chat protocol.

``ChatModel.ask`` takes turns of text and pictures and returns a reply: from the record where the
same was asked before, else from the server, with bounded repeats, and never over the budget.

Example::

    model = open_chat("gemini", store=ReplyStore("replies.jsonl"), max_usd=0.5)
    model.ask((Turn("user", ("What is this?", Picture(jpeg))),)).text
"""

import random
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any, Protocol

from world2minecraft.core.errors import ServerError, UsageError
from world2minecraft.external_models.chat_costs import Ledger, find_price, read_prices
from world2minecraft.external_models.chat_messages import Question, Reply, Turn
from world2minecraft.external_models.chat_transport import (
    BusyServerError,
    ChatTransport,
    resolve_endpoint,
)
from world2minecraft.external_models.reply_cache import ReplyStore

ATTEMPTS = 5  # As often is a busy server asked; with the waits below that is about a minute.
FIRST_WAIT_S, MAX_WAIT_S = 1.0, 30.0
TIMEOUT_S = 60.0  # Of one attempt, from the question to the last byte.


class Transport(Protocol):
    """Sends a question to a server once."""

    def ask(self, question: Question) -> Reply:
        """Return the reply; raises the errors of ``chat_transport``."""
        ...


class ChatModel:
    """A model on a server, with its record of replies and its budget. Threads may share it.

    ``rung`` is how strictly a reply format can be enforced; ``structured_replies`` lowers it for
    good where the server refuses.
    """

    def __init__(
        self,
        name: str,
        transport: Transport | None,
        *,
        store: ReplyStore | None = None,
        ledger: Ledger | None = None,
        temperature: float | None = 0.0,
        max_tokens: int = 1024,
        attempts: int = ATTEMPTS,
        sleep: Callable[[float], None] = time.sleep,
    ):
        """Take a transport, None where all replies come from the store."""
        if attempts < 1:
            raise UsageError(f"a question is asked at least once, not {attempts} times")
        self.name, self._transport, self._store = name, transport, store
        self.ledger = Ledger() if ledger is None else ledger
        self.temperature, self.max_tokens = temperature, max_tokens
        self.attempts, self._sleep = attempts, sleep
        self.rung = 0

    def ask(
        self, turns: tuple[Turn, ...], *, form: dict[str, Any] | None = None, sample: int = 0
    ) -> tuple[str, Reply]:
        """Ask, and return the key of the question with the reply.

        Raises:
            BudgetError: a cap is reached. ServerError and its kinds: there is no reply.
            InputError: only recorded replies are wanted and this question has none.
        """
        question = Question(self.name, turns, self.temperature, self.max_tokens, form, sample)
        found = self._store.get(question) if self._store is not None else None
        if found is not None:
            self.ledger.book_replay()
            return question.key, found
        if self._transport is None:
            raise UsageError("a model without a server answers from a record alone; give one")
        try:
            reply = self._ask_paid(self._transport, question)
        except ServerError as error:
            if self._store is not None:
                self._store.put_failure(question, error)
            raise
        if self._store is not None:
            self._store.put(question, reply)
        return question.key, reply

    def _ask_paid(self, transport: Transport, question: Question) -> Reply:
        held = self.ledger.hold(question)
        try:
            reply = self._ask_with_retries(transport, question, held)
        except BaseException:
            self.ledger.settle(held, None)
            raise
        self.ledger.settle(held, reply)
        return reply

    def _ask_with_retries(self, transport: Transport, question: Question, held_usd: float) -> Reply:
        import tenacity  # noqa: PLC0415  # An extra.

        def once() -> Reply:
            try:
                return transport.ask(question)
            except ServerError as error:
                if getattr(error, "may_cost", False):
                    self.ledger.lose(held_usd)
                raise

        repeats = tenacity.Retrying(
            stop=tenacity.stop_after_attempt(self.attempts),
            wait=retry_wait_s,
            retry=tenacity.retry_if_exception_type(BusyServerError),
            before_sleep=lambda _: self.ledger.hold_again(held_usd),
            sleep=self._sleep,
            reraise=True,
        )
        reply = repeats(once)
        return replace(reply, attempts=repeats.statistics.get("attempt_number", 1))


def retry_wait_s(state: Any) -> float:
    """Return how long to wait before the next attempt, by the outcome of the last.

    As long as the server asks for, else twice as long each time, with random jitter, so that
    threads do not retry together.
    """
    error = state.outcome.exception()
    requested_s = getattr(error, "retry_after_s", None)
    if requested_s is not None:
        return min(requested_s, MAX_WAIT_S)
    longest = min(MAX_WAIT_S, FIRST_WAIT_S * 2 ** (state.attempt_number - 1))
    return longest * random.uniform(0.5, 1.0)


def open_chat(
    text: str,
    *,
    model: str = "",
    key_name: str | None = None,
    store: ReplyStore | None = None,
    prices: str | None = None,
    max_usd: float | None = None,
    max_calls: int | None = None,
    temperature: float | None = 0.0,
    max_tokens: int = 1024,
    timeout_s: float = TIMEOUT_S,
    attempts: int = ATTEMPTS,
) -> ChatModel:
    """Return a model by the name or the address of its server.

    Args:
        text: as ``resolve_endpoint`` takes it.
        model: its name; without it the usual one, or the only one that the server has.
        key_name: the variable of the environment that holds the key.
        store: replies that were recorded. One that only replays needs no server and no key.
        prices: a file of prices, None for the shipped one.
        max_usd: dollars that may be spent.
        max_calls: questions that may be asked.
        temperature: of the replies, None for the server's own.
        max_tokens: the most of a reply.
        timeout_s: of one attempt.
        attempts: how often a busy server is asked.

    Raises:
        UsageError: a name, an address, a key or a cap is wrong. ServerError: no model was named
        and the server does not list exactly one.
    """
    endpoint = resolve_endpoint(text, model=model, key_name=key_name)
    replays = store is not None and store.mode == "replay"
    transport = None if replays else ChatTransport(endpoint, timeout_s=timeout_s)
    name = endpoint.model or (single_model(transport.models(), endpoint.url) if transport else "")
    if not name:
        raise UsageError("a replay needs the name of the model that was asked: --model NAME")
    table = read_prices(prices) if prices else read_prices()
    ledger = Ledger(find_price(name, table), max_usd=max_usd, max_calls=max_calls)
    return ChatModel(
        name, transport, store=store, ledger=ledger, temperature=temperature, max_tokens=max_tokens,
        attempts=attempts,
    )  # fmt: skip


def single_model(names: tuple[str, ...], url: str) -> str:
    """Return the one name of several. Raises ServerError where there is none or more."""
    if len(names) == 1:
        return names[0]
    some = ", ".join(names[:8]) or "none"
    raise ServerError(f"{url} has these models: {some}; say which with --model NAME")
