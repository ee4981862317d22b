"""Options shared by all verbs that build: scale, style, palette, game version and settings."""

from typing import Annotated

import typer

from world2minecraft.cli.panels import MORE

SKETCHES_UNDER = 1.5  # Blocks per metre.

Scale = Annotated[
    float,
    typer.Option(
        "--blocks-per-metre", help="Scale: 1 (true to size), 2, 4, or 12.5 (one block per cell)."
    ),
]
Style = Annotated[
    str | None,
    typer.Option(
        "--style",
        help="Furniture made of blocks, finer display entities (display), or voxels.",
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
        help="Additional formats: litematic,nbt,glb,mcstructure.",
        rich_help_panel=MORE,
    ),
]
Version = Annotated[
    str,
    typer.Option("--mc-version", help="Minecraft version to write for.", rich_help_panel=MORE),
]
SettingList = Annotated[
    list[str] | None,
    typer.Option(
        "--set", metavar="KEY=VALUE", help="Change any parameter; w2m settings lists them."
    ),
]


def parse_settings(settings: list[str] | None) -> dict[str, str]:
    """Return ``--set`` options as a dictionary.

    Raises:
        UsageError: If an option is not KEY=VALUE.
    """
    from world2minecraft.core.errors import UsageError

    found = {}
    for setting in settings or []:
        key, equals, value = setting.partition("=")
        if not equals:
            raise UsageError(
                f"--set must be KEY=VALUE, such as find.cluster_radius=3, got {setting!r}"
            )
        found[key.strip()] = value.strip()
    return found


def split_names(text: str | None) -> list[str]:
    """Split a comma-separated list into its names."""
    return [name.strip() for name in (text or "").split(",") if name.strip()]


def print_style_note(blocks_per_metre: float, style: str | None) -> None:
    """Recommend ``--style display`` at scales where furniture made of blocks is rough."""
    if blocks_per_metre < SKETCHES_UNDER and style != "display":
        print("At this scale, furniture made of blocks is rough; --style display shows its shape.")
