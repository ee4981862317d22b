"""Select the scenes of a data set: generated houses, worlds on disk, and their recorded views."""

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

IMAGES_PER_SCENE = 50  # Where no number of images is given.
WORLD_SUFFIXES = (".schem", ".schematic", ".litematic", ".nbt")
WORLD_MARKS = ("level.dat", "scene.json", "build/scene.json")


def select_scenes(
    houses: int | None,
    worlds: Sequence[Path],
    preset: str = "",
    blocks_per_metre: float | None = None,
    given: GivenViews | None = None,
) -> list[SceneSpec]:
    """Return the scenes of a data set, not yet split.

    Args:
        houses: how many houses to generate; those of the preset where None.
        worlds: worlds, run folders and schematics; no houses are generated where there are any.
        preset: a preset that says how many houses there are, or none.
        blocks_per_metre: the scale of worlds that do not state it.
        given: recorded views of the one world.

    Raises:
        UsageError: the arguments contradict each other. InputError: a world is not found.
    """
    if worlds and houses is not None:
        raise UsageError("--houses are generated; give them without --worlds and --world")
    if given is not None and len(worlds) != 1:
        raise UsageError("--tour and --screenshots need exactly one --world")
    if worlds:
        for place in worlds:
            if not place.exists():
                raise InputError(place, "not found")
        found = source_scenes(worlds)
        return [replace(one, blocks_per_metre=blocks_per_metre, given=given) for one in found]
    count = preset_named(preset).houses if preset and houses is None else houses
    if count is not None and count < 1:
        raise UsageError(f"--houses must be 1 or more, not {count}")
    return house_scenes(count or 0)


def read_given_views(
    tour: Path | None, screenshots: Path | None, at: str, vertical_fov_deg: float | None
) -> tuple[GivenViews | None, int]:
    """Return recorded views and their number; None where views are to be planned.

    Args:
        tour: a tour file.
        screenshots: a folder of the game's own pictures with their poses.
        at: what the positions of screenshots are: feet or eye.
        vertical_fov_deg: of screenshots that do not state theirs.

    Raises:
        UsageError: the arguments contradict each other. InputError: a file cannot be read.
    """
    if tour is not None and screenshots is not None:
        raise UsageError("--tour and --screenshots exclude each other; give one of them")
    if tour is not None:
        return GivenViews(str(tour)), len(read_tour(tour))
    if screenshots is None:
        return None, 0
    given = GivenViews(str(screenshots), is_screenshots=True, at=position_reference(at))
    if vertical_fov_deg is not None:
        given = replace(given, vertical_fov_deg=vertical_fov_deg)
    return given, len(load_screenshot_views(given))


def position_reference(at: str) -> Literal["feet", "eye"]:
    """Return whether the positions of screenshots are at the feet or at the eye.

    Raises:
        UsageError: neither is given.
    """
    if at == "feet" or at == "eye":
        return at
    raise UsageError(
        "state where x, y, z of the screenshots are: --at feet, as F3 and most mods show, or "
        "--at eye; an error of 1.62 blocks spoils every label"
    )


def find_worlds(folder: Path) -> list[Path]:
    """Return the worlds, builds and schematics in a folder, sorted.

    Raises:
        InputError: the folder is not found, or holds none.
    """
    if not folder.is_dir():
        raise InputError(folder, "is not a folder of worlds")
    found = [
        path for path in sorted(folder.iterdir()) if path.name[0] != "." and is_scene_source(path)
    ]
    if not found:
        raise InputError(folder, "holds no world; w2m rooms generate --houses 4 --worlds DIR")
    return found


def is_scene_source(path: Path) -> bool:
    """Return whether a path is a world, a build or a schematic, by its name and its files."""
    if path.is_file():
        return path.suffix.lower() in WORLD_SUFFIXES
    return any((path / mark).exists() for mark in WORLD_MARKS)
