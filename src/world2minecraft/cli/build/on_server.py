"""What ``w2m build --rcon`` does: build on a running server, and say what came of it."""

import os
from typing import TYPE_CHECKING

from world2minecraft.core.errors import UsageError
from world2minecraft.minecraft.server.rcon import build_note_path, parse_address

if TYPE_CHECKING:
    from world2minecraft.core.types import BlockVolume

PASSWORD = "W2M_RCON_PASSWORD"


def on_server(
    volume: "BlockVolume",
    address: str,
    at: tuple[int, int, int] | None,
    turns: int,
    *,
    air: str,
    is_room: bool,
    mc_version: str,
) -> None:
    """Build a volume on a server.

    Args:
        volume: the blocks.
        address: ``HOST`` or ``HOST:PORT`` of its remote console.
        at: where the blocks' smallest x and z, and their ground, come to stand; 0 64 0 for None.
        turns: quarter turns before that.
        air: which air is built, as ``editing.build_into_world`` has it.
        is_room: whether the volume is a room of ours, whose ground is at the usual height.
        mc_version: the server's game.

    Raises:
        UsageError: the address or the environment lacks something.
        ServerError: the server refuses, or cannot be reached.
    """
    host, port = parse_address(address)
    password = password_of_environment()
    from world2minecraft.cli.progress import show_progress
    from world2minecraft.core.coordinates import ROOM_CORNER_BLOCK
    from world2minecraft.editing.build_into_world import affected_mask
    from world2minecraft.editing.volume_relocation import place_volume
    from world2minecraft.minecraft.file_format import Losses
    from world2minecraft.minecraft.server.rcon import RconClient
    from world2minecraft.minecraft.server.server_build import LiveBuilder, plan_build
    from world2minecraft.minecraft.versions import game_version

    at = at or ROOM_CORNER_BLOCK
    volume = place_volume(volume, at, turns, ROOM_CORNER_BLOCK[1] if is_room else None)
    losses, built = Losses(), affected_mask(volume, air)
    plan = plan_build(volume, game_version(mc_version), built=built, losses=losses)
    note = build_note_path(f"{host}:{port}", plan.digest)
    if note.is_file():
        print("An earlier run of this build was stopped; this one goes on from there.")
    client = RconClient(host, port, password)
    with show_progress() as progress:
        result = LiveBuilder(client, plan, note, progress).run()
    x, y, z = at
    size = " x ".join(str(side) for side in volume.states.shape)
    print(f"\nBuilt {int((volume.states > 0).sum()):,} blocks at {x} {y} {z} ({size}).")
    cuts = f", {result.reconnects} lost connections survived" if result.reconnects else ""
    print(f"  {result.commands:,} commands{cuts}; {result.checked} places asked for, all right")
    for what, count in losses:
        print(f"  left out: {count} {what}")
    print(f"  look   /tp @s {x} {y} {z}, or a few blocks into the room")


def check_server(address: str, air: str) -> None:
    """Check what can be known before any work.

    Raises:
        UsageError: the address or the environment lacks something, or there is no such ``air``.
    """
    from world2minecraft.editing.build_into_world import check_air

    parse_address(address)
    password_of_environment()
    check_air(air)


def password_of_environment() -> str:
    """Return the console's password.

    Raises:
        UsageError: it is not set. An option would show it to everyone on the machine.
    """
    if not os.environ.get(PASSWORD):
        raise UsageError(
            f"--rcon takes the password from the environment: export {PASSWORD}=... "
            "(rcon.password in server.properties)"
        )
    return os.environ[PASSWORD]
