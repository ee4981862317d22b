"""Copy a built world into the game's saves folder: ``w2m install``."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.core.errors import UsageError

if TYPE_CHECKING:
    from world2minecraft.api.worlds import Game

EXAMPLES = """\
w2m install OUT                       copy to the only game on this machine
w2m install --list                    list the games found
w2m install OUT --game Fabric         select a game by a part of its name, or its number
w2m install OUT --saves D:/games/saves --name Kitchen
"""


def run(
    source: Annotated[
        Path | None, typer.Argument(metavar="OUT", help="Run folder, or a world.")
    ] = None,
    game: Annotated[
        str, typer.Option("--game", help="Number, or part of the name, of a game in --list.")
    ] = "",
    saves: Annotated[
        Path | None, typer.Option("--saves", metavar="DIR", help="Saves folder to use instead.")
    ] = None,
    name: Annotated[
        str, typer.Option("--name", help="Name of the world.", show_default="its own")
    ] = "",
    list_: Annotated[bool, typer.Option("--list", help="List the games found.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="With --list, print JSON.")] = False,
) -> None:
    """Copy the world of a run into the game's saves folder, and print how to open it.

    Searches the Minecraft launcher (including the game directories of its installations), Prism,
    PolyMC and MultiMC. Nothing is overwritten: if the world name is already in use, a number is
    appended.

    Raises:
        UsageError: If no game or several games are found.
        InputError: If the source contains no world.
        OutputError: If the saves folder cannot be written.
    """
    from world2minecraft.api.worlds import find_games, install_world

    if as_json and not list_:
        raise UsageError("--json requires --list")
    if list_:
        games = [] if saves else find_games()
        none = "No game found; specify a saves folder with --saves DIR."
        print(games_to_json(games) if as_json else format_games(games) or none)
        return
    if source is None:
        raise UsageError("no world given; add the run folder, as in w2m install OUT")
    done = install_world(source, game=game, saves=saves, name=name)
    print(f"Copied to {done.path}")
    if done.note:
        print(f"note: {done.note}")
    print(f"\n  1. start {done.game}")
    print("  2. Singleplayer")
    print(f"  3. {done.path.name}, then Play Selected World")
    if done.has_player_size:
        print("\nIn 1.20.5 or newer, /function w2m:human_size scales you to the size of a person.")


def games_to_json(games: "Sequence[Game]") -> str:
    """Return the games as a JSON list."""
    rows = [
        {"number": number, "name": one.name, "version": one.version, "saves": str(one.saves)}
        for number, one in enumerate(games, 1)
    ]
    return json.dumps(rows, indent=1)


def format_games(games: "Sequence[Game]") -> str:
    """Return one line per game: number, name, version and saves folder."""
    return "\n".join(
        f"{number:2}  {game.name}{f' ({game.version})' if game.version else ''}  {game.saves}"
        for number, game in enumerate(games, 1)
    )
