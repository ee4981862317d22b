"""The options of verbs that ask a language model: which one, what it may cost, its replies.

A verb that ``with_model_options`` has these options on the command line and gets them as one value.
"""

import inspect
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, fields, replace
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from world2minecraft.cli.panels import MORE

if TYPE_CHECKING:
    from world2minecraft.api.agents import ModelOptions as ApiModelOptions


Model = Annotated[
    str,
    typer.Option(
        "--model",
        help="The model on the server, where --agent does not name it.",
    ),
]
KeyEnv = Annotated[
    str,
    typer.Option(
        "--key-env",
        metavar="NAME",
        help="The environment variable that holds the key.",
        rich_help_panel=MORE,
    ),
]
MaxUsd = Annotated[
    float | None, typer.Option("--max-usd", help="Stop before more than this is spent, in dollars.")
]
MaxCalls = Annotated[
    int | None,
    typer.Option("--max-calls", help="Stop after this many questions.", rich_help_panel=MORE),
]
Prices = Annotated[
    Path | None,
    typer.Option("--prices", help="A YAML file of prices; see the docs.", rich_help_panel=MORE),
]
MaxPixels = Annotated[
    int,
    typer.Option(
        "--max-pixels",
        metavar="N",
        help="The most pixels of a picture that a model sees; larger ones are reduced.",
        rich_help_panel=MORE,
    ),
]
MAX_PIXELS = 1_048_576  # external_models.chat_messages.MAX_PX; a test compares them.
MaxTokens = Annotated[
    int,
    typer.Option(
        "--max-tokens",
        help="The longest reply, reasoning included; reasoning models need 8192.",
        min=1,
        rich_help_panel=MORE,
    ),
]
Timeout = Annotated[
    float,
    typer.Option(
        "--timeout", help="The longest attempt, in seconds.", min=0.1, rich_help_panel=MORE
    ),
]
Temperature = Annotated[
    float,
    typer.Option(
        "--temperature",
        help="The temperature of replies; below 0 for that of the server.",
        rich_help_panel=MORE,
    ),
]
Replay = Annotated[
    Path | None,
    typer.Option(
        "--replay",
        metavar="FILE",
        help="Take all replies from the replies.jsonl of a run; send no request.",
    ),
]


@dataclass(frozen=True)
class ModelOptions:
    """The options of a language model, as on the command line."""

    model: Model = ""
    key_env: KeyEnv = ""
    max_usd: MaxUsd = None
    max_calls: MaxCalls = None
    prices: Prices = None
    max_tokens: MaxTokens = 1024
    timeout: Timeout = 60.0
    temperature: Temperature = 0.0
    replay: Replay = None

    def value(self) -> "ApiModelOptions":
        """Return them as the public API takes them."""
        from world2minecraft.api.agents import ModelOptions as ApiModelOptions

        given = asdict(self)
        given["timeout_s"] = given.pop("timeout")
        given["temperature"] = None if self.temperature < 0 else self.temperature
        return ApiModelOptions(**given)


DEFAULTS = ModelOptions()


def with_model_options(
    defaults: ModelOptions = DEFAULTS,
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Give a verb the options of a model in place of its parameter ``model_options``.

    Args:
        defaults: their values where the command line does not set them.
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


def cost_line(cost: Mapping[str, Any]) -> str:
    """Return what was asked and what that cost, in a line."""
    usd = "an unknown sum" if cost["usd"] is None else f"${cost['usd']:.4f}"
    tokens = cost["prompt_tokens"] + cost["completion_tokens"]
    return (
        f"{cost['calls']:,} questions and {cost['replayed']:,} from the record, "
        f"{tokens:,} tokens, {usd}"
    )
