"""Generate a furnished room, a house, or houses as worlds: ``w2m rooms generate``."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from world2minecraft.cli.panels import Force
from world2minecraft.core.errors import UsageError

if TYPE_CHECKING:
    from world2minecraft.api.generation import GeneratedRoom

EXAMPLES = """\
w2m rooms generate --seed 7 -o my_room                   a room
w2m rooms generate --seed 7 --kind bathroom --shape ell  an L-shaped bathroom
w2m rooms generate --seed 7 --clutter 0.8                an untidy room
w2m rooms generate --kind laundry --furnishing full      a room with all that belongs to it
w2m rooms generate --house --rooms 12 --storeys 2        a house with stairs
w2m rooms generate --houses 40 --seed 1 --worlds WORLDS  40 houses as Minecraft worlds
"""
DEFAULT_ROOMS, DEFAULT_STOREYS = 5, 1

Kind = Annotated[
    str | None,
    typer.Option("--kind", help="living, kitchen, bathroom ...", show_default="random"),
]
Rooms = Annotated[
    int | None,
    typer.Option(
        "--rooms", help="Number of rooms of a house including halls, 3 to 14.", show_default="5"
    ),
]
Storeys = Annotated[
    int | None,
    typer.Option("--storeys", help="Number of storeys of a house, 1 or 2.", show_default="1"),
]
StyleName = Annotated[
    str | None,
    typer.Option("--style", help="Style of all houses.", show_default="random for each"),
]


def run(
    seed: Annotated[int, typer.Option("--seed", help="The same seed gives the same room.")] = 0,
    kind: Kind = None,
    shape: Annotated[
        str, typer.Option("--shape", help="box, ell, cut, sloped, columns, or any.")
    ] = "box",
    house: Annotated[
        bool, typer.Option("--house", help="Generate a house instead of a room.")
    ] = False,
    rooms: Rooms = None,
    storeys: Storeys = None,
    clutter: Annotated[
        float, typer.Option("--clutter", help="Amount of clutter, 0 (tidy) to 1.")
    ] = 0.0,
    furnishing: Annotated[
        str, typer.Option("--furnishing", help="basic, or full: all that people expect in a room.")
    ] = "basic",
    out: Annotated[Path, typer.Option("--out", "-o", help="Output folder.")] = Path("my_room"),
    houses: Annotated[
        int | None, typer.Option("--houses", help="Generate this many houses as Minecraft worlds.")
    ] = None,
    worlds: Annotated[
        Path | None, typer.Option("--worlds", help="Output folder of --houses.")
    ] = None,
    style: StyleName = None,
    force: Force = False,
) -> None:
    """Generate a furnished room or a house of several rooms, with exact ground truth.

    The output folder contains layout.json (the rooms with their walls, openings and objects, in
    metres), truth.npz (voxels of 2 cm with class, object and colour) and preview.png.

    With --houses and --worlds, houses in various styles are built as Minecraft worlds instead, each
    in a subfolder with world/, scene.json, scene.npz and designs.json.
    """
    if houses is not None or worlds is not None or style is not None:
        if houses is None or worlds is None:
            raise UsageError("--houses N and --worlds DIR must be used together")
        if kind is not None or shape != "box" or house or rooms is not None or storeys is not None:
            raise UsageError(
                "--houses cannot be combined with --kind, --shape, --house, --rooms or --storeys"
            )
        if furnishing != "basic":
            raise UsageError("--houses cannot be combined with --furnishing; omit it")
        _write_worlds(houses, seed, worlds, style, force)
        return
    if house and (kind is not None or shape != "box"):
        raise UsageError("--kind and --shape apply to a single room; omit them or --house")
    if not house and (rooms is not None or storeys is not None):
        raise UsageError("--rooms and --storeys apply to a house; add --house")
    look = {"seed": seed, "clutter": clutter, "furnishing": furnishing}
    _write_room(out, kind, shape, (rooms, storeys) if house else None, look, force)


def _write_room(
    out: Path,
    kind: str | None,
    shape: str,
    house: tuple[int | None, int | None] | None,
    look: dict[str, Any],
    force: bool,
) -> None:
    from world2minecraft.api import generate_house, generate_room
    from world2minecraft.api.generation import save_room
    from world2minecraft.api.progress import show_progress
    from world2minecraft.core.precompile import compile_first

    with show_progress() as shown:
        progress = compile_first(shown, "pictures")
        progress("room", 0, 1)
        if house is None:
            drawn = None if shape == "any" else shape
            made = generate_room(kind, shape=drawn, **look)
        else:
            rooms, storeys = house
            made = generate_house(
                rooms=DEFAULT_ROOMS if rooms is None else rooms,
                storeys=DEFAULT_STOREYS if storeys is None else storeys,
                **look,
            )
        progress("room", 1, 1, f"{len(made.layouts)} rooms, {len(made.objects)} objects")
        save_room(made, out, progress, force=force)
    _print_room(made, out)


def _print_room(made: "GeneratedRoom", out: Path) -> None:
    sides = " x ".join(f"{side:.1f}" for side in made.size_m)
    print(f"\n{made.title}, {sides} m, {len(made.objects)} objects.")
    print(f"  look   {out / 'preview.png'}")
    print(f"  next   w2m rooms scan {out} --out capture")


def _write_worlds(houses: int, seed: int, worlds: Path, style: str | None, force: bool) -> None:
    from world2minecraft.api.generation import generate_worlds
    from world2minecraft.api.progress import show_progress
    from world2minecraft.core.precompile import compile_first

    with show_progress() as shown:
        progress = compile_first(shown, "pictures")
        written = generate_worlds(
            worlds, houses=houses, seed=seed, style=style, force=force, progress=progress
        )
    print(f"\n{len(written)} houses in {worlds}.")
    print(f"  look   w2m render {written[0]} --out house.png")
    print(f"  play   w2m install {written[0]}")
    print(f"  next   w2m dataset tour {written[0]}     plan views for a data set")
