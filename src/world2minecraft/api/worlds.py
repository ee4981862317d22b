"""Convert between worlds and block files, install worlds, and undo builds into worlds."""

import os
import sys
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, nullcontext, suppress
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from world2minecraft.api.results import Run
from world2minecraft.api.rooms import path_of
from world2minecraft.core.errors import InputError, OutputError, UsageError
from world2minecraft.core.file_names import readable_name
from world2minecraft.core.locks import folder_lock

if TYPE_CHECKING:
    from world2minecraft.core.types import BlockVolume
    from world2minecraft.formats.volume_crop import Box
    from world2minecraft.minecraft.file_format import Losses
    from world2minecraft.minecraft.worlds.launchers import Game

HABITAT_MARK = "*.scene_dataset_config.json"


@dataclass(frozen=True)
class Conversion:
    """The result of a conversion, with the contents that could not be read or written.

    Attributes:
        path: File or folder that was written.
        size_blocks: Number of blocks along x, y and z.
        blocks: Number of blocks other than air.
        kinds: Number of different block states.
        not_read: Contents of the source that could not be read, with the count of each kind.
        not_written: Contents that the target format does not support, with the count of each kind.
        mod_blocks: Number of blocks from each mod, which are written with their original names.
        function: For a data pack, the function that places the blocks in the game.
    """

    path: Path
    size_blocks: tuple[int, int, int]
    blocks: int
    kinds: int
    not_read: Mapping[str, int] = field(default_factory=dict)
    not_written: Mapping[str, int] = field(default_factory=dict)
    mod_blocks: Mapping[str, int] = field(default_factory=dict)
    function: str = ""


def convert(
    source: Run | str | Path,
    target: str | Path,
    *,
    force: bool = False,
    mc_version: str = "1.20.1",
    schem_version: int = 2,
    name: str = "",
    blocks_per_metre: float | None = None,
    box: tuple[int, int, int, int, int, int] | None = None,
    labels: str = "",
) -> Conversion:
    """Convert a room, a world or a block file to another format.

    The source format is detected from the file suffix and contents, the target format from the
    suffix alone. A target without a suffix becomes a world folder. The formats are ``.schem``,
    ``.litematic``, ``.nbt``, ``.zip`` (data pack), ``.mcfunction``, ``.mcstructure`` (Bedrock),
    ``.glb``, ``.habitat`` (a folder), and for reading only ``.schematic``.

    Args:
        source: Run, run folder, world or block file.
        target: File or folder to write.
        force: Replace an existing target.
        mc_version: Minecraft version to write for. Newer versions upgrade the file.
        schem_version: Sponge schematic version: 1, 2 or 3.
        name: Name of the world or data pack. Defaults to the name of the target.
        blocks_per_metre: Scale for a source that does not record its own.
        box: Convert only the blocks in this box: x0, y0, z0, x1, y1, z1, with exclusive upper
            bounds.
        labels: Palette whose block name rules assign classes to the blocks of a world without
            labels.

    Raises:
        UsageError: If the target exists or has an unknown suffix.
        ConflictError: If the target is a world that is open, or another process replaces it.
        InputError: If the source cannot be read.
        OutputError: If the target cannot be written.

    Example:
        >>> import world2minecraft as w2m
        >>> w2m.convert(run, tmp / "room.glb").path.name
        'room.glb'
    """
    from world2minecraft.formats.volume_formats import world_details, write_volume
    from world2minecraft.minecraft.block_renames import count_mod_blocks
    from world2minecraft.minecraft.commands.datapack import to_namespace
    from world2minecraft.minecraft.file_format import Losses, WriteOptions

    place, goal = path_of(source), Path(target)
    _check_target(place, goal, force)
    options = WriteOptions(
        mc_version=mc_version,
        schem_version=schem_version,
        name=name or readable_name(goal.stem),
        other=world_details(place),
    )
    unread, unwritten = Losses(), Losses()
    volume = _with_scale(_read_part(place, box, unread), blocks_per_metre)
    volume = _with_labels(volume, labels)
    lock = folder_lock(goal, "replaced") if goal.is_dir() else nullcontext()
    scratch = partial(tempfile.TemporaryDirectory, prefix=".w2m-")
    with _parent_of(goal) as parent, lock, scratch(dir=parent) as folder:
        # The new one is complete before the old one is removed; both are on one disk.
        written = Path(folder) / goal.name
        write_volume(volume, written, options, unwritten)
        _replace_target(written, goal, force)
    lost = dict(unwritten)
    named = " ".join(lost)
    return Conversion(
        path=goal,
        size_blocks=volume.states.shape,
        blocks=int((volume.states != 0).sum()),
        kinds=len(volume.palette) - 1,
        not_read=dict(unread),
        not_written=lost,
        mod_blocks={
            mod: n for mod, n in count_mod_blocks(volume).items() if f"{mod}:" not in named
        },
        function=f"{to_namespace(options.name)}:build" if goal.suffix.lower() == ".zip" else "",
    )


