"""The options of ``w2m train``, and the run that their words mean."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from world2minecraft.networks.config import RunConfig


def _option(*names: str, text: str, metavar: str | None = None) -> Any:
    return typer.Option(*names, help=text, metavar=metavar)


Network = Annotated[
    str, typer.Argument(metavar="NET", help="monoscene, iso ...; left out with --config.")
]
Data = Annotated[
    list[str] | None,
    _option("--data", metavar="DIR[:WEIGHT]",
            text="A data set; often for several, drawn from by their weights."),
]  # fmt: skip
Out = Annotated[Path, _option("--out", metavar="RUN", text="The run's folder.")]
Config = Annotated[
    Path | None, _option("--config", metavar="FILE", text="All settings, of a run.yaml.")
]
Preset = Annotated[
    str, _option("--preset", text="smoke, quick, 1k (usual) or 8k: sizes and steps together.")
]
Size = Annotated[str | None, _option("--size", text="tiny, small or full.")]
Backbone = Annotated[
    str | None, _option("--backbone", metavar="hf:ID", text="Pictures are seen by transformers'.")
]
GridName = Annotated[str | None, _option("--grid", text="0.16 or 0.08: metres a cell.")]
Image = Annotated[str, _option("--image", metavar="WxH", text="Of pictures; 320x240.")]
Depth = Annotated[
    str | None, _option("--depth", text="taught (usual), given to the network, or none.")
]
Steps = Annotated[int | None, _option("--steps", text="2000 by default.")]
Batch = Annotated[int | None, _option("--batch", text="Frames a step; 4.")]
Rate = Annotated[float | None, _option("--lr", text="Learning rate; 5e-4.")]
Precision = Annotated[str | None, _option("--precision", text="auto, bf16 or 32.")]
ValShare = Annotated[
    float | None, _option("--val-share", text="Of scenes, held out; 0: the test split.")
]
Patience = Annotated[
    int | None, _option("--patience", text="Validations without a gain before it stops.")
]
Seed = Annotated[int | None, _option("--seed", text="The same seed, the same run.")]
Threads = Annotated[int | None, _option("--threads", text="Of the CPU; all.")]
Workers = Annotated[int | None, _option("--workers", text="Processes that make batches; 0.")]
Device = Annotated[str, _option("--device", text="auto, cpu or cuda.")]
Cache = Annotated[str, _option("--cache", metavar="DIR|off", text="Where decoded frames are kept.")]


def run_config(
    network: str, data: list[str], config: Path | None, preset: str, changes: dict[str, Any]
) -> "RunConfig":
    """Return the run that the options mean. Raises UsageError, UnknownNameError or InputError."""
    from dataclasses import replace

    from world2minecraft.core.errors import UsageError
    from world2minecraft.networks.config import DataSource, RunConfig, read_config

    sources = tuple(DataSource.parse(text) for text in data)
    if config is not None:
        if network or preset:
            raise UsageError("--config says network and sizes; leave NET and --preset out")
        held = read_config(config)
        return replace(held, **(changes | ({"data": sources} if sources else {})))
    if not network:
        raise UsageError("no network; give its name, such as w2m train monoscene --data DIR")
    made = RunConfig(network, sources)
    return replace(made.with_preset(preset) if preset else made, **changes)


def image_size(text: str) -> tuple[int, int]:
    """Return what ``320x240`` means. Raises UsageError."""
    from world2minecraft.core.errors import UsageError

    sides = text.lower().split("x")
    if len(sides) != 2 or not all(side.isdigit() for side in sides):
        raise UsageError(f"--image is WIDTHxHEIGHT, such as 320x240, not {text!r}")
    return int(sides[0]), int(sides[1])


def check_extra() -> None:
    """Refuse to begin without what training is made of. Raises MissingExtraError."""
    from importlib.util import find_spec

    from world2minecraft.core.errors import MissingExtraError

    if any(
        find_spec(name) is None for name in ("torch", "lightning", "safetensors", "tensorboard")
    ):
        raise MissingExtraError("training", "train")
