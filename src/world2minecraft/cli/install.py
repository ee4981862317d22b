"""``w2m install``: a built world goes where the game finds it."""

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.core.errors import InputError, UsageError

if TYPE_CHECKING:
    from world2minecraft.minecraft.worlds.launchers import Game

EXAMPLES = """\
w2m install OUT                       to the game of this machine
w2m install --list                    the games that are found
w2m install OUT --game Fabric         to the one whose name has this word, or by its number
w2m install OUT --saves D:/games/saves --name Kitchen
"""


def run(
    source: Annotated[
        Path | None, typer.Argument(metavar="OUT", help="A run's folder, or a world.")
    ] = None,
    game: Annotated[
        str, typer.Option("--game", help="Number or part of the name of a game of --list.")
    ] = "",
    saves: Annotated[
        Path | None, typer.Option("--saves", metavar="DIR", help="This saves folder instead.")
    ] = None,
    name: Annotated[str, typer.Option("--name", help="What the world is called.")] = "",
    list_: Annotated[bool, typer.Option("--list", help="List the games that are found.")] = False,
) -> None:
    """Copy the world of a run into the game's saves folder, and say what to click.

    The Minecraft launcher (and the game directories of its installations), Prism, PolyMC and
    MultiMC are looked for. Nothing is ever overwritten: where the name is taken, a number
    follows it.

    Args:
        source: what to install.
        game: which of several games.
        saves: a saves folder, instead of looking for games.
        name: what the world is called; its own name where left out.
        list_: whether to list the games, and do nothing.

    Raises:
        UsageError: no game is found, or several. InputError: there is no world.
        OutputError: the saves folder cannot be written.
    """
    from world2minecraft.minecraft.worlds.launchers import Game, find_games

    games = [] if saves else find_games(sys.platform, Path.home(), os.environ)
    if list_:
        print(format_games(games) or "No game was found; give its saves folder with --saves DIR.")
        return
    if source is None:
        raise UsageError("say what to install: w2m install OUT")
    from world2minecraft.minecraft.worlds.installation import age_note, find_world, install_world

    world = find_world(source)
    chosen = Game("the game", saves) if saves else choose_game(games, game)
    if not chosen.saves.parent.is_dir():
        reason = "is no saves folder, nor is there one to make it in"
        raise InputError(chosen.saves, f"{reason}; give --saves DIR, the folder of a game's worlds")
    target = install_world(world, chosen.saves, name or None)
    print(f"Copied to {target}")
    if note := age_note(world, chosen):
        print(f"note: {note}")
    print(f"\n  1. start {chosen.name}")
    print("  2. Singleplayer")
    print(f"  3. {target.name}, then Play Selected World")
    if (target / "datapacks" / "player_size.zip").is_file():
        print("\nFrom 1.20.5 on, /function w2m:human_size makes you as large as a person there.")


def choose_game(games: "list[Game]", wanted: str) -> "Game":
    """Return the game that ``wanted`` says: a number of the list or a part of a name.

    Raises:
        UsageError: none is found, or several and none of them is meant.
    """
    if not games:
        raise UsageError("no game was found here; give its saves folder with --saves DIR")
    if wanted.isdecimal():
        if not 1 <= int(wanted) <= len(games):
            raise UsageError(
                f"--game {wanted}: there are {len(games)} games; see w2m install --list"
            )
        return games[int(wanted) - 1]
    named = [game for game in games if wanted.casefold() in game.name.casefold()]
    if len(named) == 1:
        return named[0]
    names = ", ".join(f"{games.index(g) + 1} {g.name}" for g in (named or games))
    what = f"no game is named {wanted!r}" if not named else f"{len(named)} games were found"
    raise UsageError(f"{what}; choose with --game NUMBER: {names}")


def format_games(games: "list[Game]") -> str:
    """Return the games as lines: number, name, version, saves folder."""
    return "\n".join(
        f"{number:2}  {game.name}{f' ({game.version})' if game.version else ''}  {game.saves}"
        for number, game in enumerate(games, 1)
    )
