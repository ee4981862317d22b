"""Reading and writing volumes in any format of the game and of other programs.

A scene format is a class, as in ``minecraft.formats``, and a line in ``SCENE_FORMATS``. If a run
folder or its ``build`` contains a ``scene.json``, the volume takes its labels and scale from that
file.
"""

from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np

from world2minecraft.core.errors import InputError, UnknownNameError, UsageError
from world2minecraft.core.registry import Registry
from world2minecraft.core.types import BlockVolume
from world2minecraft.core.whole_reads import unchanged
from world2minecraft.formats.object_names import name_table, read_run_names, read_world_names
from world2minecraft.formats.world_labels import Scene, read_scene
from world2minecraft.minecraft.file_format import FileFormat, Losses, WriteOptions
from world2minecraft.minecraft.formats import (
    FORMATS,
    LABELS,
    BlockFormat,
    block_formats,
    read_blocks,
)

SCENE_FILE = "scene.json"
SCENE_FORMATS = Registry(
    "scene_format",
    {
        "glb": "world2minecraft.formats.volume_formats:GltfFormat",
        "habitat": "world2minecraft.formats.volume_formats:HabitatFormat",
    },
)


def find_blocks(path: Path) -> Path:
    """Return the path of the blocks of a run or a build: its world, or its schematic.

    The world has priority because a player may have changed it. Other paths are returned unchanged.

    Raises:
        InputError: If a build folder contains neither.
    """
    build = next((p for p in (path, path / "build") if (p / SCENE_FILE).is_file()), None)
    if build is None:
        return path
    world, schematic = build / "world", build / "room.schem"
    if (world / "level.dat").is_file():
        return world
    if schematic.is_file():
        return schematic
    raise InputError(build, "contains a scene.json but neither world nor room.schem")


def with_scene_labels(volume: BlockVolume, path: Path) -> BlockVolume:
    """Return the volume with the labels and the scale of the scene that it belongs to.

    Args:
        volume: Blocks that were read.
        path: Path that was requested: a run, its ``build``, or a file or world inside it. A scene
            is used only if its labels match the blocks of the volume.

    Raises:
        DamagedFileError: If the scene exists and cannot be read.
    """
    places = (path, path / "build", path.parent)
    folder = next((place for place in places if (place / SCENE_FILE).is_file()), None)
    if folder is None:
        return volume
    scene = read_scene(folder)
    return apply_scene(volume, scene) if _overlaps(volume, scene) else volume


def apply_scene(volume: BlockVolume, scene: Scene) -> BlockVolume:
    """Return the volume with the scale of a scene and its labels on all existing blocks."""
    ours, theirs = overlapping_cells(volume, scene)
    semantic, instance = np.zeros_like(volume.semantic), np.zeros_like(volume.instance)
    is_block = volume.states[ours] > 0
    semantic[ours] = np.where(is_block, scene.semantic[theirs], 0)
    instance[ours] = np.where(is_block, scene.instance[theirs], 0)
    return replace(volume, semantic=semantic, instance=instance, block_to_room=scene.block_to_room)


def _overlaps(volume: BlockVolume, scene: Scene) -> bool:
    """Return whether most labelled cells of the scene are still blocks, so that it matches."""
    ours, theirs = overlapping_cells(volume, scene)
    wanted = int((scene.semantic > 0).sum())
    met = int(((scene.semantic[theirs] > 0) & (volume.states[ours] > 0)).sum())
    return wanted > 0 and met >= wanted / 2


def overlapping_cells(
    volume: BlockVolume, scene: Scene
) -> tuple[tuple[slice, ...], tuple[slice, ...]]:
    """Return the cells that a volume and a scene have in common, as slices of each."""
    low = np.maximum(volume.corner, scene.corner)
    high = np.minimum(
        np.add(volume.corner, volume.states.shape), np.add(scene.corner, scene.semantic.shape)
    )
    high = np.maximum(low, high)

    def window(corner: tuple[int, int, int]) -> tuple[slice, ...]:
        steps = zip(low - np.array(corner), high - np.array(corner), strict=True)
        return tuple(slice(max(int(a), 0), max(int(b), 0)) for a, b in steps)

    return window(volume.corner), window(scene.corner)


