"""Search for the saves folders of the game launchers on this computer.

======================  ========================================================================
Minecraft launcher      ``.minecraft``, and the game directories of its installations
Prism, PolyMC, MultiMC  One game directory per instance (Windows, macOS, Linux, Flatpak, Scoop)
======================  ========================================================================

Only existing folders are returned. MultiMC stores its data next to its program, which can be
anywhere, so only the usual locations are searched.
"""

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.core.files import read_bytes, read_json

MAX_SETTINGS_BYTES = 4 << 20
MAX_INSTANCES = 500
LAUNCHER = "Minecraft launcher"
PROFILE_FILES = ("launcher_profiles.json", "launcher_profiles_microsoft_store.json")
SETTINGS_FILES = {
    "Prism": "prismlauncher.cfg",
    "PolyMC": "polymc.cfg",
    "MultiMC": "multimc.cfg",
}


@dataclass(frozen=True)
class Game:
    """An installed game, with its display name, its saves folder and its version if known."""

    name: str
    saves: Path
    version: str | None = None


def find_games(platform: str, home: Path, environment: Mapping[str, str]) -> list[Game]:
    """Find the installed games, with the Minecraft launcher first and no saves folder twice.

    Args:
        platform: The value of ``sys.platform``: ``win32``, ``darwin``, or any other value for
            Linux.
        home: The home folder of the user.
        environment: The environment variables. APPDATA, LOCALAPPDATA, XDG_DATA_HOME and
            PRISMLAUNCHER_DATA_DIR are used.
    """
    found: dict[Path, Game] = {}
    for root in _launcher_folders(platform, home, environment):
        for game in _launcher_games(root):
            found.setdefault(_real(game.saves), game)
    for kind, root in _instance_roots(platform, home, environment):
        for game in _instance_games(kind, root):
            found.setdefault(_real(game.saves), game)
    return list(found.values())


def choose_game(games: Sequence[Game], wanted: str) -> Game:
    """Return the game with a number (from 1) or a part of its name, or the only game.

    Raises:
        UsageError: If no game or several games match.
    """
    if not games:
        raise UsageError("no game found; name a saves folder (--saves DIR)")
    if wanted.isdecimal():
        if not 1 <= int(wanted) <= len(games):
            count = f"{len(games)} games were" if len(games) > 1 else "1 game was"
            raise UsageError(
                f"--game {wanted} does not exist, because only {count} found; "
                "run w2m install --list"
            )
        return games[int(wanted) - 1]
    named = [game for game in games if wanted.casefold() in game.name.casefold()]
    if len(named) == 1:
        return named[0]
    names = ", ".join(f"{games.index(g) + 1} {g.name}" for g in (named or games))
    what = f"no game is named {wanted!r}" if not named else f"{len(named)} games found"
    raise UsageError(f"{what}; choose one (--game NUMBER): {names}")


def _launcher_folders(platform: str, home: Path, environment: Mapping[str, str]) -> Iterator[Path]:
    if platform == "win32":
        yield _roaming(home, environment) / ".minecraft"
    elif platform == "darwin":
        yield home / "Library" / "Application Support" / "minecraft"
    else:
        yield home / ".minecraft"
        yield home / ".var" / "app" / "com.mojang.Minecraft" / ".minecraft"
        # Windows seen from its own Linux.
        yield from sorted(Path("/mnt/c/Users").glob("*/AppData/Roaming/.minecraft"))


