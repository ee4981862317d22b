"""``w2m build``: any occupancy file becomes blocks: in a folder, in a world, or both."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli.build.options import (
    Formats,
    PaletteName,
    Scale,
    Settings,
    Style,
    Version,
    style_note,
    with_build_options,
)
from world2minecraft.core.errors import UsageError

if TYPE_CHECKING:
    from world2minecraft.core.types import BlockVolume
    from world2minecraft.reconstruction.parameters import Parameters

EXAMPLES = """\
w2m build OUT --out second --blocks-per-metre 2     a finished run at another scale
w2m build OUT --out fine --style display            furniture as fine as a mod's, without a mod
w2m build room.npz --out world_of_room              an occupancy grid alone
w2m build labels.npy --out world_of_labels          an array of class ids [x, y, z]
w2m build OUT --into saves/Home --at 100 64 -20     into a world of yours; w2m undo takes it back
w2m build house.schem --into saves/Home --at 0 70 0
w2m build OUT --rcon localhost:25575 --at 0 70 0    on a running server
"""


Source = Annotated[
    Path,
    typer.Argument(
        metavar="ROOM", help="A run's folder, room.npz, occ.json, .npy; or blocks (.schem ...)."
    ),
]
Out = Annotated[
    Path | None, typer.Option("--out", help="The folder of the results: a world of its own.")
]
Into = Annotated[
    Path | None, typer.Option("--into", metavar="WORLD", help="Build into this world.")
]
Place = Annotated[
    tuple[int, int, int] | None,
    typer.Option("--at", metavar="X Y Z", help="Where the room's corner comes to stand."),
]
Rcon = Annotated[
    str | None, typer.Option("--rcon", metavar="HOST:PORT", help="Build on a running server.")
]
Turns = Annotated[
    int, typer.Option("--turns", help="With --at: quarter turns, counter-clockwise from above.")
]
Air = Annotated[
    str, typer.Option("--air", help="With --at: which air is built: room, box or none.")
]
NewChunks = Annotated[
    bool, typer.Option("--new-chunks", help="With --into: make what the game never generated.")
]


def run(
    source: Source,
    out: Out = None,
    into: Into = None,
    rcon: Rcon = None,
    at: Place = None,
    turns: Turns = 0,
    air: Air = "room",
    new_chunks: NewChunks = False,
    blocks_per_metre: Scale = 4.0,
    style: Style = None,
    palette: PaletteName = None,
    formats: Formats = None,
    mc_version: Version = "1.20.1",
    settings: Settings = None,
) -> None:
    """Build a world from an occupancy grid, or build into a world that exists.

    A run's folder is built from its objects and placements as they stand; from a grid alone the
    objects are found and matched first. With --into or --rcon, the corner of the room's floor
    comes to stand at X Y Z, so that one stands on it at height Y. With --into every file that is
    touched is backed up, and `w2m undo WORLD` brings it back. With --rcon the blocks are set on a
    running server (password: W2M_RCON_PASSWORD); that cannot be undone.

    Args:
        source: what to build.
        out: the folder to write.
        into: the world to build into.
        rcon: the server's remote console.
        at: where the room's corner goes, in blocks of that world.
        turns: quarter turns before that.
        air: which air of the room replaces blocks of the world.
        new_chunks: whether chunks are made that the game never did.
        blocks_per_metre: the scale.
        style: what furniture is made of.
        palette: which blocks may be used.
        formats: further forms of the build.
        mc_version: the game version.
        settings: further parameters.

    Raises:
        UsageError: nothing says where to build, or an option needs another.
    """
    check_targets(out, into, rcon, at, turns)
    check_destination(into, rcon, air, new_chunks)
    from world2minecraft.reconstruction.parameters import Parameters, with_settings

    chosen = Parameters(blocks_per_metre=blocks_per_metre, mc_version=mc_version)
    chosen = with_settings(with_build_options(chosen, style, palette, formats), settings or [])
    style_note(chosen)
    if out is not None:
        into_folder(source, out, chosen)
    if into is not None and at is not None:
        build_into(source, chosen, into, at, turns, air, new_chunks)
    if rcon is not None:
        build_on(source, chosen, rcon, at, turns, air)


def build_into(
    source: Path,
    chosen: "Parameters",
    world: Path,
    at: tuple[int, int, int],
    turns: int,
    air: str,
    new_chunks: bool,
) -> None:
    """Build into a world; what can be known of it is checked before any work."""
    from world2minecraft.cli.build.into_world import check_world, into_world

    check_world(world, air)
    how = {"air": air, "new_chunks": new_chunks, "is_room": holds_room(source)}
    into_world(volume_of(source, chosen), world, at, turns, **how)


def build_on(
    source: Path,
    chosen: "Parameters",
    server: str,
    at: tuple[int, int, int] | None,
    turns: int,
    air: str,
) -> None:
    """Build on a server; what can be known of it is checked before any work."""
    from world2minecraft.cli.build.on_server import check_server, on_server

    check_server(server, air)
    how = {"air": air, "is_room": holds_room(source), "mc_version": chosen.mc_version}
    on_server(volume_of(source, chosen), server, at, turns, **how)


def check_targets(
    out: Path | None,
    into: Path | None,
    rcon: str | None,
    at: tuple[int, int, int] | None,
    turns: int,
) -> None:
    """Check, before any work, that the options say where to build.

    Raises:
        UsageError: they do not.
    """
    if out is None and into is None and rcon is None:
        raise UsageError(
            "say where to build: --out FOLDER, --into WORLD --at X Y Z, or --rcon HOST:PORT"
        )
    if into is not None and at is None:
        raise UsageError("--into needs a place: add --at X Y Z, such as the F3 screen shows")
    if into is None and rcon is None and (at is not None or turns):
        raise UsageError(
            "--at and --turns go with --into WORLD or --rcon; add it or leave them out"
        )


def check_destination(into: Path | None, rcon: str | None, air: str, new_chunks: bool) -> None:
    """Check, before any work, the options that say how a world or a server is built into.

    Raises:
        UsageError: one is wrong, or says nothing of what is asked for.
    """
    from world2minecraft.editing.build_into_world import check_air

    check_air(air)
    if new_chunks and into is None:
        raise UsageError("--new-chunks goes with --into WORLD; add it or leave it out")
    if air != "room" and into is None and rcon is None:
        raise UsageError("--air goes with --into WORLD or --rcon; add one or leave it out")


def into_folder(source: Path, out: Path, chosen: "Parameters") -> None:
    """Build a world of its own and its other forms under ``out``, and say how to play."""
    from world2minecraft.cli.outcome import print_compile_note, print_play_steps
    from world2minecraft.cli.progress import show_progress
    from world2minecraft.reconstruction.build_without_capture import rebuild

    print_compile_note()
    with show_progress() as progress:
        rebuild(source, out, chosen, progress)
    print()
    print_play_steps(out / "build")


def holds_room(source: Path) -> bool:
    """Whether ``source`` is a room, whose floor is known, and not blocks made elsewhere."""
    from world2minecraft.reconstruction.build_without_capture import is_block_file

    return not is_block_file(source)


def volume_of(source: Path, chosen: "Parameters") -> "BlockVolume":
    """Return the blocks of a room for a target that is no folder; nothing is written."""
    from world2minecraft.cli.outcome import print_compile_note
    from world2minecraft.cli.progress import show_progress
    from world2minecraft.reconstruction.build_without_capture import blocks_of

    print_compile_note()
    with show_progress() as progress:
        volume = blocks_of(source, chosen, progress)
    print()
    return volume