def _read_part(source: Path, box: "Box | None", losses: "Losses") -> "BlockVolume":
    """Return the blocks of a source, or only the blocks inside a box."""
    from world2minecraft.formats.build_reader import read_build
    from world2minecraft.formats.volume_formats import read_volume

    return read_volume(source, losses) if box is None else read_build(source, box).volume


def _with_scale(volume: "BlockVolume", blocks_per_metre: float | None) -> "BlockVolume":
    """Return the volume with the given scale, or unchanged if no scale is given."""
    if blocks_per_metre is None:
        return volume
    if not 0.01 <= blocks_per_metre <= 1000:
        raise UsageError(
            f"the scale must be 0.01 to 1000 blocks per metre, got {blocks_per_metre:g}"
        )
    own = volume.blocks_per_metre
    if volume.semantic.any() and abs(own - blocks_per_metre) > 1e-6:
        raise UsageError(
            f"this room has a fixed scale of {own:g}; omit blocks per metre (--blocks-per-metre)"
        )
    to_room = volume.block_to_room.copy()
    to_room[:3] *= own / blocks_per_metre
    return replace(volume, block_to_room=to_room)


def _with_labels(volume: "BlockVolume", palette: str) -> "BlockVolume":
    """Return the volume with the classes that a palette assigns to its block names."""
    if not palette:
        return volume
    from world2minecraft.construction.mod_block_classes import label_volume
    from world2minecraft.construction.palettes import load_palette

    meanings = load_palette(palette).meanings
    if meanings is None:
        raise UsageError(
            f"palette {palette} has no 'reads' section to classify blocks; "
            "add that section or use vanilla"
        )
    return label_volume(volume, meanings)


def _check_target(source: Path, target: Path, force: bool) -> None:
    """Check the source and the target before any work.

    Raises:
        InputError: If the source does not exist.
        UsageError: If the target has no known suffix, is the source, exists without ``force``, or
            is a folder with unrelated files.
        ConflictError: If the target is a world that is open in the game.
    """
    from world2minecraft.formats.volume_formats import format_for_path

    if not source.exists():
        raise InputError(source, "not found")
    form = format_for_path(target)
    if not os.path.lexists(target):
        return
    if target.exists() and source.samefile(target):
        raise UsageError(f"{target} is both the source and the target; choose another target")
    if not force:
        raise UsageError(f"{target} exists; use --force to replace it")
    if (target / "level.dat").is_file():
        from world2minecraft.minecraft.worlds.session_lock import session_lock

        with session_lock(target):  # A world that the game has open is left alone.
            pass
    if not target.is_dir() or not any(target.iterdir()):
        return
    if form.suffix == "" and not (target / "level.dat").is_file():
        raise UsageError(f"{target} exists and is not a world folder; choose another target")
    if form.suffix != "" and not any(target.glob(HABITAT_MARK)):
        raise UsageError(f"{target} is a folder with unrelated files; choose another target")


def _replace_target(written: Path, target: Path, force: bool) -> None:
    """Move the written file or folder to the target, together with files written next to it."""
    beside = [path for path in sorted(written.parent.iterdir()) if path != written]
    for path in beside:
        place = target.parent / path.name
        if place.exists() and not force:
            raise UsageError(f"{place} exists; use --force to replace it")
    for path in beside:
        _put_in_place(path, target.parent / path.name)
    _put_in_place(written, target)


@contextmanager
def _parent_of(target: Path) -> Iterator[Path]:
    """Create and yield the parent folder of the target, which a failure of the block removes."""
    made = [path for path in target.parents if not path.exists()]
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        reason = "is a file" if target.parent.is_file() else f"cannot be created: {error.strerror}"
        raise OutputError(target.parent, f"{reason}; choose another target") from error
    try:
        yield target.parent
    except BaseException:
        for path in made:
            with suppress(OSError):
                path.rmdir()
        raise


def _put_in_place(written: Path, target: Path) -> None:
    """Move a file or folder to the target on the same disk, replacing an existing target."""
    if not target.is_dir() or target.is_symlink():
        os.replace(written, target)
        return
    old = written.parent / ".replaced"  # Removed with the folder that holds both.
    os.replace(target, old)
    try:
        os.replace(written, target)
    except OSError:
        os.replace(old, target)
        raise


@dataclass(frozen=True)
class InstalledWorld:
    """A world that was copied into the saves folder of a game.

    Attributes:
        path: World folder in the saves folder. The folder name is also the name of the world in the
            game.
        game: Name of the game installation, such as ``Prism: Fabric``.
        note: Warnings if the game is too old for the world, or if edits were saved after it was
            built. Empty otherwise.
        has_player_size: Whether the world's data pack can resize the player (``/function
            w2m:human_size``).
    """

    path: Path
    game: str
    note: str = ""
    has_player_size: bool = False


