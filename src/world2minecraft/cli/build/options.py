"""The options of every verb that builds: scale, style, palette, version and further settings."""

from typing import Annotated

import typer

from world2minecraft.cli.panels import MORE

SKETCHES_UNDER = 1.5  # Blocks per metre.

Scale = Annotated[
    float,
    typer.Option(
        "--blocks-per-metre", help="Scale: 1 (true size), 2, 4, or 12.5 (a block for each cell)."
    ),
]
Style = Annotated[
    str | None,
    typer.Option(
        "--style",
        help="Furniture of blocks, of finer display entities (display), or of voxels.",
        show_default="blocks",
    ),
]
PaletteName = Annotated[
    str | None,
    typer.Option(
        "--palette",
        help="vanilla, the palette of a mod, or a YAML file.",
        show_default="vanilla",
        rich_help_panel=MORE,
    ),
]
Formats = Annotated[
    str | None,
    typer.Option(
        "--formats",
        metavar="A,B",
        help="Further files: litematic,nbt,glb,mcstructure.",
        rich_help_panel=MORE,
    ),
]
Version = Annotated[
    str,
    typer.Option("--mc-version", help="Game version to write for.", rich_help_panel=MORE),
]
SettingList = Annotated[
    list[str] | None,
    typer.Option(
        "--set", metavar="KEY=VALUE", help="Change any parameter; w2m settings lists them."
    ),
]


def parse_settings(settings: list[str] | None) -> dict[str, str]:
    """Return ``--set`` options as keys and values.

    Raises:
        UsageError: one is not KEY=VALUE.
    """
    from world2minecraft.core.errors import UsageError

    found = {}
    for setting in settings or []:
        key, equals, value = setting.partition("=")
        if not equals:
            raise UsageError(
                f"--set takes key=value, not {setting!r}, such as --set find.cluster_radius=3"
            )
        found[key.strip()] = value.strip()
    return found


def split_names(text: str | None) -> list[str]:
    """Return the names of a list with commas."""
    return [name.strip() for name in (text or "").split(",") if name.strip()]


def print_style_note(blocks_per_metre: float, style: str | None) -> None:
    """Say, where blocks are as large as furniture, which style still shows its shape."""
    if blocks_per_metre < SKETCHES_UNDER and style != "display":
        print("At this scale, furniture made of blocks is rough; --style display shows its shape.")
