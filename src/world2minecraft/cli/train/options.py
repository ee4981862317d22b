"""Options of ``w2m train``."""

from pathlib import Path
from typing import Annotated, Any

import typer

from world2minecraft.cli.panels import MORE


def _option(*names: str, text: str, more: bool = False, **facts: Any) -> Any:
    panel = {"rich_help_panel": MORE} if more else {}
    return typer.Option(*names, help=text, **panel, **facts)


Network = Annotated[
    str,
    typer.Argument(
        metavar="NET",
        help="monoscene, iso, ndc_scene, symphonies or embodied; omit with --config.",
        show_default=False,
    ),
]
Data = Annotated[
    list[str] | None,
    _option("--data", metavar="DIR[:WEIGHT]",
            text="Data set with an optional sampling weight. Repeatable."),
]  # fmt: skip
Out = Annotated[Path, _option("--out", "-o", metavar="RUN", text="Output folder of the run.")]
Config = Annotated[
    Path | None, _option("--config", metavar="FILE", text="Read all settings from a run.yaml.")
]
Preset = Annotated[
    str,
    _option("--preset", text="Preset of sizes and steps: smoke, quick, 1k or 8k.",
            show_default="1k"),
]  # fmt: skip
Size = Annotated[
    str | None, _option("--size", text="Network size: tiny, small or full.", show_default="small")
]
Backbone = Annotated[
    str | None,
    _option("--backbone", metavar="hf:ID", more=True,
            text="Image backbone from the transformers library."),
]  # fmt: skip
GridName = Annotated[
    str | None,
    _option("--grid", text="Cell size in metres, 0.16 or 0.08.", show_default="0.16"),
]
Image = Annotated[
    str, _option("--image", metavar="WxH", text="Image size in pixels.", show_default="320x240")
]
Depth = Annotated[
    str | None,
    _option(
        "--depth",
        text="taught (training target), given (network input), or none.",
        show_default="taught",
    ),
]
Steps = Annotated[
    int | None, _option("--steps", text="Number of training steps.", show_default="2000")
]
Batch = Annotated[int | None, _option("--batch", text="Frames per step.", show_default="4")]
Rate = Annotated[float | None, _option("--lr", text="Learning rate.", show_default="5e-4")]
Precision = Annotated[
    str | None,
    _option(
        "--precision", text="Numeric precision: auto, bf16 or 32.", show_default="auto", more=True
    ),
]
ValShare = Annotated[
    float | None,
    _option("--val-share", show_default="0.1",
            text="Fraction of scenes held out for validation; 0 uses the test split."),
]  # fmt: skip
Patience = Annotated[
    int | None,
    _option("--patience", more=True, show_default="no limit",
            text="Validations without improvement before training stops."),
]  # fmt: skip
Seed = Annotated[
    int | None, _option("--seed", text="The same seed gives the same run.", show_default="0")
]
Threads = Annotated[
    int | None, _option("--threads", text="Number of CPU threads.", show_default="all", more=True)
]
Workers = Annotated[
    int | None,
    _option(
        "--workers", text="Number of processes that prepare batches.", show_default="0", more=True
    ),
]
Device = Annotated[str, _option("--device", text="auto, cpu or cuda.")]
Cache = Annotated[
    str,
    _option("--cache", metavar="DIR|off", text="Cache folder for decoded frames.",
            show_default="the user's cache folder", more=True),
]  # fmt: skip