def _instance_roots(
    platform: str, home: Path, environment: Mapping[str, str]
) -> Iterator[tuple[str, Path]]:
    """Yield the possible data folders of launchers with instances."""
    if "PRISMLAUNCHER_DATA_DIR" in environment:
        yield "Prism", Path(environment["PRISMLAUNCHER_DATA_DIR"])
    if platform == "win32":
        roaming = _roaming(home, environment)
        local = Path(environment.get("LOCALAPPDATA") or home / "AppData" / "Local")
        yield "Prism", roaming / "PrismLauncher"
        yield "Prism", home / "scoop" / "persist" / "prismlauncher"
        yield "PolyMC", roaming / "PolyMC"
        yield "MultiMC", home / "scoop" / "persist" / "multimc"
        for folder in (roaming, local, local / "Programs", home, home / "Downloads", Path("C:/")):
            yield "MultiMC", folder / "MultiMC"
    elif platform == "darwin":
        support = home / "Library" / "Application Support"
        yield "Prism", support / "PrismLauncher"
        yield "PolyMC", support / "PolyMC"
        for folder in (Path("/Applications"), home / "Applications"):
            yield "MultiMC", folder / "MultiMC.app" / "Data"
    else:
        data = Path(environment.get("XDG_DATA_HOME") or home / ".local" / "share")
        flatpak = home / ".var" / "app"
        yield "Prism", data / "PrismLauncher"
        yield "Prism", flatpak / "org.prismlauncher.PrismLauncher" / "data" / "PrismLauncher"
        yield "PolyMC", data / "PolyMC"
        yield "PolyMC", flatpak / "org.polymc.PolyMC" / "data" / "PolyMC"
        for folder in (data / "multimc", home / "MultiMC", home / ".config" / "local" / "multimc"):
            yield "MultiMC", folder


def _launcher_games(root: Path) -> Iterator[Game]:
    if not _is_folder(root):
        return
    yield Game(LAUNCHER, root / "saves")
    for name in PROFILE_FILES:
        profiles = _json(root / name).get("profiles")
        for profile in profiles.values() if isinstance(profiles, dict) else ():
            folder = profile.get("gameDir") if isinstance(profile, dict) else None
            if isinstance(folder, str) and Path(folder).is_absolute() and _is_folder(Path(folder)):
                title = _line(profile.get("name")) or _line(profile.get("lastVersionId"))
                yield Game(f"{LAUNCHER}: {title or Path(folder).name}", Path(folder) / "saves")


def _instance_games(kind: str, root: Path) -> Iterator[Game]:
    if not _is_folder(root):
        return
    chosen = _setting(root / SETTINGS_FILES[kind], "InstanceDir") or "instances"
    folder = root / chosen  # An absolute one stands for itself.
    if not _is_folder(folder):
        return
    for instance in _folders_in(folder)[:MAX_INSTANCES]:
        game = instance / ".minecraft"
        if not _is_folder(game):
            game = instance / "minecraft"
        if _is_folder(game) and (instance / "instance.cfg").is_file():
            title = _setting(instance / "instance.cfg", "name") or instance.name
            yield Game(f"{kind}: {title}", game / "saves", _version(instance))


def _version(instance: Path) -> str | None:
    components = _json(instance / "mmc-pack.json").get("components")
    for component in components if isinstance(components, list) else ():
        if isinstance(component, dict) and component.get("uid") == "net.minecraft":
            return _line(component.get("version")) or None
    return None


def _setting(path: Path, key: str) -> str:
    """Return a value from a settings file with KEY=VALUE lines, or an empty string."""
    try:
        text = read_bytes(path, MAX_SETTINGS_BYTES).decode("utf-8", "replace")
    except InputError:
        return ""
    for line in text.splitlines():
        name, _, value = line.partition("=")
        if name.strip() == key:
            return _line(_unquoted(value.strip()))
    return ""


def _unquoted(value: str) -> str:
    """Remove quotes and double backslashes from a value in Qt's format."""
    if len(value) < 2 or value[0] != '"' or value[-1] != '"':
        return value
    try:
        return str(json.loads(value))
    except ValueError:
        return value[1:-1]


def _json(path: Path) -> dict[str, Any]:
    try:
        raw = read_json(path, MAX_SETTINGS_BYTES)
    except InputError:
        return {}
    return raw if isinstance(raw, dict) else {}


def _line(value: Any) -> str:
    """Return a text from a file as one short printable line."""
    text = " ".join(value.split()) if isinstance(value, str) else ""
    return "".join(letter for letter in text if letter.isprintable())[:200]


def _is_folder(path: Path) -> bool:
    """Return whether a path is an accessible folder."""
    try:
        return path.is_dir()
    except OSError:
        return False


def _folders_in(folder: Path) -> list[Path]:
    try:
        return sorted(path for path in folder.iterdir() if _is_folder(path))
    except OSError:
        return []


def _roaming(home: Path, environment: Mapping[str, str]) -> Path:
    return Path(environment.get("APPDATA") or home / "AppData" / "Roaming")


def _real(path: Path) -> Path:
    try:
        return path.resolve()
    except (OSError, RuntimeError):
        return path
