"""Selection of the scenes for a data set: generated houses, existing worlds and recorded views."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Literal

from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.minecraftocc.building.recorded_views import load_screenshot_views
from world2minecraft.minecraftocc.plan import (
    GivenViews,
    SceneSpec,
    house_scenes,
    preset_named,
    source_scenes,
)
from world2minecraft.rendering.views import read_tour

IMAGES_PER_SCENE = 50  # Without a requested number of images.
WORLD_SUFFIXES = (".schem", ".schematic", ".litematic", ".nbt")
WORLD_MARKS = ("level.dat", "scene.json", "build/scene.json")


def select_scenes(
    houses: int | None,
    worlds: Sequence[Path],
    preset: str = "",
    blocks_per_metre: float | None = None,
    given: GivenViews | None = None,
) -> list[SceneSpec]:
    """Select the scenes of a data set, without splitting them.

    Args:
        houses: Number of houses to generate. Defaults to that of the preset.
        worlds: Worlds, run folders and schematics to use instead of generated houses.
        preset: Name of a preset, or an empty string.
        blocks_per_metre: Scale for worlds that do not record their own.
        given: Recorded views, which require exactly one world.

    Raises:
        UsageError: If the arguments contradict each other.
        InputError: If a world is not found.
    """
    if worlds and houses is not None:
        raise UsageError("houses cannot be combined with worlds (--worlds, --world)")
    if given is not None and len(worlds) != 1:
        raise UsageError("tour and screenshots need exactly one world (--world)")
    if worlds:
        for place in worlds:
            if not place.exists():
                raise InputError(place, "not found")
        found = source_scenes(worlds)
        return [replace(one, blocks_per_metre=blocks_per_metre, given=given) for one in found]
    count = preset_named(preset).houses if preset and houses is None else houses
    if count is not None and count < 1:
        raise UsageError(f"houses must be 1 or more, got {count}")
    return house_scenes(count or 0)


def read_given_views(
    tour: Path | None, screenshots: Path | None, at: str, vertical_fov_deg: float | None
) -> tuple[GivenViews | None, int]:
    """Return the recorded views and their number, or None and 0 if no views are given.

    Args:
        tour: Tour file.
        screenshots: Folder of in-game screenshots with their poses.
        at: Reference point of the screenshot positions, ``feet`` or ``eye``.
        vertical_fov_deg: Vertical field of view of screenshots that do not record their own, in
            degrees.

    Raises:
        UsageError: If the arguments contradict each other.
        InputError: If a file cannot be read.
    """
    if tour is not None and screenshots is not None:
        raise UsageError("tour and screenshots cannot be combined; use only one of them")
    if tour is not None:
        return GivenViews(str(tour)), len(read_tour(tour))
    if screenshots is None:
        return None, 0
    given = GivenViews(str(screenshots), is_screenshots=True, at=position_reference(at))
    if vertical_fov_deg is not None:
        given = replace(given, vertical_fov_deg=vertical_fov_deg)
    return given, len(load_screenshot_views(given))


def position_reference(at: str) -> Literal["feet", "eye"]:
    """Check the reference point of screenshot positions, which must be ``feet`` or ``eye``.

    Raises:
        UsageError: If the value is neither of these.
    """
    if at == "feet" or at == "eye":
        return at
    raise UsageError(
        "the reference point of the screenshot positions is required: feet (as shown by F3 and "
        "most mods) or eye (--at feet, --at eye); a wrong choice shifts all labels by 1.62 blocks"
    )


def find_worlds(folder: Path) -> list[Path]:
    """Return the worlds, builds and schematics directly inside a folder, sorted by name.

    Raises:
        InputError: If the folder does not exist or contains no worlds.
    """
    if not folder.is_dir():
        raise InputError(folder, "not a folder; expected a folder that contains worlds")
    found = [
        path for path in sorted(folder.iterdir()) if path.name[0] != "." and is_scene_source(path)
    ]
    if not found:
        raise InputError(
            folder,
            "contains no worlds; generate some with w2m rooms generate --houses 4 --worlds DIR",
        )
    return found


def is_scene_source(path: Path) -> bool:
    """Return whether a path is a world, a build or a schematic, judging by its name and files."""
    if path.is_file():
        return path.suffix.lower() in WORLD_SUFFIXES
    return any((path / mark).exists() for mark in WORLD_MARKS)
