"""What the verbs that ask a model share: whom to ask, what it may cost, and where replies are.

A verb that ``with_model_options`` has their options on the command line and gets them as one value.
"""

import inspect
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from world2minecraft.external_models.chat_client import ChatModel

REPLIES_FILE = "replies.jsonl"

Model = Annotated[
    str, typer.Option("--model", help="The model on the server, where it is not named already.")
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
MAX_PIXELS = 1_048_576  # external_models.chat_messages.MAX_PX, which a test holds it to.
MaxTokens = Annotated[
    int,
    typer.Option(
        "--max-tokens", help="Of a reply, thoughts included; models that think want 8192.", min=1
    ),
]
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


@dataclass(frozen=True)
class ModelOptions:
    """What the command line says of a model."""

    model: Model = ""
    key_env: KeyEnv = ""
    max_usd: MaxUsd = None
    max_calls: MaxCalls = None
    prices: Prices = None
    max_tokens: MaxTokens = 1024
    timeout: Timeout = 60.0
    temperature: Temperature = 0.0
    replay: Replay = None

    def open(self, agent: str, out: Path) -> "ChatModel":
        """Return the model of an agent's name or address, its replies kept in ``out``.

        Raises:
            UsageError: an option is wrong. ServerError: the server tells of no model.
        """
        from world2minecraft.external_models.chat_client import open_chat
        from world2minecraft.external_models.reply_cache import ReplyStore

        store = ReplyStore(self.replay, "replay") if self.replay else ReplyStore(out / REPLIES_FILE)
        return open_chat(
            agent,
            model=self.model,
            key_name=self.key_env or None,
            store=store,
            prices=str(self.prices) if self.prices else None,
            max_usd=self.max_usd,
            max_calls=self.max_calls,
            max_tokens=self.max_tokens,
            timeout_s=self.timeout,
            temperature=None if self.temperature < 0 else self.temperature,
        )


DEFAULTS = ModelOptions()


def with_model_options(
    defaults: ModelOptions = DEFAULTS,
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Give a verb a model's options in place of its parameter ``model_options``, which they become.

    Args:
        defaults: what they are where the command line does not say them.
    """
    options = [
        inspect.Parameter(
            one.name, inspect.Parameter.KEYWORD_ONLY, annotation=one.type,
            default=getattr(defaults, one.name),
        )
        for one in fields(ModelOptions)
    ]  # fmt: skip

    def with_options(run: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(run)
        def called(**given: Any) -> Any:
            given_options = {one.name: given.pop(one.name) for one in options if one.name in given}
            return run(**given, model_options=replace(defaults, **given_options))

        signature = inspect.signature(run)
        own = [one for name, one in signature.parameters.items() if name != "model_options"]
        shown = signature.replace(parameters=[*own, *options])
        called.__signature__ = shown  # type: ignore[attr-defined]
        called.__annotations__ = {one.name: one.annotation for one in shown.parameters.values()}
        return called

    return with_options


def default_run_folder(agent: str) -> Path:
    """Return where a run of an agent is kept if nobody says where.

    Example:
        >>> default_run_folder("openai:gpt-4.1").name
        'vln_openai_gpt_4_1'
    """
    return Path(f"vln_{''.join(c if c.isalnum() else '_' for c in agent)[:40]}")


def cost_line(chat: "ChatModel") -> str:
    """Return what a run asked and what that cost, in a line."""
    told = chat.ledger.to_json()
    usd = "an unknown sum" if told["usd"] is None else f"${told['usd']:.4f}"
    tokens = told["prompt_tokens"] + told["completion_tokens"]
    return (
        f"{told['calls']:,} questions and {told['replayed']:,} from the record, "
        f"{tokens:,} tokens, {usd}"
    )
