"""What the verbs that ask a model share: whom to ask, what it may cost, and where replies are."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.models.chat import ChatModel

REPLIES_FILE = "replies.jsonl"

Model = Annotated[
    str, typer.Option("--model", help="The model on the server, where --agent does not say it.")
]
KeyEnv = Annotated[
    str,
    typer.Option(
        "--key-env", metavar="NAME", help="The variable of the environment that holds the key."
    ),
]
MaxUsd = Annotated[
    float | None, typer.Option("--max-usd", help="Stop before more dollars than this are spent.")
]
MaxCalls = Annotated[int | None, typer.Option("--max-calls", help="Stop after so many questions.")]
Prices = Annotated[
    Path | None,
    typer.Option("--prices", help="A YAML file of prices; see docs."),
]
MaxPixels = Annotated[
    int,
    typer.Option(
        "--max-pixels", metavar="N", help="Of a picture that a model sees; larger ones are shrunk."
    ),
]
MAX_PIXELS = 1_048_576  # models.chat_pictures.MOST_PX, which a test holds it to.
Timeout = Annotated[
    float, typer.Option("--timeout", help="Seconds that one attempt may take.", min=0.1)
]
Temperature = Annotated[
    float, typer.Option("--temperature", help="Of the replies; below 0 for the server's own.")
]
Replay = Annotated[
    Path | None,
    typer.Option(
        "--replay", metavar="FILE", help="Take all replies from a run's replies.jsonl; ask nobody."
    ),
]


def opened_chat(
    agent: str, out: Path, model: str, key_env: str, max_usd: float | None,
    max_calls: int | None, prices: Path | None, timeout: float, temperature: float,
    replay: Path | None,
) -> "ChatModel":  # fmt: skip
    """Return the model that the options name, its replies kept in ``out``.

    Raises:
        UsageError: an option is wrong. ServerError: the server tells of no model.
    """
    from world2minecraft.models.chat import open_chat
    from world2minecraft.models.chat_store import ReplyStore

    store = ReplyStore(replay, "replay") if replay else ReplyStore(out / REPLIES_FILE)
    return open_chat(
        agent,
        model=model,
        key_name=key_env or None,
        store=store,
        prices=str(prices) if prices else None,
        max_usd=max_usd,
        max_calls=max_calls,
        timeout_s=timeout,
        temperature=None if temperature < 0 else temperature,
    )


def cost_line(chat: "ChatModel") -> str:
    """Return what a run asked and what that cost, in a line."""
    told = chat.ledger.told()
    usd = "an unknown sum" if told["usd"] is None else f"${told['usd']:.4f}"
    tokens = told["prompt_tokens"] + told["completion_tokens"]
    return (
        f"{told['calls']:,} questions and {told['replayed']:,} from the record, "
        f"{tokens:,} tokens, {usd}"
    )
