"""Worlds and block files: convert any form into any other, install worlds, undo builds in them."""

import os
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from world2minecraft.api.results import Run
from world2minecraft.api.rooms import path_of
from world2minecraft.core.errors import InputError, OutputError, UsageError

if TYPE_CHECKING:
    from world2minecraft.core.types import BlockVolume
    from world2minecraft.formats.volume_crop import Box
    from world2minecraft.minecraft.file_format import Losses
    from world2minecraft.minecraft.worlds.launchers import Game

HABITAT_MARK = "*.scene_dataset_config.json"


@dataclass(frozen=True)
class Conversion:
    """What a conversion wrote, and what the formats could not carry.

    Attributes:
        path: the file or folder that was written.
        size_blocks: the blocks along x, y and z.
        blocks: how many of them are not air.
        kinds: how many kinds of blocks there are.
        not_read: what the source has and could not be read, with its count.
        not_written: what the target's format cannot hold, with its count.
        mod_blocks: blocks of each mod, written by their names.
        function: for a data pack, the function that builds it in the game.
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
    """Convert a room, a world or a block file to another form.

    The format of the source is detected from its suffix and content, that of the target from its
    suffix alone: a name without a suffix becomes a world folder. Formats: ``.schem``,
    ``.litematic``, ``.nbt``, ``.zip`` (data pack), ``.mcfunction``, ``.mcstructure`` (Bedrock),
    ``.glb``, ``.habitat`` (a folder), and ``.schematic`` to read.

    Args:
        source: a run, its folder, a world or a file.
        target: the file or folder to write.
        force: replace the target where it exists.
        mc_version: the game version to write for; newer games upgrade it.
        schem_version: the version of a Sponge schematic: 1, 2 or 3.
        name: the name of a world or a data pack; that of the target by default.
        blocks_per_metre: the scale, where the source does not state it.
        box: convert these blocks only: x0, y0, z0, x1, y1, z1, the last ones excluded.
        labels: a palette whose words give blocks of a foreign world their classes.

    Raises:
        UsageError: the target exists, or no format has its suffix. InputError: the source cannot
        be read, or the target cannot be written.

    Example:
        >>> import world2minecraft as w2m
        >>> w2m.convert(run, tmp / "room.glb").path.name
        'room.glb'
    """
    from world2minecraft.formats.volume_formats import read_run_templates, write_volume
    from world2minecraft.minecraft.block_renames import count_mod_blocks
    from world2minecraft.minecraft.commands.datapack import to_namespace
    from world2minecraft.minecraft.file_format import Losses, WriteOptions

    place, goal = path_of(source), Path(target)
    _check_target(place, goal, force)
    options = WriteOptions(
        mc_version=mc_version,
        schem_version=schem_version,
        name=name or goal.stem,
        other={"templates": read_run_templates(place)},
    )
    unread, unwritten = Losses(), Losses()
    volume = _with_scale(_read_part(place, box, unread), blocks_per_metre)
    volume = _with_labels(volume, labels)
    _make_parent(goal)
    with tempfile.TemporaryDirectory(dir=goal.parent, prefix=".w2m-") as folder:
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
    """Return the blocks of a source, or those in a box: of a world no others are read."""
    from world2minecraft.formats.build_reader import read_build
    from world2minecraft.formats.volume_formats import read_volume

    return read_volume(source, losses) if box is None else read_build(source, box).volume


def _with_scale(volume: "BlockVolume", blocks_per_metre: float | None) -> "BlockVolume":
    """Return the volume at a scale, or at its own where none is given."""
    if blocks_per_metre is None:
        return volume
    if not 0.01 <= blocks_per_metre <= 1000:
        raise UsageError(f"--blocks-per-metre must be 0.01 to 1000, not {blocks_per_metre:g}")
    own = volume.blocks_per_metre
    if volume.semantic.any() and abs(own - blocks_per_metre) > 1e-6:
        raise UsageError(f"--blocks-per-metre is {own:g} for this room; leave it out")
    to_room = volume.block_to_room.copy()
    to_room[:3] *= own / blocks_per_metre
    return replace(volume, block_to_room=to_room)


def _with_labels(volume: "BlockVolume", palette: str) -> "BlockVolume":
    """Return the volume with the classes that a palette reads from the names of its blocks."""
    if not palette:
        return volume
    from world2minecraft.construction.mod_block_classes import label_volume
    from world2minecraft.construction.palettes import load_palette

    meanings = load_palette(palette).meanings
    if meanings is None:
        raise UsageError(f"palette {palette} reads no blocks; add reads to it, or try vanilla")
    return label_volume(volume, meanings)


def _check_target(source: Path, target: Path, force: bool) -> None:
    """Check what can be known before any work.

    Raises:
        InputError: the source is not found. UsageError: the target has no known suffix, is the
        source, exists and ``force`` is not given, or is a folder of other things.
        ConflictError: the target is a world that the game has open.
    """
    from world2minecraft.formats.volume_formats import format_for_path

    if not source.exists():
        raise InputError(source, "not found")
    form = format_for_path(target)
    if not os.path.lexists(target):
        return
    if target.exists() and source.samefile(target):
        raise UsageError(f"{target} is both source and target; choose another target")
    if not force:
        raise UsageError(f"{target} exists; add --force to replace it")
    if (target / "level.dat").is_file():
        from world2minecraft.minecraft.worlds.session_lock import session_lock

        with session_lock(target):  # A world that the game has open is left alone.
            pass
    if not target.is_dir() or not any(target.iterdir()):
        return
    if form.suffix == "" and not (target / "level.dat").is_file():
        raise UsageError(f"{target} is a folder without a world (no level.dat); choose another")
    if form.suffix != "" and not any(target.glob(HABITAT_MARK)):
        raise UsageError(f"{target} is a folder of other files; choose another target")


def _replace_target(written: Path, target: Path, force: bool) -> None:
    """Move what was written to the target, with the files that were written beside it."""
    beside = [path for path in sorted(written.parent.iterdir()) if path != written]
    for path in beside:
        place = target.parent / path.name
        if place.exists() and not force:
            raise UsageError(f"{place} exists; add --force to replace it")
    for path in beside:
        _put_in_place(path, target.parent / path.name)
    _put_in_place(written, target)


def _make_parent(target: Path) -> None:
    """Make the folder that the target lies in."""
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        reason = "is a file" if target.parent.is_file() else f"cannot be made: {error.strerror}"
        raise OutputError(target.parent, f"{reason}; choose another target") from error


def _put_in_place(written: Path, target: Path) -> None:
    """Move a file or folder, on the same disk, over what stands at the target."""
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
    """A world that was copied into a game.

    Attributes:
        path: its folder in the saves folder; its name is that of the world in the game.
        game: the name of the game, such as ``Prism: Fabric``.
        note: a warning where the game is too old for the world; empty otherwise.
        has_player_size: whether its data pack can resize the player (``/function w2m:human_size``).
    """

    path: Path
    game: str
    note: str = ""
    has_player_size: bool = False


def find_games() -> "list[Game]":
    """Return the games of this machine, with the saves folder and, where known, the version.

    The Minecraft launcher, Prism, PolyMC and MultiMC are searched.

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
    """Copy the world of a run into the saves folder of a game; nothing is overwritten.

    Where the name of the world is taken, a number follows it.

    Args:
        source: a run, its folder, or a world.
        game: of several games, the number in ``find_games()``, from 1, or a part of the name.
        saves: a saves folder, instead of searching for games.
        name: the name of the world; its own by default.

    Raises:
        UsageError: no game is found, or several match. InputError: the source holds no world, or
        the saves folder is not found. OutputError: the saves folder cannot be written.

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
        reason = "not found, nor a folder to create it in; give the saves folder of a game"
        raise InputError(chosen.saves, f"{reason} with --saves DIR")
    target = installation.install_world(world, chosen.saves, name or None)
    return InstalledWorld(
        target,
        chosen.name,
        installation.age_note(world, chosen),
        (target / "datapacks" / "player_size.zip").is_file(),
    )


@dataclass(frozen=True)
class UndoStep:
    """A build into a world that can be undone.

    Attributes:
        number: its number in the world, such as ``0001``.
        what: what it did, such as ``built at 5 70 -3``.
        files: how many files it changed.
    """

    number: str
    what: str
    files: int


@dataclass(frozen=True)
class Undone:
    """What was undone.

    Attributes:
        files: how many files were restored; 0 where blocks were.
        blocks: how many blocks were restored one by one.
        unchanged: how many blocks were left, because they were changed since.
        interrupted: whether the step had been interrupted, and was not complete.
    """

    files: int = 0
    blocks: int = 0
    unchanged: int = 0
    interrupted: bool = False


def undo_steps(world: str | Path) -> list[UndoStep]:
    """Return the builds into a world that ``undo_build`` can undo, the first one first.

    Raises:
        InputError: the folder holds no world.
    """
    from world2minecraft.editing.file_backups import list_steps
    from world2minecraft.minecraft.worlds.level_dat import no_world

    if not (Path(world) / "level.dat").is_file():
        raise no_world(Path(world))
    steps = list_steps(Path(world))
    return [UndoStep(step.folder.name, step.what, len(step.files)) for step in steps]


def undo_build(world: str | Path, *, blocks: bool = False, force: bool = False) -> Undone:
    """Undo the last build into a world.

    Every file that the build changed is restored byte for byte, unless the game has saved the
    world since.

    Args:
        world: the folder of the world.
        blocks: restore the blocks one by one, and leave those that were changed since.
        force: restore the files even where they were changed since.

    Raises:
        UsageError: there is nothing to undo, or both ``blocks`` and ``force`` are given.
        ConflictError: the world was changed since, or the game has it open.
        InputError: the folder holds no world.

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
        raise UsageError("--blocks and --force exclude each other; give one of them")
    if blocks:
        done = remove_build(Path(world))
        return Undone(blocks=done.blocks, unchanged=done.kept)
    step = revert_last_step(Path(world), force)
    return Undone(len(step.files), interrupted=step.state != DONE)