class GltfFormat(FileFormat):
    """Binary glTF, which can be read only if it was written by this program."""

    suffix = ".glb"
    keeps_labels = True

    def read(self, path: Path, losses: Losses) -> BlockVolume:
        """Read the blocks that are stored in the file beside the meshes."""
        from world2minecraft.formats.gltf import read_gltf  # noqa: PLC0415  # It needs numba.

        return read_gltf(path)

    def write(self, volume: BlockVolume, path: Path, options: WriteOptions, losses: Losses) -> None:
        """Write meshes, and store the blocks in the same file."""
        from world2minecraft.formats.gltf import write_gltf  # noqa: PLC0415  # It needs numba.

        told = options.other
        write_gltf(volume, path, templates=told.get("templates"), names=told.get("names"))


class HabitatFormat:
    """A folder for Habitat-Sim, which can be written but not read."""

    suffix = ".habitat"
    can_read = False
    can_write = True
    keeps_labels = True

    def is_at(self, path: Path) -> bool:
        """Return whether the path ends with the suffix of this format."""
        return path.is_dir() and path.suffix.lower() == self.suffix

    def read(self, path: Path, losses: Losses) -> BlockVolume:
        """Raise InputError, because meshes cannot be converted to blocks."""
        raise InputError(path, "contains meshes without blocks and cannot be read")

    def write(self, volume: BlockVolume, path: Path, options: WriteOptions, losses: Losses) -> None:
        """Write the scene dataset with meshes of the blocks."""
        from world2minecraft.formats.habitat import write_habitat  # noqa: PLC0415  # numba.
        from world2minecraft.minecraft.entities import BLOCK_DISPLAY  # noqa: PLC0415

        write_habitat(volume, path, name=path.stem, names=options.other.get("names"))
        losses.add("block states (the scene contains only meshes)", int((volume.states > 0).sum()))
        losses.add("block entities", len(volume.block_entities))
        undrawn = sum(entity.id != BLOCK_DISPLAY for entity in volume.entities)
        losses.add("entities other than block displays", undrawn)


def read_volume(path: str | Path, losses: Losses | None = None) -> BlockVolume:
    """Read a volume in any format: a block file, a world, a run folder or its ``build``.

    Labels and scale are read from a ``scene.json`` next to the blocks.

    Args:
        path: File or folder to read.
        losses: Counter of contents that a volume does not support.

    Raises:
        InputError: If the path does not exist, has an unknown format or cannot be read.
    """
    source, counted = Path(path), Losses() if losses is None else losses
    if not source.exists():
        raise InputError(source, "not found")
    with unchanged(source) if source.is_dir() else nullcontext():
        return _read_volume(source, counted)


def _read_volume(source: Path, counted: Losses) -> BlockVolume:
    for form in scene_formats():
        if form.is_at(source):
            return form.read(source, counted)
    try:
        volume = read_blocks(find_blocks(source), counted)
    except InputError as error:
        if not error.reason.startswith("is not in a supported format"):
            raise
        known = list_suffixes("read")
        raise InputError(source, f"is not a supported block file; supported: {known}") from None
    return with_scene_labels(volume, source)


def write_volume(
    volume: BlockVolume,
    path: str | Path,
    options: WriteOptions | None = None,
    losses: Losses | None = None,
) -> None:
    """Write a volume in the format given by the path's suffix, or as a world without a suffix.

    Raises:
        UsageError: If no format has this suffix.
        OutputError: If the path cannot be written.
    """
    target, counted = Path(path), Losses() if losses is None else losses
    form = format_for_path(target)
    form.write(volume, target, options or WriteOptions(), counted)
    if not form.keeps_labels:
        counted.add(LABELS, int((volume.semantic > 0).sum()))


