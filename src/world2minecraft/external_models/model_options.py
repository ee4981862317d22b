"""Which language model answers, what it may cost, and where its replies are recorded."""

from dataclasses import dataclass
from pathlib import Path

from world2minecraft.external_models.chat_client import ChatModel, open_chat
from world2minecraft.external_models.reply_cache import ReplyStore

REPLIES_FILE = "replies.jsonl"


@dataclass(frozen=True)
class ModelOptions:
    """Options of a language model on a server.

    Every reply is recorded in ``replies.jsonl`` of the output folder; the same question is
    answered from the record and costs nothing.

    Attributes:
        model: the model on the server, where the agent does not name it.
        key_env: the environment variable that holds the key; that of the provider by default.
        max_usd: stop before more than this is spent, in dollars.
        max_calls: stop after this many questions.
        prices: a YAML file of prices; the shipped one by default.
        max_tokens: the longest reply, reasoning included.
        timeout_s: the longest attempt, in seconds.
        temperature: the temperature of replies; None for that of the server.
        replay: take all replies from this ``replies.jsonl`` and send no request.
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
        """Return the model of a provider or a server; its replies are recorded in ``out``.

        Raises:
            UsageError: an option is wrong. ServerError: the server lists no model.
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
