"""The options of ``w2m dataset build`` and of its neighbours, and what their words mean."""

from pathlib import Path
from typing import Annotated, Any

import typer

from world2minecraft.cli.panels import MORE
from world2minecraft.core.errors import UsageError


def _option(*names: str, text: str, more: bool = False, **facts: Any) -> Any:
    panel = {"rich_help_panel": MORE} if more else {}
    return typer.Option(*names, help=text, **panel, **facts)


Folder = Annotated[Path, typer.Argument(metavar="DIR", help="The data set.")]
NewFolder = Annotated[
    Path | None,
    typer.Argument(metavar="DIR", help="The data set to write.", show_default=False),
]
OutFolder = Annotated[
    Path | None, _option("--out", "-o", text="The data set to write, instead of DIR.",
                         metavar="DIR"),
]  # fmt: skip
Houses = Annotated[
    int | None,
    _option("--houses", metavar="N", text="Generate this many furnished houses."),
]
Worlds = Annotated[
    Path | None,
    _option("--worlds", metavar="DIR", text="Every world, build and schematic in a folder."),
]
World = Annotated[
    list[Path] | None,
    _option("--world", "--schem", metavar="PLACE",
            text="A world, a run's folder or a schematic; repeatable."),
]  # fmt: skip
TourFile = Annotated[
    Path | None, _option("--tour", metavar="FILE", text="Views of one --world: a tour file.")
]
Screenshots = Annotated[
    Path | None,
    _option("--screenshots", metavar="DIR",
            text="The game's own pictures of one --world, with their poses."),
]  # fmt: skip
At = Annotated[
    str,
    _option("--at", metavar="feet|eye",
            text="Where x, y, z of screenshots are; required with --screenshots."),
]  # fmt: skip
Images = Annotated[
    int | None,
    _option("--images", metavar="N", text="Images in all.", show_default="50 per scene"),
]
Preset = Annotated[
    str, _option("--preset", text="The paper's exact numbers of images: 8k, 50k or 100k.")
]
TestShare = Annotated[
    float, _option("--test-share", text="Share of images in test scenes.", more=True)
]
CameraName = Annotated[
    str, _option("--camera", text="nyu: 640x480 as in NYUv2; paper: 1920x1129, 70 degrees.")
]
Size = Annotated[
    str,
    _option("--size", metavar="WxH", text="Pixels of an image.", show_default="the camera's"),
]
Fov = Annotated[
    float | None,
    _option("--fov", text="Vertical field of view in degrees.", show_default="the camera's"),
]
Voxel = Annotated[
    str, _option("--voxel", text="Side of a cell in metres, or block: one cell per block.")
]
Region = Annotated[
    str,
    _option("--region", more=True,
            text="paper: along the axes or diagonals; free: turned with the view."),
]  # fmt: skip
LabelsOnly = Annotated[
    bool, _option("--labels-only", text="Write labels and masks, no images and no depth.")
]
ImageFormat = Annotated[str, _option("--image-format", text="jpg, png or webp.", more=True)]
Quality = Annotated[int, _option("--quality", text="Of JPEG and WebP, 1 to 100.", more=True)]
PaperCompat = Annotated[
    bool,
    _option("--paper-compat", text="Also store K and E as the paper prints them.", more=True),
]
BlockMap = Annotated[
    str,
    _option("--block-map", more=True, text="Classes of blocks: nyu, paper, or a YAML file."),
]
Scale = Annotated[
    float | None,
    _option("--blocks-per-metre", text="Scale of worlds that do not state it; 1 is true size."),
]
Hour = Annotated[
    float | None,
    _option("--hour", more=True, text="Time of day in all scenes, 0 to 24.",
            show_default="each scene's own"),
]  # fmt: skip
Seed = Annotated[int, _option("--seed", text="The same seed gives the same result.")]
EngineName = Annotated[
    str, _option("--engine", more=True, text="pool: this machine; ray: a Ray cluster.")
]
Jobs = Annotated[
    int | None,
    _option("--jobs", "-j", text="Number of processes.", show_default="one per core"),
]


def cells_of(voxel: str) -> float | None:
    """Return the side of a cell in metres, None for one cell per block. Raises UsageError."""
    if voxel == "block":
        return None
    try:
        return float(voxel)
    except ValueError:
        raise UsageError(f"--voxel is metres, such as 0.08, or block; not {voxel!r}") from None
