"""``w2m install``: copy a built world to where the game finds it."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.core.errors import UsageError

if TYPE_CHECKING:
    from world2minecraft.api.worlds import Game

EXAMPLES = """\
w2m install OUT                       to the game of this machine
w2m install --list                    the games that are found
w2m install OUT --game Fabric         to the one whose name contains this, or by its number
w2m install OUT --saves D:/games/saves --name Kitchen
"""


def run(
    source: Annotated[
        Path | None, typer.Argument(metavar="OUT", help="A run's folder, or a world.")
    ] = None,
    game: Annotated[
        str, typer.Option("--game", help="Number or part of the name of a game in --list.")
    ] = "",
    saves: Annotated[
        Path | None, typer.Option("--saves", metavar="DIR", help="A saves folder instead.")
    ] = None,
    name: Annotated[
        str, typer.Option("--name", help="Name of the world.", show_default="its own")
    ] = "",
    list_: Annotated[bool, typer.Option("--list", help="List the games that are found.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the --list as JSON.")] = False,
) -> None:
    """Copy the world of a run into the game's saves folder, and print how to open it.

    Searches the Minecraft launcher (and the game directories of its installations), Prism, PolyMC
    and MultiMC. Nothing is overwritten: where the name is taken, a number follows it.

    Raises:
        UsageError: no game is found, or several. InputError: there is no world.
        OutputError: the saves folder cannot be written.
    """
    from world2minecraft.api.worlds import find_games, install_world

    if as_json and not list_:
        raise UsageError("--json needs --list")
    if list_:
        games = [] if saves else find_games()
        none = "No game found; give the saves folder of one with --saves DIR."
        print(games_to_json(games) if as_json else format_games(games) or none)
        return
    if source is None:
        raise UsageError("no world given; add the folder of a run, as in w2m install OUT")
    done = install_world(source, game=game, saves=saves, name=name)
    print(f"Copied to {done.path}")
    if done.note:
        print(f"note: {done.note}")
    print(f"\n  1. start {done.game}")
    print("  2. Singleplayer")
    print(f"  3. {done.path.name}, then Play Selected World")
    if done.has_player_size:
        print("\nFrom 1.20.5 on, /function w2m:human_size gives you the size of a person there.")


def games_to_json(games: "Sequence[Game]") -> str:
    """Return the games as a JSON list."""
    rows = [
        {"number": number, "name": one.name, "version": one.version, "saves": str(one.saves)}
        for number, one in enumerate(games, 1)
    ]
    return json.dumps(rows, indent=1)


def format_games(games: "Sequence[Game]") -> str:
    """Return the games as lines: number, name, version, saves folder."""
    return "\n".join(
        f"{number:2}  {game.name}{f' ({game.version})' if game.version else ''}  {game.saves}"
        for number, game in enumerate(games, 1)
    )
