"""Check and install the requirements for a player on a game server: ``w2m vln server``."""

from typing import Annotated

import typer

EXAMPLES = """\
w2m vln server                            check that Node and mineflayer are installed
w2m vln server --install                  install the pinned version of mineflayer with npm
w2m vln server localhost:25565            join, look around, and leave
"""

Address = Annotated[
    str, typer.Argument(metavar="[HOST[:PORT]]", help="Server with online-mode=false.")
]
Install = Annotated[
    bool, typer.Option("--install", help="Install mineflayer (MIT) and its dependencies, 470 MB.")
]
Name = Annotated[str, typer.Option("--name", help="Player name.")]
Version = Annotated[
    str,
    typer.Option("--version", help="Minecraft version.", show_default="that of the server"),
]


def run(
    address: Address = "",
    install: Install = False,
    name: Name = "w2m_walker",
    version: Version = "",
) -> None:
    """Join a server with a player and report its surroundings, or check the installation.

    Without an address, only the installation is checked.

    Raises:
        UsageError: If a requirement is missing or a name is invalid.
        ServerError: If the server refuses the player.
    """
    from world2minecraft.api.agents import mineflayer_folder

    if install:
        print("installing mineflayer in the pinned version, without running install scripts")
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
    print(f"  at     {x:.1f} {y:.1f} {z:.1f}")
    print(f"  sees   {seen.blocks:,} blocks of {seen.states} states around the player")
    print(f"  next   run op {name} on the server console, then:")
    print(f"         w2m vln run HOUSE ... --server {address}")
