"""``w2m rooms generate``: a furnished room or a house as a layout, as voxels and as a picture."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.core.progress import Progress
    from world2minecraft.procgen import Room

EXAMPLES = """\
w2m rooms generate --seed 7                              a room, to my_room/
w2m rooms generate --seed 7 --kind bathroom --shape ell  an L-shaped bathroom
w2m rooms generate --seed 7 --clutter 0.8                as it looks on a Friday
w2m rooms generate --house --rooms 12 --storeys 2        a house with stairs
w2m rooms generate --houses 40 --seed 1 --worlds WORLDS  forty houses as Minecraft worlds
"""
DEFAULT_ROOMS = 5


def run(
    seed: Annotated[int, typer.Option("--seed", help="The same seed, the same room.")] = 0,
    kind: Annotated[
        str | None, typer.Option("--kind", help="living, kitchen, bathroom ...; drawn if not said.")
    ] = None,
    shape: Annotated[
        str, typer.Option("--shape", help="box, ell, cut, sloped, columns, or any.")
    ] = "box",
    house: Annotated[bool, typer.Option("--house", help="A house instead of a room.")] = False,
    rooms: Annotated[
        int | None, typer.Option("--rooms", help="Rooms of the house, 3 to 14, halls among them.")
    ] = None,
    storeys: Annotated[
        int | None, typer.Option("--storeys", help="Storeys of the house, 1 or 2.")
    ] = None,
    clutter: Annotated[float, typer.Option("--clutter", help="0 (tidy) to 1.")] = 0.0,
    out: Annotated[Path, typer.Option("--out", help="The folder to write.")] = Path("my_room"),
    houses: Annotated[
        int | None, typer.Option("--houses", help="How many houses, as Minecraft worlds.")
    ] = None,
    worlds: Annotated[
        Path | None, typer.Option("--worlds", help="The folder of the worlds.")
    ] = None,
    style: Annotated[
        str | None, typer.Option("--style", help="Of all houses; each draws its own if not said.")
    ] = None,
) -> None:
    """Generate a furnished room or a house of several rooms, with exact truth.

    The folder gets layout.json (the rooms with their walls, openings and objects, in metres),
    truth.npz (voxels of 2 cm with class, object and colour) and preview.png.

    With --houses and --worlds, houses become Minecraft worlds instead, in styles of their own:
    a folder each, with world/, scene.json, scene.npz and designs.json.
    """
    if houses is not None or worlds is not None or style is not None:
        _check_worlds(houses, worlds, kind, shape, house, rooms, storeys)
        _write_worlds(houses or 0, seed, worlds or Path(), style)
    else:
        _check_words(kind, shape, house, rooms, storeys)
        _generate(seed, kind, shape, (rooms, storeys) if house else None, clutter, out)


def _generate(
    seed: int,
    kind: str | None,
    shape: str,
    house: tuple[int | None, int | None] | None,
    clutter: float,
    out: Path,
) -> None:
    from world2minecraft.cli.outcome import print_compile_note
    from world2minecraft.cli.progress import show_progress
    from world2minecraft.core.errors import UsageError
    from world2minecraft.reconstruction.run_folder import check_writable

    check_writable(out)
    print_compile_note()
    with show_progress() as progress:
        progress("room", 0, 1)
        try:
            made = _house(seed, *house, clutter) if house else _room(seed, kind, shape, clutter)
        except ValueError as error:
            raise UsageError(f"--{error}") from error
        progress("room", 1, 1, f"{len(made.layouts)} rooms, {len(made.objects)} objects")
        _write(made, out, progress)
    sides = " x ".join(f"{side:.1f}" for side in made.size_m)
    print(f"\nA {made.kind}, {sides} m, {len(made.objects)} objects.")
    print(f"  look   {out / 'preview.png'}")
    print(f"  next   w2m rooms scan {out} --out capture")


def _check_worlds(
    houses: int | None,
    worlds: Path | None,
    kind: str | None,
    shape: str,
    house: bool,
    rooms: int | None,
    storeys: int | None,
) -> None:
    from world2minecraft.core.errors import UsageError
    from world2minecraft.reconstruction.run_folder import check_writable

    if houses is None or worlds is None:
        raise UsageError("--houses says how many and --worlds where; give both")
    if houses < 1:
        raise UsageError(f"--houses must be 1 or more, not {houses}")
    if kind is not None or shape != "box" or house or rooms is not None or storeys is not None:
        raise UsageError("--houses draws kinds, rooms and storeys by its seed; leave them out")
    check_writable(worlds)


def _write_worlds(houses: int, seed: int, worlds: Path, style: str | None) -> None:
    from world2minecraft.cli.outcome import print_compile_note
    from world2minecraft.cli.progress import show_progress
    from world2minecraft.core.errors import UsageError
    from world2minecraft.procgen.worlds import write_worlds

    if seed < 0:
        raise UsageError(f"--seed must be 0 or more, not {seed}")
    print_compile_note()
    with show_progress() as progress:
        written = write_worlds(worlds, houses, seed, style=style, progress=progress)
    print(f"\n{len(written)} houses in {worlds}.")
    print(f"  look   w2m render {written[0]} --out house.png")
    print(f"  play   w2m install {written[0]}")
    print(f"  next   w2m dataset tour {written[0]}     where pictures are taken")


def _check_words(
    kind: str | None, shape: str, house: bool, rooms: int | None, storeys: int | None
) -> None:
    from world2minecraft.core.errors import UsageError

    if house and (kind is not None or shape != "box"):
        raise UsageError("--kind and --shape are of a single room; leave them out with --house")
    if not house and (rooms is not None or storeys is not None):
        raise UsageError("--rooms and --storeys are of a house; add --house")


def _house(seed: int, rooms: int | None, storeys: int | None, clutter: float) -> "Room":
    from world2minecraft.procgen import generate_house

    count = DEFAULT_ROOMS if rooms is None else rooms
    return generate_house(
        seed, rooms=count, storeys=1 if storeys is None else storeys, clutter=clutter
    )


def _room(seed: int, kind: str | None, shape: str, clutter: float) -> "Room":
    from world2minecraft.procgen import generate_room

    drawn = None if shape == "any" else shape
    return generate_room(seed, kind=kind, clutter=clutter, shape=drawn)


def _write(made: "Room", out: Path, progress: "Progress") -> None:
    import io

    from PIL import Image

    from world2minecraft.core.files import write_bytes
    from world2minecraft.procgen import room_picture, write_generated

    progress("write", 0, 2, "layout.json, truth.npz")
    write_generated(made, out)
    progress("write", 1, 2, "preview.png")
    picture = io.BytesIO()
    Image.fromarray(room_picture(made)).save(picture, "PNG")
    write_bytes(out / "preview.png", picture.getvalue())
    progress("write", 2, 2)
