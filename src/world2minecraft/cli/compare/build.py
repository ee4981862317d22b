"""Build layouts of other methods as Minecraft worlds: ``w2m compare build``."""

from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.cli.compare import options as option
from world2minecraft.cli.panels import Force

EXAMPLES = """\
w2m compare build scene_graph.json -o ROOM                     I-Design's room as a world
w2m compare build gpt4.bedroom.json -o ROOMS --count 10        the first ten of LayoutGPT
w2m compare build gpt4.bedroom.json -o ROOM --scene Bedroom-803
w2m compare build RESULT/layout.json --task room.json --assets ASSETS -o ROOM
"""

PathOf = Annotated[
    Path,
    typer.Argument(metavar="LAYOUT", help="Layout file of another method.", show_default=False),
]
Out = Annotated[Path, typer.Option("--out", "-o", help="Write the worlds to this folder.")]
Wanted = Annotated[
    list[str] | None,
    typer.Option("--scene", metavar="NAME", help="Part of the name of a scene. Repeatable."),
]
Count = Annotated[
    int | None,
    typer.Option(
        "--count",
        help="Number of scenes to build, starting with the first.",
        min=1,
        show_default="1",
    ),
]
Scale = Annotated[float, typer.Option("--blocks-per-metre", help="Scale of the worlds.")]


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
    force: Force = False,
) -> None:
    """Build layouts as worlds without repairing their faults.

    Each layout becomes a run folder with a world, an image and a brief report. Its bounding boxes
    are stored in compared.json, which w2m compare layouts can score. If the file contains several
    scenes, the first is built unless --scene or --count selects others. Several scenes are built in
    OUT/NAME.

    Raises:
        InputError: If the layout cannot be read.
        UsageError: If an option is invalid.
    """
    from world2minecraft.api.comparison import build_layouts
    from world2minecraft.api.progress import show_progress
    from world2minecraft.core.precompile import compile_first

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
            force=force,
            progress=compile_first(progress, "pictures"),
        )
    for one in found.built:
        print(f"{one.method}, {one.name}: {one.built} of {one.objects} objects, {one.folder}")
    option.print_skipped(found.skipped)
    if found.scenes > len(found.built):
        print(f"note: the file contains {found.scenes:,} scenes; select others with --scene NAME")
    places = [one.folder for one in found.built]
    print(f"\nlook   {places[0] / 'preview.png'}")
    print(f"next: w2m compare judge {' '.join(map(str, places[:3]))} --agent gemini --out JUDGED")
