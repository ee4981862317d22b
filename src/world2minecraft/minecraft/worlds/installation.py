"""Installation of a world in a game's saves folder under a free name."""

import os
import shutil
import tempfile
from pathlib import Path

from world2minecraft.core.errors import InputError, OutputError
from world2minecraft.core.file_names import free_name, portable_name
from world2minecraft.core.files import read_bytes, write_bytes
from world2minecraft.core.whole_reads import unchanged
from world2minecraft.minecraft.nbt import pack_gzip, read_nbt, unpack, write_nbt
from world2minecraft.minecraft.versions import game_versions
from world2minecraft.minecraft.worlds.launchers import Game
from world2minecraft.minecraft.worlds.session_lock import LOCK_FILE
from world2minecraft.minecraft.worlds.world_reader import LEVEL_LIMITS, read_level

MAX_FILES = 100_000
SPARE_BYTES = 16 << 20


def install_world(world: Path, saves: Path, name: str | None = None) -> Path:
    """Copy a world to a saves folder under a free name and return the new world folder.

    The world is copied to a temporary folder first, so that the game never sees an incomplete
    world. Existing worlds are not overwritten.

    Args:
        world: The world folder with ``level.dat``.
        saves: The saves folder. It is created if only its parent exists.
        name: The name of the world in the game and of its folder. The default is the world's own
            name. A number is appended if the name is taken.

    Raises:
        InputError: If the world is not found.
        UsageError: If the name has no valid characters for a folder name.
        ConflictError: If another process changes the world meanwhile.
        OutputError: If the folder cannot be written or the disk is full.
    """
    level = read_level(world)
    wanted = portable_name(name or str(level.get("LevelName") or world.name))
    files = _files_of(world)
    try:
        saves.mkdir(exist_ok=True)
        _check_space(files, saves)
        draft = Path(tempfile.mkdtemp(dir=saves, prefix=".w2m-"))
    except OSError as error:
        raise OutputError(saves, f"cannot be written: {error.strerror or error}") from error
    try:
        os.chmod(draft, 0o755)
        with unchanged(world):
            for source in files:
                target = draft / source.relative_to(world)
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(source, target)
        return _put_under_free_name(draft, saves, wanted)
    except OSError as error:
        raise OutputError(saves, f"cannot be written: {error.strerror or error}") from error
    finally:
        shutil.rmtree(draft, ignore_errors=True)


def _put_under_free_name(draft: Path, saves: Path, wanted: str) -> Path:
    while True:
        name = free_name(wanted, set(os.listdir(saves)))
        _rename_level(draft, name)
        target = saves / name
        try:
            target.mkdir()  # Takes the name, so that no one else does.
        except FileExistsError:
            continue
        target.rmdir()
        os.rename(draft, target)
        return target


def _rename_level(world: Path, name: str) -> None:
    """Set the name of a world in its ``level.dat``, if it is different."""
    path = world / "level.dat"
    data = unpack(read_bytes(path, LEVEL_LIMITS.bytes), path, LEVEL_LIMITS.bytes)
    root_name, root = read_nbt(data, path, LEVEL_LIMITS)
    if root["Data"].get("LevelName") != name:
        root["Data"]["LevelName"] = name
        write_bytes(path, pack_gzip(write_nbt(root, root_name)))


def _files_of(world: Path) -> list[Path]:
    """Return all regular files of a world except symbolic links and the session lock."""
    found = []
    for folder, folders, names in os.walk(world):
        folders.sort()
        for name in sorted(names):
            path = Path(folder) / name
            if path.is_file() and not path.is_symlink() and name != LOCK_FILE:
                found.append(path)
        if len(found) > MAX_FILES:
            raise InputError(
                world, f"contains more than {MAX_FILES:,} files, so it is not a room world"
            )
    return found


def _check_space(files: list[Path], saves: Path) -> None:
    needed = sum(path.stat().st_size for path in files) + SPARE_BYTES
    free = shutil.disk_usage(saves).free
    if free < needed:
        raise OutputError(
            saves, f"not enough disk space: {needed >> 20} MB required, {free >> 20} MB free"
        )


def find_world(source: Path) -> Path:
    """Find the world folder of a run, of its ``build`` folder, or the folder itself.

    Raises:
        InputError: If no world is found.
    """
    for folder in (source, source / "build" / "world", source / "world"):
        if (folder / "level.dat").is_file():
            return folder
    raise InputError(source, "contains no world (build/world/level.dat); run w2m build first")


def age_note(world: Path, game: Game) -> str:
    """Return a warning if the game is older than the world, or an empty string otherwise."""
    known = {version.name: version.data_version for version in game_versions()}
    version = read_level(world).get("DataVersion")
    age = known.get(game.version or "")
    if age is None or not isinstance(version, int) or age >= version:
        return ""
    return (
        f"Minecraft {game.version} cannot open this newer world; build the world again with "
        f"--mc-version {game.version}"
    )
