"""Build a room as a new world, into an existing world or on a server: ``w2m build``."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from world2minecraft.cli.build.options import (
    Formats,
    PaletteName,
    Scale,
    SettingList,
    Style,
    Version,
    parse_settings,
    print_style_note,
    split_names,
)
from world2minecraft.cli.panels import MORE, Force
from world2minecraft.core.errors import UsageError

if TYPE_CHECKING:
    from world2minecraft.api.existing_worlds import ServerBuild, WorldChange

EXAMPLES = """\
w2m build OUT -o second --blocks-per-metre 2     a finished run at another scale
w2m build OUT -o fine --style display            furniture as fine as a mod's, without a mod
w2m build room.npz -o world_of_room              an occupancy grid alone
w2m build labels.npy -o world_of_labels          an array of class ids [x, y, z]
w2m build scene.npy -o world_of_scene --classes embodied    ids of EmbodiedOcc: 12 is empty
w2m build OUT --into saves/Home --at 100 64 -20  into an existing world; w2m undo reverts it
w2m build house.schem --into saves/Home --at 0 70 0
w2m build OUT --rcon localhost:25575 --at 0 70 0     on a running server
"""

Source = Annotated[
    Path,
    typer.Argument(
        metavar="ROOM", help="Run folder, room.npz, occ.json, .npy, or block file (.schem ...)."
    ),
]
Out = Annotated[Path | None, typer.Option("--out", "-o", help="Write a new world to this folder.")]
Into = Annotated[
    Path | None, typer.Option("--into", metavar="WORLD", help="Build into this world.")
]
Rcon = Annotated[
    str | None, typer.Option("--rcon", metavar="HOST:PORT", help="Build on a running server.")
]
Place = Annotated[
    tuple[int, int, int] | None,
    typer.Option("--at", metavar="X Y Z", help="Block position of the room's floor corner."),
]
Turns = Annotated[
    int, typer.Option("--turns", help="Quarter turns, counter-clockwise from above, with --at.")
]
Air = Annotated[
    str,
    typer.Option(
        "--air",
        help="Air that replaces existing blocks: room, box or none.",
        rich_help_panel=MORE,
    ),
]
NewChunks = Annotated[
    bool,
    typer.Option(
        "--new-chunks",
        help="With --into, create chunks that the game has not generated.",
        rich_help_panel=MORE,
    ),
]

Classes = Annotated[
    str,
    typer.Option(
        "--classes",
        help="Class ids of an occupancy grid: nyu12, embodied (12 is empty), occscannet or a YAML "
        "file.",
        show_default="nyu12",
        rich_help_panel=MORE,
    ),
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
    classes: Classes = "",
    settings: SettingList = None,
    force: Force = False,
) -> None:
    """Build a room as a new world, into an existing world, or on a running server.

    The objects and placements of a run are used unchanged. For an occupancy grid, objects are
    detected and matched with furniture first. With --into or --rcon, the room's floor corner is
    placed at X Y Z, so a player stands on the floor at height Y. With --into, every changed file is
    backed up, and `w2m undo WORLD` restores it. A build on a server cannot be undone. Its password
    is read from the environment variable W2M_RCON_PASSWORD.
    """
    _check_targets(out, into, rcon, at, turns, air, new_chunks)
    changes = parse_settings(settings)
    print_style_note(blocks_per_metre, changes.get("build.style", style))
    options: dict[str, Any] = {
        "blocks_per_metre": blocks_per_metre,
        "style": style,
        "palette": palette,
        "classes": classes,
        "settings": changes,
    }
    place: dict[str, Any] = {"turns": turns, "air": air}
    if out is not None:
        more = {"formats": split_names(formats), "mc_version": mc_version, "force": force}
        _build_folder(source, out, options | more)
    if into is not None and at is not None:
        _build_into(source, into, at, options | place | {"new_chunks": new_chunks})
    if rcon is not None:
        _build_on_server(source, rcon, options | place | {"at": at, "mc_version": mc_version})


def _check_targets(
    out: Path | None,
    into: Path | None,
    rcon: str | None,
    at: tuple[int, int, int] | None,
    turns: int,
    air: str,
    new_chunks: bool,
) -> None:
    """Raise UsageError before any work if no target is given or options contradict each other."""
    from world2minecraft.api.existing_worlds import check_place

    if out is None and into is None and rcon is None:
        raise UsageError(
            "choose where to build: --out FOLDER, --into WORLD --at X Y Z, or --rcon HOST:PORT"
        )
    has = {"has_world": into is not None, "has_server": rcon is not None}
    check_place(at, turns, air, new_chunks, **has)


def _build_folder(source: Path, out: Path, options: dict[str, Any]) -> None:
    from world2minecraft.api import build
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.outcome import print_play_steps
    from world2minecraft.core.precompile import compile_first

    with show_progress() as shown:
        progress = compile_first(shown)
        build(source, out, progress=progress, **options)
    print()
    print_play_steps(out / "build")


def _build_into(
    source: Path, world: Path, at: tuple[int, int, int], options: dict[str, Any]
) -> None:
    from world2minecraft.api import build_into_world
    from world2minecraft.api.progress import show_progress
    from world2minecraft.core.precompile import compile_first

    with show_progress() as shown:
        progress = compile_first(shown)
        done = build_into_world(source, world, at, progress=progress, **options)
    print()
    _print_change(done)


def _build_on_server(source: Path, server: str, options: dict[str, Any]) -> None:
    from world2minecraft.api import build_on_server
    from world2minecraft.api.progress import show_progress
    from world2minecraft.core.precompile import compile_first

    with show_progress() as shown:
        progress = compile_first(shown)
        done = build_on_server(source, server, progress=progress, **options)
    _print_server_build(done)


def _print_change(done: "WorldChange") -> None:
    """Print the changes to a world, how to get there, and how to undo them."""
    if done.recovered:
        print("An earlier build was interrupted; its changes were undone first.")
    if not done.blocks and not done.entities:
        print(f"{done.world}: the build is already complete; nothing changed.")
        return
    size = " x ".join(map(str, done.size_blocks))
    more = f" and {done.entities} entities" if done.entities else ""
    x, z = (done.corner[axis] + done.size_blocks[axis] // 2 for axis in (0, 2))
    print(f"{done.world}: {done.blocks:,} blocks changed{more}; the build is {size} blocks.")
    print(f"  go there   /tp @s {x} {done.corner[1]} {z}")
    if done.has_size_functions:
        print("  your size  /function w2m:human_size, and back /function w2m:game_size")
    print(f"  undo       w2m undo '{done.world}'")


def _print_server_build(done: "ServerBuild") -> None:
    """Print what was built on a server and how to get there."""
    if done.resumed:
        print("An interrupted build was resumed.")
    x, y, z = done.corner
    size = " x ".join(str(side) for side in done.size_blocks)
    print(f"\nBuilt {done.blocks:,} blocks at {x} {y} {z} ({size}).")
    cuts = f", {done.reconnects} lost connections restored" if done.reconnects else ""
    print(f"  {done.commands:,} commands{cuts}; {done.checked} blocks verified")
    for what, count in done.left_out.items():
        print(f"  omitted: {count} {what}")
    print(f"  look   /tp @s {x} {y} {z}, or a few blocks into the room")
