"""``w2m vln server``: check and install what a player on a game server needs."""

from typing import Annotated

import typer

EXAMPLES = """\
w2m vln server                            are Node and mineflayer installed?
w2m vln server --install                  fetch mineflayer by npm, in the pinned versions
w2m vln server localhost:25565            join, look around, and leave
"""

Address = Annotated[
    str, typer.Argument(metavar="[HOST[:PORT]]", help="A server with online-mode=false.")
]
Install = Annotated[
    bool, typer.Option("--install", help="Fetch mineflayer (MIT) and its dependencies, 470 MB.")
]
Name = Annotated[str, typer.Option("--name", help="The name of the player.")]
Version = Annotated[
    str,
    typer.Option("--version", help="The game version.", show_default="that of the server"),
]


def run(
    address: Address = "",
    install: Install = False,
    name: Name = "w2m_walker",
    version: Version = "",
) -> None:
    """Join a server with a player and report what it sees; without an address, check the install.

    Raises:
        UsageError: something is missing, or a name is wrong. ServerError: the server refuses it.
    """
    from world2minecraft.api.agents import mineflayer_folder

    if install:
        print("fetching mineflayer, in the pinned versions; nothing of it is executed")
    print(f"  found  {mineflayer_folder(install=install)}")
    if not address:
        print("  next   w2m vln server localhost:25565")
        return
    _check_server(address, name, version)


def _check_server(address: str, name: str, version: str) -> None:
    from world2minecraft.api.agents import check_server

    seen = check_server(address, name=name, version=version)
    x, y, z = seen.position
    print(f"  game   {seen.version}, as {seen.name}")
    print(f"  stands {x:.1f} {y:.1f} {z:.1f}")
    print(f"  sees   {seen.blocks:,} blocks of {seen.states} states around it")
    print(f"  next   op {name} on its console, then: w2m vln run HOUSE ... --server {address}")
