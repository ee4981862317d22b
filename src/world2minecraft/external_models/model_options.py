"""Options of a language model: the server, the budget and the reply cache."""

from dataclasses import dataclass
from pathlib import Path

from world2minecraft.external_models.chat_client import ChatModel, open_chat
from world2minecraft.external_models.reply_cache import ReplyStore

REPLIES_FILE = "replies.jsonl"


@dataclass(frozen=True)
class ModelOptions:
    """Options of a language model on a server.

    Every reply is recorded in ``replies.jsonl`` in the output folder. A repeated question is
    answered from this file at no cost.

    Attributes:
        model: The model on the server, if the agent does not name one.
        key_env: The environment variable with the API key. Empty uses the provider's default.
        max_usd: The maximum cost in US dollars.
        max_calls: The maximum number of questions.
        prices: A YAML file with prices. None uses the built-in prices.
        max_tokens: The maximum number of tokens of a reply, including reasoning.
        timeout_s: Seconds to wait for one attempt.
        temperature: The sampling temperature. None uses the server's default.
        replay: A ``replies.jsonl`` from which all replies are taken, without sending requests.
    """

    model: str = ""
    key_env: str = ""
    max_usd: float | None = None
    max_calls: int | None = None
    prices: str | Path | None = None
    max_tokens: int = 1024
    timeout_s: float = 60.0
    temperature: float | None = 0.0
    replay: str | Path | None = None

    def open(self, agent: str, out: str | Path) -> ChatModel:
        """Open the model of a provider or a server, recording its replies in ``out``.

        Raises:
            UsageError: If an option is invalid.
            ServerError: If the server does not offer a model.
        """
        store = (
            ReplyStore(self.replay, "replay")
            if self.replay
            else ReplyStore(Path(out) / REPLIES_FILE)
        )
        return open_chat(
            agent,
            model=self.model,
            key_name=self.key_env or None,
            store=store,
            prices=str(self.prices) if self.prices else None,
            max_usd=self.max_usd,
            max_calls=self.max_calls,
            max_tokens=self.max_tokens,
            timeout_s=self.timeout_s,
            temperature=self.temperature,
        )
