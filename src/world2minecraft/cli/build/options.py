"""The options of every verb that builds: scale, style, palette, version and further settings."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.reconstruction.parameters import Parameters

SKETCHES_UNDER = 1.5  # Blocks per metre.

Scale = Annotated[
    float,
    typer.Option(
        "--blocks-per-metre", help="Scale: 1 true size, 2, 4 or 12.5 (one voxel, one block)."
    ),
]
Style = Annotated[
    str | None,
    typer.Option("--style", help="Furniture of blocks (usual), display entities, or voxels."),
]
PaletteName = Annotated[
    str | None,
    typer.Option("--palette", help="vanilla (usual), a mod's, or a YAML file of yours."),
]
Formats = Annotated[
    str | None,
    typer.Option("--formats", metavar="A,B", help="Further forms: litematic,nbt,glb,mcstructure."),
]
Version = Annotated[str, typer.Option("--mc-version", help="The game version to write for.")]
Settings = Annotated[
    list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="Change any parameter.")
]


def with_build_options(
    parameters: "Parameters", style: str | None, palette: str | None, formats: str | None = None
) -> "Parameters":
    """Return the parameters with what the options name; what is None stays as it is.

    Raises:
        UsageError: there is no such style, palette or form. InputError: the palette's file is none.
    """
    from world2minecraft.reconstruction.parameters import with_settings

    if palette is not None:
        from world2minecraft.construction.palettes import load_palette

        load_palette(palette)  # What is wrong with it is said before minutes of work.
    chosen = {"style": style, "palette": _whole(palette)}
    settings = [f"build.{key}={value}" for key, value in chosen.items() if value is not None]
    return with_settings(parameters, settings + ([f"formats={formats}"] if formats else []))


def style_note(parameters: "Parameters") -> None:
    """Say, where blocks are as large as furniture, which style shows it all the same."""
    if parameters.blocks_per_metre < SKETCHES_UNDER and parameters.build.style != "display":
        print("At this scale furniture of blocks is a sketch; --style display shows it as it is.")


def _whole(palette: str | None) -> str | None:
    """Return a palette's name as it is, and its file by its whole path."""
    is_file = palette is not None and Path(palette).is_file()
    return str(Path(palette).resolve()) if palette is not None and is_file else palette
