"""Copy a world into a game's saves folder under a free name."""

import os
import re
import shutil
import tempfile
from pathlib import Path

from world2minecraft.core.errors import InputError, OutputError, UsageError
from world2minecraft.core.files import read_bytes, write_bytes
from world2minecraft.minecraft.nbt import pack_gzip, read_nbt, unpack, write_nbt
from world2minecraft.minecraft.versions import game_versions
from world2minecraft.minecraft.worlds.launchers import Game
from world2minecraft.minecraft.worlds.session_lock import LOCK_FILE
from world2minecraft.minecraft.worlds.world_reader import LEVEL_LIMITS, read_level

MAX_NAME = 60
MAX_FILES = 100_000
SPARE_BYTES = 16 << 20
# What no folder may be named on Windows, whose players share worlds with others.
_RESERVED = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?", re.IGNORECASE)
_FORBIDDEN = re.compile(r'[<>:"/\\|?*\x00-\x1f\x7f]')


def install_world(world: Path, saves: Path, name: str | None = None) -> Path:
    """Copy a world into a saves folder and return where it is; nothing there is overwritten.

    It is copied beside its place first, so that the game never sees half of it.

    Args:
        world: the folder with ``level.dat``.
        saves: the saves folder; made where only its parent is there.
        name: what the game's list shows and the folder is called; the world's own where left
            out. Where it is taken, a number follows it.

    Raises:
        InputError: there is no world. UsageError: the name cannot be a folder's.
        OutputError: the folder may not be written, or its disk is full.
    """
    level = read_level(world)
    wanted = check_name(name or str(level.get("LevelName") or world.name))
    files = _files_of(world)
    try:
        saves.mkdir(exist_ok=True)
        _check_space(files, saves)
        draft = Path(tempfile.mkdtemp(dir=saves, prefix=".w2m-"))
    except OSError as error:
        raise OutputError(saves, f"cannot be written: {error.strerror or error}") from error
    try:
        os.chmod(draft, 0o755)
        for source in files:
            target = draft / source.relative_to(world)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, target)
        return _put_under_free_name(draft, saves, wanted)
    except OSError as error:
        raise OutputError(saves, f"cannot be written: {error.strerror or error}") from error
    finally:
        shutil.rmtree(draft, ignore_errors=True)


def check_name(name: str) -> str:
    """Return a name as a folder may have it on every system: printable, short, none reserved.

    Raises:
        UsageError: nothing of it is left.
    """
    text = _FORBIDDEN.sub(" ", name)
    text = " ".join("".join(letter for letter in text if letter.isprintable()).split())
    text = text[:MAX_NAME].strip(". ")
    if not text:
        raise UsageError(f"a world cannot be named {name!r}; give --name some letters")
    return f"{text} world" if _RESERVED.fullmatch(text) else text


def free_name(wanted: str, taken: set[str]) -> str:
    """Return the name, or with the lowest number that makes it free; case does not count.

    Example:
        >>> free_name("Room", {"room", "Room (2)"})
        'Room (3)'
    """
    known = {name.casefold() for name in taken}
    number, name = 1, wanted
    while name.casefold() in known:
        number += 1
        name = f"{wanted} ({number})"
    return name


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
    """Give a world the name that the game's list shows; its file stays as it is where it has it."""
    path = world / "level.dat"
    data = unpack(read_bytes(path, LEVEL_LIMITS.bytes), path, LEVEL_LIMITS.bytes)
    root_name, root = read_nbt(data, path, LEVEL_LIMITS)
    if root["Data"].get("LevelName") != name:
        root["Data"]["LevelName"] = name
        write_bytes(path, pack_gzip(write_nbt(root, root_name)))


def _files_of(world: Path) -> list[Path]:
    """All plain files of a world; links are left out, and the lock of a game that had it open."""
    found = []
    for folder, folders, names in os.walk(world):
        folders.sort()
        for name in sorted(names):
            path = Path(folder) / name
            if path.is_file() and not path.is_symlink() and name != LOCK_FILE:
                found.append(path)
        if len(found) > MAX_FILES:
            raise InputError(world, f"holds more than {MAX_FILES:,} files; it is no room of ours")
    return found


def _check_space(files: list[Path], saves: Path) -> None:
    needed = sum(path.stat().st_size for path in files) + SPARE_BYTES
    free = shutil.disk_usage(saves).free
    if free < needed:
        raise OutputError(saves, f"its disk has {free >> 20} MB free; {needed >> 20} are needed")


def find_world(source: Path) -> Path:
    """Return the world folder of a run, of its ``build`` folder, or the folder itself.

    Raises:
        InputError: there is none.
    """
    for folder in (source, source / "build" / "world", source / "world"):
        if (folder / "level.dat").is_file():
            return folder
    raise InputError(source, "holds no world (build/world/level.dat); build one with w2m build")


def age_note(world: Path, game: Game) -> str:
    """Say so where the game is older than the world; empty where it is not, or not known."""
    known = {version.name: version.data_version for version in game_versions()}
    version = read_level(world).get("DataVersion")
    age = known.get(game.version or "")
    if age is None or not isinstance(version, int) or age >= version:
        return ""
    return (
        f"this game is {game.version}, older than the world, and will not open it; build again "
        f"with --mc-version {game.version}"
    )