def format_for_path(path: str | Path) -> BlockFormat:
    """Return the format with the suffix of a path.

    Raises:
        UsageError: If no writable format has this suffix.
    """
    suffix = Path(path).suffix.lower()
    for form in [*block_formats(), *scene_formats()]:
        if suffix == form.suffix:
            if form.can_write:
                return form
            raise UsageError(
                f"{path}: {suffix} can be read but not written; write a .schem instead"
            )
    known = list_suffixes("write")
    dots = "; the name of a world folder has no dot" if not suffix[1:].isalpha() else ""
    raise UsageError(f"{path}: unknown block format {suffix}; known: {known}{dots}")


def write_volume_formats(
    folder: str | Path,
    volume: BlockVolume,
    names: Sequence[str],
    options: WriteOptions | None = None,
    *,
    stem: str = "room",
) -> dict[str, Losses]:
    """Write a volume to a folder as ``room.SUFFIX`` in several formats.

    Args:
        folder: Output folder, which is created if necessary.
        volume: Blocks to write.
        names: Names of formats, such as ``litematic``, or suffixes with or without a dot.
        options: Game version and further options.
        stem: File name without the suffix.

    Returns:
        The contents that each format does not support, by the given name of the format.

    Raises:
        UnknownNameError: If a format is unknown.
        UsageError: If a format is a world folder or cannot be written.
        OutputError: If a file cannot be written.
    """
    forms = {name: format_by_name(name) for name in names}  # All are known before one is written.
    result: dict[str, Losses] = {}
    for name, form in forms.items():
        result[name] = Losses()
        write_volume(volume, Path(folder) / f"{stem}{form.suffix}", options, result[name])
    return result


def format_by_name(name: str) -> BlockFormat:
    """Return the format with a name or suffix that can be written as a separate file.

    Raises:
        UnknownNameError: If the format is unknown.
        UsageError: If the format is a world folder or cannot be written.
    """
    wanted = name.lower().removeprefix(".")
    for registry in (FORMATS, SCENE_FORMATS):
        for known in registry.names():
            form = registry.load(known)()
            if wanted in (known, form.suffix.removeprefix(".")) and form.suffix:
                if not form.can_write:
                    raise UsageError(f"the format {name!r} can be read but not written")
                return form
    raise UnknownNameError("format", name, writable_format_names())


def writable_format_names() -> list[str]:
    """Return the names of the formats that can be written as separate files."""
    pairs = [
        (name, registry.load(name)())
        for registry in (FORMATS, SCENE_FORMATS)
        for name in registry.names()
    ]
    return [name for name, form in pairs if form.can_write and form.suffix]


def scene_formats() -> list[BlockFormat]:
    """Return the formats that are not formats of the game."""
    return [SCENE_FORMATS.load(name)() for name in SCENE_FORMATS.names()]


def list_suffixes(verb: Literal["read", "write"]) -> str:
    """Return the suffixes that can be read or written, for error messages."""
    every = [*block_formats(), *scene_formats()]
    able = [form for form in every if (form.can_read if verb == "read" else form.can_write)]
    return ", ".join(form.suffix or "a world folder" for form in able)


def read_run_templates(folder: str | Path) -> Mapping[int, str]:
    """Return the furniture template of each object of a run folder, or an empty mapping.

    Raises:
        DamagedFileError: If ``placements.json`` exists and cannot be read.
    """
    path = Path(folder) / "placements.json"
    if not path.is_file():
        return {}
    from world2minecraft.formats.objects_and_placements import read_placements  # noqa: PLC0415

    return {placement.object_id: placement.template for placement in read_placements(path)}


def run_details(folder: str | Path) -> dict[str, Mapping[int, str]]:
    """Return the furniture template and the name of each object of a run, for ``WriteOptions``.

    Raises:
        DamagedFileError: If a file of the run exists and cannot be read.
    """
    return {"templates": read_run_templates(folder), "names": name_table(read_run_names(folder))}


def world_details(folder: str | Path) -> dict[str, Mapping[int, str]]:
    """Return what ``run_details`` returns, with the names of a world that was built before.

    Raises:
        DamagedFileError: If a file exists and cannot be read.
    """
    return {"templates": read_run_templates(folder), "names": name_table(read_world_names(folder))}
