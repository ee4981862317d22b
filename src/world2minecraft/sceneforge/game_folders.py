"""Minecraft installations that the user chose, and the folder picker that finds them.

Launchers are found by themselves (``export_options.games_here``). Where none is, the user picks a
game's folder or its ``saves`` folder in the page, and the choice is kept in the home folder.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.core.files import read_json, write_json
from world2minecraft.minecraft.worlds.launchers import Game
from world2minecraft.sceneforge.export_options import games_here, id_of

CHOSEN = "games.json"
MAX_CHOSEN = 12
MAX_LISTED = 500


@dataclass(frozen=True)
class GameFolders:
    """The installations that a server offers.

    Attributes:
        home: Folder of the server, which holds the user's choices.
    """

    home: Path

    def games(self) -> dict[str, Game]:
        """Return the installations found and chosen, by ids that do not reveal their paths."""
        chosen = [Game(place.parent.name, place, None) for place in self._chosen()]
        return {id_of(game.saves): game for game in chosen} | games_here()

    def add(self, folder: str) -> str:
        """Remember a chosen folder and return the id of its installation.

        Raises:
            UsageError: If it is not the folder of a game. The message says which folder is.
        """
        saves = saves_folder(Path(folder))
        if saves is None:
            raise UsageError(
                f"{folder[:200]!r} is not the folder of a game: choose the folder named "
                ".minecraft, or the saves folder inside it"
            )
        kept = [str(saves), *(str(one) for one in self._chosen() if one != saves)]
        write_json(self.home / CHOSEN, kept[:MAX_CHOSEN])
        return id_of(saves)

    def _chosen(self) -> list[Path]:
        try:
            noted = read_json(self.home / CHOSEN)
        except InputError:
            return []
        texts = [one for one in noted if isinstance(one, str)] if isinstance(noted, list) else []
        return [place for place in map(Path, texts) if place.is_dir()]


def saves_folder(place: Path) -> Path | None:
    """Return the saves folder that a game's folder is or contains, or None.

    A saves folder is named ``saves`` or contains a world.
    """
    try:
        if not place.is_dir():
            return None
        inner = place / "saves"
        if place.name != "saves" and inner.is_dir():
            return inner.resolve()
        holds_world = any((one / "level.dat").is_file() for one in place.iterdir())
        return place.resolve() if place.name == "saves" or holds_world else None
    except OSError:
        return None


def list_folder(text: str) -> dict[str, Any]:
    """Return the folders inside a folder, for the folder picker.

    Args:
        text: Path of a folder. An empty text lists the user's home folder.

    Returns:
        ``folder``, its path; ``parent``, the path above it or None; ``folders`` [{name, path}] in
        order; ``is_game``, whether the folder can be chosen.

    Raises:
        UsageError: If the path is not a folder that can be read.
    """
    try:
        place = (Path(text).expanduser() if text else Path.home()).resolve()
        inner = sorted(one for one in place.iterdir() if one.is_dir())[:MAX_LISTED]
    except (OSError, ValueError, RuntimeError) as error:
        raise UsageError(f"cannot read the folder {text[:200]!r}") from error
    return {
        "folder": str(place),
        "parent": None if place.parent == place else str(place.parent),
        "folders": [{"name": one.name, "path": str(one)} for one in inner],
        "is_game": saves_folder(place) is not None,
    }