def find_games() -> "list[Game]":
    """Return the game installations on this machine with their saves folders and versions.

    The function searches for the Minecraft launcher, Prism, PolyMC and MultiMC. The version is None
    if it is unknown.

    Example:
        >>> from world2minecraft.api.worlds import find_games
        >>> isinstance(find_games(), list)
        True
    """
    from world2minecraft.minecraft.worlds.launchers import find_games as find

    return find(sys.platform, Path.home(), os.environ)


def install_world(
    source: Run | str | Path,
    *,
    game: str = "",
    saves: str | Path | None = None,
    name: str = "",
) -> InstalledWorld:
    """Copy the world of a run into the saves folder of a game without overwriting other worlds.

    If the world name is already in use, a number is appended.

    Args:
        source: Run, run folder or world.
        game: Number of the installation in ``find_games()``, starting at 1, or a part of its name.
            Required if several installations are found.
        saves: Saves folder to use instead of searching for games.
        name: Name of the world. Defaults to its current name.

    Raises:
        UsageError: If no game is found or several games match.
        InputError: If the source contains no world or the saves folder does not exist.
        OutputError: If the saves folder cannot be written.

    Example:
        >>> import world2minecraft as w2m
        >>> w2m.install_world(run, saves=tmp / "saves", name="Study").path.name
        'Study'
    """
    from world2minecraft.minecraft.worlds import installation
    from world2minecraft.minecraft.worlds.launchers import Game, choose_game

    world = installation.find_world(path_of(source))
    chosen = Game("the game", Path(saves)) if saves else choose_game(find_games(), game)
    if not chosen.saves.parent.is_dir():
        reason = "parent folder not found; give the saves folder of a game (--saves DIR)"
        raise InputError(chosen.saves, reason)
    target = installation.install_world(world, chosen.saves, name or None)
    notes = (_edits_note(path_of(source), world), installation.age_note(world, chosen))
    return InstalledWorld(
        target,
        chosen.name,
        "; ".join(filter(None, notes)),
        (target / "datapacks" / "player_size.zip").is_file(),
    )


def _edits_note(run: Path, world: Path) -> str:
    """Return a warning if edits of a run were saved after its world was built, or ''."""
    from world2minecraft.sceneforge.document.document_metadata import holds_saved_edits

    scene = run / "placements.json"
    if world == run or not scene.is_file() or not holds_saved_edits(run):
        return ""
    if scene.stat().st_mtime <= (world / "level.dat").stat().st_mtime:
        return ""
    return (
        "edits were saved after this world was built and are not in it; "
        f"w2m build {run} --out EDITED builds them, then w2m install EDITED"
    )


@dataclass(frozen=True)
class UndoStep:
    """A build into a world that can be undone.

    Attributes:
        number: Number of the step in the world, such as ``0001``.
        what: Description of the step, such as ``built at 5 70 -3``.
        files: Number of files that the step changed.
    """

    number: str
    what: str
    files: int


@dataclass(frozen=True)
class Undone:
    """The result of undoing a build into a world.

    Attributes:
        files: Number of files that were restored. 0 if blocks were restored one by one.
        blocks: Number of blocks that were restored one by one.
        unchanged: Number of blocks that were not restored because they have changed since the
            build.
        interrupted: Whether the undone step had been interrupted before it was complete.
    """

    files: int = 0
    blocks: int = 0
    unchanged: int = 0
    interrupted: bool = False


def undo_steps(world: str | Path) -> list[UndoStep]:
    """Return the builds into a world that ``undo_build`` can undo, oldest first.

    Raises:
        InputError: If the folder does not contain a world.
    """
    from world2minecraft.editing.file_backups import list_steps
    from world2minecraft.minecraft.worlds.level_dat import no_world

    if not (Path(world) / "level.dat").is_file():
        raise no_world(Path(world))
    steps = list_steps(Path(world))
    return [UndoStep(step.folder.name, step.what, len(step.files)) for step in steps]


def undo_build(world: str | Path, *, blocks: bool = False, force: bool = False) -> Undone:
    """Undo the last build into a world.

    Every file that the build changed is restored byte for byte, unless the game has saved the world
    since the build.

    Args:
        world: Folder of the world.
        blocks: Restore the blocks one by one, except those that have changed since the build.
        force: Restore the files even if they have changed since the build.

    Raises:
        UsageError: If there is no build to undo, or if both ``blocks`` and ``force`` are given.
        ConflictError: If the world has changed since the build or is open in the game.
        InputError: If the folder does not contain a world.

    Example:
        >>> import world2minecraft as w2m
        >>> w2m.undo_build(run.world)
        Traceback (most recent call last):
        ...
        world2minecraft.core.errors.UsageError: ...: no build by World2Minecraft to undo
    """
    from world2minecraft.editing.build_into_world import remove_build
    from world2minecraft.editing.file_backups import DONE, revert_last_step

    if blocks and force:
        raise UsageError(
            "blocks (--blocks) and force (--force) exclude each other; omit one of them"
        )
    if blocks:
        done = remove_build(Path(world))
        return Undone(blocks=done.blocks, unchanged=done.kept)
    step = revert_last_step(Path(world), force)
    return Undone(len(step.files), interrupted=step.state != DONE)
