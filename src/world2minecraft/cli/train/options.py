"""Options of ``w2m train``."""

from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.cli.panels import option

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
    option("--data", metavar="DIR[:WEIGHT]",
           text="Data set with an optional sampling weight. Repeatable."),
]  # fmt: skip
Out = Annotated[Path, option("--out", "-o", metavar="RUN", text="Output folder of the run.")]
Config = Annotated[
    Path | None, option("--config", metavar="FILE", text="Read all settings from a run.yaml.")
]
Preset = Annotated[
    str,
    option("--preset", text="Preset of sizes and steps: smoke, quick, 1k or 8k.",
           show_default="1k"),
]  # fmt: skip
Size = Annotated[
    str | None, option("--size", text="Network size: tiny, small or full.", show_default="small")
]
Backbone = Annotated[
    str | None,
    option("--backbone", metavar="hf:ID", more=True,
           text="Image backbone from the transformers library."),
]  # fmt: skip
GridName = Annotated[
    str | None,
    option("--grid", text="Cell size in metres, 0.16 or 0.08.", show_default="0.16"),
]
Image = Annotated[
    str, option("--image", metavar="WxH", text="Image size in pixels.", show_default="320x240")
]
Depth = Annotated[
    str | None,
    option(
        "--depth",
        text="taught (training target), given (network input), or none.",
        show_default="taught",
    ),
]
Steps = Annotated[
    int | None, option("--steps", text="Number of training steps.", show_default="2000")
]
Batch = Annotated[int | None, option("--batch", text="Frames per step.", show_default="4")]
Rate = Annotated[float | None, option("--lr", text="Learning rate.", show_default="5e-4")]
Precision = Annotated[
    str | None,
    option(
        "--precision", text="Numeric precision: auto, bf16 or 32.", show_default="auto", more=True
    ),
]
ValShare = Annotated[
    float | None,
    option("--val-share", show_default="0.1",
           text="Fraction of scenes held out for validation; 0 uses the test split."),
]  # fmt: skip
Patience = Annotated[
    int | None,
    option("--patience", more=True, show_default="no limit",
           text="Validations without improvement before training stops."),
]  # fmt: skip
Seed = Annotated[
    int | None, option("--seed", text="The same seed gives the same run.", show_default="0")
]
Threads = Annotated[
    int | None, option("--threads", text="Number of CPU threads.", show_default="all", more=True)
]
Workers = Annotated[
    int | None,
    option(
        "--workers", text="Number of processes that prepare batches.", show_default="0", more=True
    ),
]
Device = Annotated[str, option("--device", text="auto, cpu or cuda.")]
Cache = Annotated[
    str,
    option("--cache", metavar="DIR|off", text="Cache folder for decoded frames.",
           show_default="the user's cache folder", more=True),
]  # fmt: skip
