"""Options of verbs that use a language model: which model, cost limits, and recorded replies.

A verb decorated with ``with_model_options`` accepts these options on the command line and receives
them as one value.
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
        help="Model name on the server, if --agent does not include it.",
    ),
]
KeyEnv = Annotated[
    str,
    typer.Option(
        "--key-env",
        metavar="NAME",
        help="Environment variable that contains the API key.",
        rich_help_panel=MORE,
    ),
]
MaxUsd = Annotated[float | None, typer.Option("--max-usd", help="Cost limit in US dollars.")]
MaxCalls = Annotated[
    int | None,
    typer.Option("--max-calls", help="Maximum number of requests.", rich_help_panel=MORE),
]
Prices = Annotated[
    Path | None,
    typer.Option(
        "--prices", help="YAML file with prices; see the documentation.", rich_help_panel=MORE
    ),
]
MaxPixels = Annotated[
    int,
    typer.Option(
        "--max-pixels",
        metavar="N",
        help="Maximum number of pixels in an image; larger images are downscaled.",
        rich_help_panel=MORE,
    ),
]
MAX_PIXELS = 1_048_576  # external_models.chat_messages.MAX_PX; a test compares them.
MaxTokens = Annotated[
    int,
    typer.Option(
        "--max-tokens",
        help="Maximum reply length including reasoning; reasoning models need 8192.",
        min=1,
        rich_help_panel=MORE,
    ),
]
Timeout = Annotated[
    float,
    typer.Option(
        "--timeout", help="Timeout of one request in seconds.", min=0.1, rich_help_panel=MORE
    ),
]
Temperature = Annotated[
    float,
    typer.Option(
        "--temperature",
        help="Sampling temperature; negative for the server's default.",
        rich_help_panel=MORE,
    ),
]
Replay = Annotated[
    Path | None,
    typer.Option(
        "--replay",
        metavar="FILE",
        help="Use the replies in a replies.jsonl instead of sending requests.",
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
        """Return the options as a ``ModelOptions`` value of the public API."""
        from world2minecraft.api.agents import ModelOptions as ApiModelOptions

        given = asdict(self)
        given["timeout_s"] = given.pop("timeout")
        given["temperature"] = None if self.temperature < 0 else self.temperature
        return ApiModelOptions(**given)


DEFAULTS = ModelOptions()


def with_model_options(
    defaults: ModelOptions = DEFAULTS,
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Replace the parameter ``model_options`` of a verb with individual model options.

    Args:
        defaults: Option values to use if they are not given on the command line.
    """
    options = [
        inspect.Parameter(
            one.name, inspect.Parameter.KEYWORD_ONLY, annotation=one.type,
            default=getattr(defaults, one.name),
        )
        for one in fields(ModelOptions)
    ]  # fmt: skip

    def with_options(run: Callable[..., Any]) -> Callable[..., Any]:
        """Return the verb with one parameter for each model option."""

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
    """Return the number of requests and their cost as one line of text."""
    usd = "unknown cost" if cost["usd"] is None else f"${cost['usd']:.4f}"
    tokens = cost["prompt_tokens"] + cost["completion_tokens"]
    return (
        f"{cost['calls']:,} requests and {cost['replayed']:,} recorded replies, "
        f"{tokens:,} tokens, {usd}"
    )
