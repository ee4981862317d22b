"""``w2m vln server``: is all there that a body on a server needs, and does a server let it in?"""

from typing import Annotated

import typer

EXAMPLES = """\
w2m vln server                            is Node there, and mineflayer?
w2m vln server --install                  fetch mineflayer by npm, once, as pinned
w2m vln server localhost:25565            join, look around, and leave
"""

Address = Annotated[
    str, typer.Argument(metavar="[HOST[:PORT]]", help="A server with online-mode=false.")
]
Install = Annotated[
    bool, typer.Option("--install", help="Fetch mineflayer (MIT) and what it needs, 470 MB.")
]
Name = Annotated[str, typer.Option("--name", help="Of the player.")]
Version = Annotated[str, typer.Option("--version", help="Of the game; the server says it else.")]


def run(
    address: Address = "",
    install: Install = False,
    name: Name = "w2m_walker",
    version: Version = "",
) -> None:
    """Join a server by a player and say what it sees; with no address, say what is missing.

    Raises:
        UsageError: something is missing, or a name is wrong. ServerError: it is not let in.
    """
    from world2minecraft.navigation.server import mineflayer_install as installing

    if install:
        print("fetching mineflayer, as pinned; nothing of it is run")
        print(f"  kept   {installing.install()}")
    else:
        print(f"  kept   {installing.body_folder()}")
    if not address:
        print("  next   w2m vln server localhost:25565")
        return
    _check_server(address, name, version)


def _check_server(address: str, name: str, version: str) -> None:
    from world2minecraft.navigation.server.player import join

    with join(address, name=name, version=version) as body:
        x, y, z = body.body.position
        print(f"  game   {body.version}, as {body.name}")
        print(f"  stands {x:.1f} {y:.1f} {z:.1f}")
        low = [int(value) - 8 for value in (x, y, z)]
        volume = body.read([*low, *(value + 16 for value in low)])
        blocks = int((volume.states > 0).sum())
        print(f"  sees   {blocks:,} blocks of {len(volume.palette) - 1} states around it")
    print(f"  next   op {name} on its console, then: w2m vln run HOUSE ... --server {address}")
