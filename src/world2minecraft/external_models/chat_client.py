"""A client for language models on servers with an OpenAI-compatible chat API.

``ChatModel.ask`` accepts turns of text and images and returns a reply, either from the reply cache
or from the server. It retries a limited number of times and never exceeds the budget.

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

ATTEMPTS = 5  # Requests to a busy server; about a minute with the waits below.
FIRST_WAIT_S, MAX_WAIT_S = 1.0, 30.0
TIMEOUT_S = 60.0  # Time limit for one attempt, in seconds.


class Transport(Protocol):
    """The interface of objects that send a question to a server once."""

    def ask(self, question: Question) -> Reply:
        """Return the reply to a question.

        Raises:
            ServerError: If the server does not reply.
        """
        ...


class ChatModel:
    """A chat model behind a server, with its reply cache and its budget. It is thread-safe.

    ``rung`` is the strictness with which a reply format is enforced. ``structured_replies`` lowers
    it permanently if the server rejects a stricter one.
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
        """Create a model.

        Args:
            name: The name of the model.
            transport: The connection to the server. None if all replies come from ``store``.
            store: The reply cache.
            ledger: The budget. None counts without limits.
            temperature: The sampling temperature. None uses the server's default.
            max_tokens: The maximum number of tokens of a reply.
            attempts: The maximum number of attempts if the server is busy.
            sleep: The function for waiting between attempts.

        Raises:
            UsageError: If ``attempts`` is less than 1.
        """
        if attempts < 1:
            raise UsageError(f"attempts must be 1 or more, got {attempts}")
        self.name, self._transport, self._store = name, transport, store
        self.ledger = Ledger() if ledger is None else ledger
        self.temperature, self.max_tokens = temperature, max_tokens
        self.attempts, self._sleep = attempts, sleep
        self.rung = 0

    def ask(
        self, turns: tuple[Turn, ...], *, form: dict[str, Any] | None = None, sample: int = 0
    ) -> tuple[str, Reply]:
        """Ask a question, and return its key with the reply.

        Args:
            turns: The messages.
            form: The ``response_format`` of the protocol. None requests free text.
            sample: A number that distinguishes repetitions of the same question.

        Raises:
            BudgetError: If the limit on calls or cost is reached.
            ServerError: If the server does not reply.
            InputError: If the cache only replays and has no reply to this question.
        """
        question = Question(self.name, turns, self.temperature, self.max_tokens, form, sample)
        found = self._store.get(question) if self._store is not None else None
        if found is not None:
            self.ledger.book_replay()
            return question.key, found
        if self._transport is None:
            raise UsageError(
                "without a server, a model can only replay recorded replies; pass a reply cache"
            )
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
            """Ask once; count the held cost as spent if a failed request may have been billed."""
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
    """Return the seconds to wait before the next attempt.

    The server's Retry-After value is used if present. Otherwise the wait doubles with each attempt,
    with random jitter so that threads do not retry at the same time.
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
    """Open a chat model by the name or the address of its server.

    Args:
        text: The server, as accepted by ``resolve_endpoint``.
        model: The model name. The default is the server's default model, or its only one.
        key_name: The environment variable that contains the API key.
        store: The reply cache. One that only replays requires no server and no key.
        prices: A price file. None uses the built-in prices.
        max_usd: The maximum cost in US dollars.
        max_calls: The maximum number of questions.
        temperature: The sampling temperature. None uses the server's default.
        max_tokens: The maximum number of tokens of a reply.
        timeout_s: Seconds to wait for one attempt.
        attempts: The maximum number of attempts if the server is busy.

    Raises:
        UsageError: If a name, an address, a key or a limit is invalid.
        ServerError: If no model is named and the server does not offer exactly one.
    """
    endpoint = resolve_endpoint(text, model=model, key_name=key_name)
    replays = store is not None and store.mode == "replay"
    transport = None if replays else ChatTransport(endpoint, timeout_s=timeout_s)
    name = endpoint.model or (single_model(transport.models(), endpoint.url) if transport else "")
    if not name:
        raise UsageError("replaying requires the name of the recorded model (--model NAME)")
    table = read_prices(prices) if prices else read_prices()
    ledger = Ledger(find_price(name, table), max_usd=max_usd, max_calls=max_calls)
    return ChatModel(
        name, transport, store=store, ledger=ledger, temperature=temperature, max_tokens=max_tokens,
        attempts=attempts,
    )  # fmt: skip


def single_model(names: tuple[str, ...], url: str) -> str:
    """Return the only name of a list.

    Raises:
        ServerError: If there is no name, or more than one.
    """
    if len(names) == 1:
        return names[0]
    some = ", ".join(names[:8]) or "none"
    raise ServerError(f"{url} provides several models: {some}; choose one (--model NAME)")
