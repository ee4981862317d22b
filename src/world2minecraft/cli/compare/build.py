"""``w2m compare build``: layouts of others as Minecraft worlds, to look at and to judge alike."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli.compare import options as option

if TYPE_CHECKING:
    from world2minecraft.paper.layouts import ComparedScene

EXAMPLES = """\
w2m compare build scene_graph.json --out ROOM                  I-Design's room as a world
w2m compare build gpt4.bedroom.json --out ROOMS --count 10     the first ten of LayoutGPT
w2m compare build gpt4.bedroom.json --out ROOM --scene Bedroom-803
w2m compare build RESULT/layout.json --task room.json --assets ASSETS --out ROOM
"""

PathOf = Annotated[
    Path, typer.Argument(metavar="LAYOUT", help="A layout of another method.", show_default=False)
]
Out = Annotated[Path, typer.Option("--out", help="The folder of the world, or of several.")]
Wanted = Annotated[
    list[str] | None,
    typer.Option("--scene", metavar="NAME", help="Which scene, by a part of its name; repeatable."),
]
Count = Annotated[int | None, typer.Option("--count", help="The first so many scenes.", min=1)]
Scale = Annotated[float, typer.Option("--blocks-per-metre", help="Scale, as in w2m build.")]


def run(
    path: PathOf,
    out: Out,
    scene: Wanted = None,
    count: Count = None,
    layout_format: option.Format = "",
    px_m: option.PxM = option.DEFAULT_PX_M,
    task: option.Task = None,
    assets: option.Assets = None,
    blocks_per_metre: Scale = 4.0,
) -> None:
    """Build layouts as they are: no fault is mended.

    Each becomes a run's folder with its world, a picture and a brief report; its boxes stay in
    compared.json, from which w2m compare layouts scores it. Of a file with several scenes the first
    is built, unless --scene or --count says more; several are built to OUT/NAME.

    Raises:
        InputError: the layout cannot be read. UsageError: an option is wrong.
    """
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.outcome import print_compile_note
    from world2minecraft.paper.layouts.importers import How, read_layouts_of
    from world2minecraft.paper.layouts.layout_to_world import build_scene
    from world2minecraft.reconstruction.parameters import Parameters

    option.check_px(px_m)
    chosen = Parameters(blocks_per_metre=blocks_per_metre)
    found = read_layouts_of(path, How(px_m, task, assets), layout_format)
    several = count is not None or len(scene or ()) > 1
    wanted = select_scenes(found, scene or [], count)
    places = [out / name for name in folder_names(wanted)] if several else [out]
    print_compile_note()
    for one, place in zip(wanted, places, strict=True):
        with show_progress() as progress:
            built = build_scene(one, place, chosen, progress)
        print(f"{one.method}, {one.name}: {built.objects} of {len(one.objects)} objects, {place}")
    option.print_skipped(wanted)
    if len(found) > len(wanted):
        print(f"note: {len(found):,} scenes are there; --count N builds more, --scene NAME others")
    print(f"\nlook   {places[0] / 'preview.png'}")
    print(f"next: w2m compare judge {' '.join(map(str, places[:3]))} --agent gemini --out JUDGED")


def select_scenes(
    found: "list[ComparedScene]", names: list[str], count: int | None
) -> "list[ComparedScene]":
    """Return the scenes that are asked for, the first where nothing is.

    Raises:
        UnknownNameError: no scene has such a name.
    """
    from world2minecraft.core.errors import UnknownNameError

    if not names:
        return found[: count or 1]
    chosen = []
    for name in names:
        fitting = [one for one in found if name in one.name]
        if not fitting:
            raise UnknownNameError("scene", name, [one.name for one in found])
        chosen += fitting[: count or 1]
    return chosen


def folder_names(scenes: "list[ComparedScene]") -> list[str]:
    """Return a name for each scene that any system takes for a folder; no two are alike.

    Names come from files of others, so only letters, digits, dots and lines of them stay.
    """
    names: list[str] = []
    for number, one in enumerate(scenes):
        kept = "".join(c if c.isascii() and (c.isalnum() or c in "-_") else "_" for c in one.name)
        name = kept[-60:].strip("_") or f"scene_{number}"
        names.append(name if name not in names else f"{name}_{number}")
    return names
