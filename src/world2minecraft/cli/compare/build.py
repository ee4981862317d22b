"""``w2m compare build``: build layouts of other methods as Minecraft worlds."""

from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.cli.compare import options as option

EXAMPLES = """\
w2m compare build scene_graph.json -o ROOM                     I-Design's room as a world
w2m compare build gpt4.bedroom.json -o ROOMS --count 10        the first ten of LayoutGPT
w2m compare build gpt4.bedroom.json -o ROOM --scene Bedroom-803
w2m compare build RESULT/layout.json --task room.json --assets ASSETS -o ROOM
"""

PathOf = Annotated[
    Path, typer.Argument(metavar="LAYOUT", help="A layout of another method.", show_default=False)
]
Out = Annotated[
    Path, typer.Option("--out", "-o", help="Write the world, or several, to this folder.")
]
Wanted = Annotated[
    list[str] | None,
    typer.Option("--scene", metavar="NAME", help="A scene, by a part of its name; repeatable."),
]
Count = Annotated[
    int | None, typer.Option("--count", help="Build the first scenes.", min=1, show_default="1")
]
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
    """Build layouts as they are: no fault is repaired.

    Each becomes a run's folder with its world, a picture and a brief report; its boxes remain in
    compared.json, from which w2m compare layouts scores it. Of a file with several scenes the first
    is built, unless --scene or --count selects others; several are built to OUT/NAME.

    Raises:
        InputError: the layout cannot be read. UsageError: an option is wrong.
    """
    from world2minecraft.api.comparison import build_layouts
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.outcome import with_compile_note

    with show_progress() as progress:
        found = build_layouts(
            path,
            out,
            scenes=scene or (),
            count=count,
            format=layout_format,
            px_m=px_m,
            task=task,
            assets=assets,
            blocks_per_metre=blocks_per_metre,
            progress=with_compile_note(progress),
        )
    for one in found.built:
        print(f"{one.method}, {one.name}: {one.built} of {one.objects} objects, {one.folder}")
    option.print_skipped(found.skipped)
    if found.scenes > len(found.built):
        print(
            f"note: the file has {found.scenes:,} scenes; add --count N or --scene NAME for others"
        )
    places = [one.folder for one in found.built]
    print(f"\nlook   {places[0] / 'preview.png'}")
    print(f"next: w2m compare judge {' '.join(map(str, places[:3]))} --agent gemini --out JUDGED")
