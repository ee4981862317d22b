"""Options of ``w2m dataset build`` and related verbs, and parsers for their values."""

from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.cli.panels import option
from world2minecraft.core.errors import UsageError

Folder = Annotated[Path, typer.Argument(metavar="DIR", help="Folder of the data set.")]
NewFolder = Annotated[
    Path | None,
    typer.Argument(metavar="DIR", help="Output folder of the data set.", show_default=False),
]
OutFolder = Annotated[
    Path | None, option("--out", "-o", text="Output folder, instead of DIR.",
                        metavar="DIR"),
]  # fmt: skip
Houses = Annotated[
    int | None,
    option("--houses", metavar="N", text="Generate this many furnished houses."),
]
Worlds = Annotated[
    Path | None,
    option("--worlds", metavar="DIR", text="Use all worlds, builds and schematics in a folder."),
]
World = Annotated[
    list[Path] | None,
    option("--world", "--schem", metavar="PLACE",
           text="World, run folder or schematic. Repeatable."),
]  # fmt: skip
TourFile = Annotated[
    Path | None, option("--tour", metavar="FILE", text="Tour file with the views of one --world.")
]
Screenshots = Annotated[
    Path | None,
    option("--screenshots", metavar="DIR",
           text="Folder of in-game screenshots of one --world, with poses."),
]  # fmt: skip
At = Annotated[
    str,
    option("--at", metavar="feet|eye",
           text="Reference point of screenshot positions; required with --screenshots."),
]  # fmt: skip
Images = Annotated[
    int | None,
    option("--images", metavar="N", text="Total number of images.", show_default="50 per scene"),
]
Preset = Annotated[
    str, option("--preset", text="Use the paper's exact number of images: 8k, 50k or 100k.")
]
TestShare = Annotated[
    float, option("--test-share", text="Fraction of images in test scenes.", more=True)
]
CameraName = Annotated[
    str, option("--camera", text="nyu: 640x480 as in NYUv2; paper: 1920x1129, 70 degrees.")
]
Size = Annotated[
    str,
    option("--size", metavar="WxH", text="Image size in pixels.", show_default="the camera's"),
]
Fov = Annotated[
    float | None,
    option("--fov", text="Vertical field of view in degrees.", show_default="the camera's"),
]
Voxel = Annotated[
    str, option("--voxel", text="Cell size in metres, or block for one cell per block.")
]
Region = Annotated[
    str,
    option("--region", more=True,
           text="paper (along axes or diagonals) or free (rotated with the view)."),
]  # fmt: skip
LabelsOnly = Annotated[
    bool, option("--labels-only", text="Write labels and masks without images and depth.")
]
ImageFormat = Annotated[str, option("--image-format", text="jpg, png or webp.", more=True)]
Quality = Annotated[int, option("--quality", text="JPEG and WebP quality, 1 to 100.", more=True)]
PaperCompat = Annotated[
    bool,
    option("--paper-compat", text="Also store K and E as printed in the paper.", more=True),
]
BlockMap = Annotated[
    str,
    option(
        "--block-map", more=True, text="Mapping from blocks to classes: nyu, paper, or a YAML file."
    ),
]
Scale = Annotated[
    float | None,
    option("--blocks-per-metre", text="Scale of worlds that do not record it; 1 is true to size."),
]
Hour = Annotated[
    float | None,
    option("--hour", more=True, text="Time of day for all scenes, 0 to 24.",
           show_default="each scene's own"),
]  # fmt: skip
Seed = Annotated[int, option("--seed", text="The same seed gives the same result.")]
EngineName = Annotated[
    str, option("--engine", more=True, text="pool: this machine; ray: a Ray cluster.")
]
Jobs = Annotated[
    int | None,
    option("--jobs", "-j", text="Number of processes.", show_default="one per core"),
]


def cells_of(voxel: str) -> float | None:
    """Return the cell size in metres, or None for one cell per block.

    Raises:
        UsageError: If the text is neither a number nor ``block``.
    """
    if voxel == "block":
        return None
    try:
        return float(voxel)
    except ValueError:
        raise UsageError(f"--voxel must be a size in metres or 'block', got {voxel!r}") from None
