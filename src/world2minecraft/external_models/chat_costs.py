"""Costs of model calls: prices by model, and a ledger with limits on calls and cost.

Servers report tokens but not prices, so the cost is computed here: before a call as an upper bound,
and after it from the reported tokens. An attempt that timed out, was interrupted or had no reply
may still be billed, so it counts with its upper bound. A ledger is thread-safe.
"""

import threading
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import MALFORMED, BudgetError, DamagedFileError, UsageError
from world2minecraft.core.files import load_plain_yaml, read_bytes
from world2minecraft.external_models.chat_messages import Question, Reply

PRICES_FILE = Path(__file__).with_name("chat_prices.yaml")
MAX_PRICES_BYTES = 1 << 20
CHARACTERS_PER_TOKEN = 3  # English has about 4; fewer is the careful side.
TOKENS_PER_PICTURE = 1600  # A picture of 1280x720 takes 1,196 in Qwen2.5-VL, others up to 1,600.


@dataclass(frozen=True)
class Price:
    """The prices of a model in US dollars per million prompt and completion tokens."""

    prompt_usd: float
    completion_usd: float

    def of(self, prompt_tokens: int, completion_tokens: int) -> float:
        """Return the cost in US dollars.

        Example:
            >>> Price(1.25, 10.0).of(1000, 100)
            0.00225
        """
        millionths = prompt_tokens * self.prompt_usd + completion_tokens * self.completion_usd
        return millionths / 1e6


def read_prices(path: str | Path = PRICES_FILE) -> dict[str, Price]:
    """Read a price table from YAML, in US dollars per million prompt and completion tokens.

    Each line has the form ``MODEL: [prompt, completion]``.

    Raises:
        InputError: If the file is missing.
        DamagedFileError: If the file is not a valid price table.
    """
    try:
        table = load_plain_yaml(read_bytes(path, MAX_PRICES_BYTES))
        prices = {str(name): Price(*map(float, pair)) for name, pair in table.items()}
    except MALFORMED as error:
        raise DamagedFileError(
            path, "is not a valid price table; expected lines such as `MODEL: [1.25, 10.0]`"
        ) from error
    for name, price in prices.items():
        if not (0 <= price.prompt_usd < 1e6 and 0 <= price.completion_usd < 1e6):
            raise DamagedFileError(path, f"prices of {name} must be non-negative dollar amounts")
    return prices


def find_price(model: str, prices: Mapping[str, Price]) -> Price | None:
    """Return the price of a model, by its name or by the longest known prefix of it.

    Example:
        >>> table = {"gpt-4o": Price(2.5, 10), "gpt-4o-mini": Price(0.15, 0.6)}
        >>> find_price("gpt-4o-mini-2024-07-18", table).prompt_usd, find_price("gpt-5", table)
        (0.15, None)
    """
    fitting = [name for name in prices if model == name or model.startswith(f"{name}-")]
    return prices[max(fitting, key=len)] if fitting else None


def estimate_tokens(question: Question) -> int:
    """Return an upper bound of a question's tokens, from its characters and images."""
    return question.characters // CHARACTERS_PER_TOKEN + question.pictures * TOKENS_PER_PICTURE + 1


class Ledger:
    """A counter of calls, tokens and cost that rejects calls beyond its limits."""

    def __init__(
        self,
        price: Price | None = None,
        *,
        max_usd: float | None = None,
        max_calls: int | None = None,
    ):
        """Create an empty ledger.

        Args:
            price: The price of the model, if known.
            max_usd: The maximum cost in US dollars. None is unlimited.
            max_calls: The maximum number of calls. None is unlimited.

        Raises:
            UsageError: If the cost is limited but the price is unknown, or a limit is negative.
        """
        if max_usd is not None and price is None:
            raise UsageError(
                "the price of this model is unknown, so the cost limit (--max-usd) cannot be "
                "enforced; pass a price file (--prices), or limit the calls (--max-calls)"
            )
        if (max_usd is not None and not max_usd >= 0) or (max_calls is not None and max_calls < 0):
            raise UsageError(
                "the limits on cost and calls (--max-usd, --max-calls) must be 0 or more"
            )
        self.price, self.max_usd, self.max_calls = price, max_usd, max_calls
        self.calls = self.replayed = self.prompt_tokens = self.completion_tokens = 0
        self._held_usd = 0.0  # What the calls under way may cost,
        self._lost_usd = 0.0  # and what those may have that nothing came of.
        self._lock = threading.Lock()

    @property
    def usd(self) -> float | None:
        """The maximum cost so far in US dollars, or None if the price is unknown."""
        if self.price is None:
            return None
        return self.price.of(self.prompt_tokens, self.completion_tokens) + self._lost_usd

    def hold(self, question: Question) -> float:
        """Reserve the maximum cost of a call, and return it. ``settle`` releases it.

        Raises:
            BudgetError: If the call would exceed a limit.
        """
        most = 0.0
        if self.price is not None:
            most = self.price.of(estimate_tokens(question), question.max_tokens)
        with self._lock:
            if self.max_calls is not None and self.calls >= self.max_calls:
                raise BudgetError(
                    f"{self.calls:,} calls have been made, which is the limit (--max-calls); raise "
                    "it to continue"
                )
            self._check(self._held_usd, most)
            self.calls += 1
            self._held_usd += most
        return most

    def lose(self, held_usd: float) -> None:
        """Count a failed attempt that may be billed with its maximum cost."""
        with self._lock:
            self._lost_usd += held_usd

    def hold_again(self, held_usd: float) -> None:
        """Check that a reserved call may be attempted again.

        Raises:
            BudgetError: If another attempt would exceed a limit.
        """
        with self._lock:
            self._check(self._held_usd - held_usd, held_usd)

    def _check(self, others_usd: float, most_usd: float) -> None:
        """Check that a call does not exceed the limit, given past costs and reservations."""
        spent = (self.usd or 0.0) + others_usd
        if self.max_usd is not None and spent + most_usd > self.max_usd:
            raise BudgetError(
                f"${spent:.4f} has been spent and the next call may cost ${most_usd:.4f}, "
                f"more than the limit of ${self.max_usd:.4f} (--max-usd); raise it to continue"
            )

    def settle(self, held_usd: float, reply: Reply | None) -> None:
        """Release a reservation, and count the tokens of the reply if there is one."""
        with self._lock:
            self._held_usd -= held_usd
            if reply is not None:
                self.prompt_tokens += reply.prompt_tokens
                self.completion_tokens += reply.completion_tokens

    def book_replay(self) -> None:
        """Count a reply from the cache, which costs nothing."""
        with self._lock:
            self.replayed += 1

    def to_json(self) -> dict[str, Any]:
        """Return the totals for reports as JSON data."""
        return {
            "calls": self.calls,
            "replayed": self.replayed,
            "prompt_tokens": self.prompt_tokens,
            "completion_tokens": self.completion_tokens,
            "usd": self.usd,
        }
