"""Costs of model calls: prices by model, and a ledger with caps on calls and money.

Servers report tokens, not money; so money is counted here, before a call by the most that it may
cost and after it by what it took. An attempt that came too late, broke off or gave no reply may
have been paid all the same, and counts by its most. A ledger is shared by threads.
"""

import threading
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import BudgetError, DamagedFileError, UsageError
from world2minecraft.core.files import load_plain_yaml, read_bytes
from world2minecraft.external_models.chat_messages import Question, Reply

PRICES_FILE = Path(__file__).with_name("chat_prices.yaml")
MAX_PRICES_BYTES = 1 << 20
CHARACTERS_PER_TOKEN = 3  # English has about 4; fewer is the careful side.
TOKENS_PER_PICTURE = 1600  # A picture of 1280x720 takes 1,196 in Qwen2.5-VL, others up to 1,600.


@dataclass(frozen=True)
class Price:
    """US dollars for a million tokens, read and written."""

    prompt_usd: float
    completion_usd: float

    def of(self, prompt_tokens: int, completion_tokens: int) -> float:
        """Return dollars.

        Example:
            >>> Price(1.25, 10.0).of(1000, 100)
            0.00225
        """
        millionths = prompt_tokens * self.prompt_usd + completion_tokens * self.completion_usd
        return millionths / 1e6


def read_prices(path: str | Path = PRICES_FILE) -> dict[str, Price]:
    """Read a table of prices: YAML, ``MODEL: [dollars a million read, and written]``.

    Raises:
        InputError: the file is missing. DamagedFileError: it is no such table.
    """
    try:
        table = load_plain_yaml(read_bytes(path, MAX_PRICES_BYTES))
        prices = {str(name): Price(*map(float, pair)) for name, pair in table.items()}
    except (AttributeError, TypeError, ValueError) as error:
        raise DamagedFileError(
            path, "is no table of prices; a line is `MODEL: [1.25, 10.0]`"
        ) from error
    for name, price in prices.items():
        if not (0 <= price.prompt_usd < 1e6 and 0 <= price.completion_usd < 1e6):
            raise DamagedFileError(path, f"the prices of {name} must be dollars of 0 or more")
    return prices


def find_price(model: str, prices: Mapping[str, Price]) -> Price | None:
    """Return the price of a model: by its name, or by the longest name that it begins with.

    Example:
        >>> table = {"gpt-4o": Price(2.5, 10), "gpt-4o-mini": Price(0.15, 0.6)}
        >>> find_price("gpt-4o-mini-2024-07-18", table).prompt_usd, find_price("gpt-5", table)
        (0.15, None)
    """
    fitting = [name for name in prices if model == name or model.startswith(f"{name}-")]
    return prices[max(fitting, key=len)] if fitting else None


def estimate_tokens(question: Question) -> int:
    """Return how many tokens a question has at most, by its letters and pictures."""
    return question.characters // CHARACTERS_PER_TOKEN + question.pictures * TOKENS_PER_PICTURE + 1


class Ledger:
    """Counts calls, tokens and money, and refuses the call that would go over a cap."""

    def __init__(
        self,
        price: Price | None = None,
        *,
        max_usd: float | None = None,
        max_calls: int | None = None,
    ):
        """Begin at nothing.

        Raises:
            UsageError: money is capped but the price is not known, or a cap is negative.
        """
        if max_usd is not None and price is None:
            raise UsageError(
                "the price of this model is not known, so --max-usd cannot hold; "
                "add it to a file of prices and give --prices, or cap with --max-calls"
            )
        if (max_usd is not None and not max_usd >= 0) or (max_calls is not None and max_calls < 0):
            raise UsageError("caps on money and calls are 0 or more")
        self.price, self.max_usd, self.max_calls = price, max_usd, max_calls
        self.calls = self.replayed = self.prompt_tokens = self.completion_tokens = 0
        self._held_usd = 0.0  # What the calls under way may cost,
        self._lost_usd = 0.0  # and what those may have that nothing came of.
        self._lock = threading.Lock()

    @property
    def usd(self) -> float | None:
        """What was spent at most, None where the price is not known."""
        if self.price is None:
            return None
        return self.price.of(self.prompt_tokens, self.completion_tokens) + self._lost_usd

    def hold(self, question: Question) -> float:
        """Set aside the most that a call may cost and return it; ``settle`` gives it back.

        Raises:
            BudgetError: it would go over a cap.
        """
        most = 0.0
        if self.price is not None:
            most = self.price.of(estimate_tokens(question), question.max_tokens)
        with self._lock:
            if self.max_calls is not None and self.calls >= self.max_calls:
                raise BudgetError(
                    f"{self.calls:,} calls were made, all that --max-calls allows; give more"
                )
            self._check(self._held_usd, most)
            self.calls += 1
            self._held_usd += most
        return most

    def lose(self, held_usd: float) -> None:
        """Book an attempt that the server may have worked on, and that gave no reply: its most."""
        with self._lock:
            self._lost_usd += held_usd

    def hold_again(self, held_usd: float) -> None:
        """Make sure that a held call may be attempted once more. Raises BudgetError."""
        with self._lock:
            self._check(self._held_usd - held_usd, held_usd)

    def _check(self, others_usd: float, most_usd: float) -> None:
        """Refuse what may pass the cap beside what was spent and what other calls may cost."""
        spent = (self.usd or 0.0) + others_usd
        if self.max_usd is not None and spent + most_usd > self.max_usd:
            raise BudgetError(
                f"${spent:.4f} is spent and the next call may cost ${most_usd:.4f}: "
                f"over the ${self.max_usd:.4f} of --max-usd; give more"
            )

    def settle(self, held_usd: float, reply: Reply | None) -> None:
        """Book what a call took, nothing where it failed; see ``lose``."""
        with self._lock:
            self._held_usd -= held_usd
            if reply is not None:
                self.prompt_tokens += reply.prompt_tokens
                self.completion_tokens += reply.completion_tokens

    def book_replay(self) -> None:
        """Count a reply that came from a record and cost nothing."""
        with self._lock:
            self.replayed += 1

    def to_json(self) -> dict[str, Any]:
        """Return the sums, for reports."""
        return {
            "calls": self.calls,
            "replayed": self.replayed,
            "prompt_tokens": self.prompt_tokens,
            "completion_tokens": self.completion_tokens,
            "usd": self.usd,
        }
