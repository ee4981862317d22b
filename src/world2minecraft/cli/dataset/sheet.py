"""``w2m dataset sheet``: many pictures of a data set or a tour on one page."""

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli.dataset.options import check_hour

if TYPE_CHECKING:
    import numpy as np

EXAMPLES = """\
w2m dataset sheet DATA                                    48 of its pictures, to sheet.png
w2m dataset sheet DATA --split test --most 120 --columns 12
w2m dataset sheet DATA --labels                           each beside itself with its labels
w2m dataset sheet tour.jsonl --world WORLDS/house_0001    what a tour would show
w2m dataset sheet tour.jsonl --world WORLD --first        frame after frame from the first on
"""

Place = Annotated[
    Path, typer.Argument(metavar="DATA_OR_TOUR", help="A data set's folder, or a tour file.")
]
World = Annotated[
    Path | None, typer.Option("--world", metavar="WORLD", help="Of a tour: what it is a tour of.")
]
Out = Annotated[Path, typer.Option("--out", "-o", metavar="FILE", help="The page, .png or .jpg.")]
Most = Annotated[int, typer.Option("--most", metavar="N", help="How many pictures.")]
Columns = Annotated[int, typer.Option("--columns", metavar="N", help="Pictures a row.")]
Width = Annotated[int, typer.Option("--width", metavar="PX", help="Of each picture.")]
First = Annotated[
    bool, typer.Option("--first", help="The first ones in a row, not spread over all.")
]
Split = Annotated[str, typer.Option("--split", help="Of a data set: train or test.")]
Labels = Annotated[
    bool, typer.Option("--labels", help="Of a data set: each picture again, its labels over it.")
]
Hour = Annotated[float | None, typer.Option("--hour", help="Of a tour: 0 to 24, the light.")]


def run(
    place: Place,
    world: World = None,
    out: Out = Path("sheet.png"),
    most: Most = 48,
    columns: Columns = 8,
    width: Width = 240,
    first: First = False,
    split: Split = "",
    labels: Labels = False,
    hour: Hour = None,
) -> None:
    """Draw one page of pictures, to look at what a data set holds or a tour will give.

    Raises:
        UsageError: a tour without its world, a number out of range. InputError: it cannot be read.
    """
    from world2minecraft.core.errors import InputError, UsageError
    from world2minecraft.core.files import write_bytes
    from world2minecraft.minecraftocc.picture_sheet import make_contact_sheet
    from world2minecraft.rendering.output.images import colour_bytes

    if min(most, columns) < 1 or not 16 <= width <= 2000:
        raise UsageError("--most and --columns are 1 or more, --width is 16 to 2000")
    check_hour(hour)
    if not place.exists():
        raise InputError(place, "is not there; give a data set's folder or a tour file")
    if place.is_dir():
        pictures = _of_data(place, most, first, split, labels)
    elif world is None:
        raise UsageError(f"{place} is a tour; name what it is a tour of: --world WORLD")
    else:
        pictures = _of_tour(place, world, most, first, width, hour)
    page = make_contact_sheet(pictures, columns, width)
    write_bytes(out, colour_bytes(page, out.suffix.lower()))
    print(f"{out}: {page.shape[1]}x{page.shape[0]} pixels")


def _chosen(count: int, most: int, first: bool) -> list[int]:
    from world2minecraft.minecraftocc.picture_sheet import spread_indices

    return list(range(min(count, most))) if first else spread_indices(count, most)


def _of_data(
    folder: Path, most: int, first: bool, split: str, labels: bool
) -> "Iterable[tuple[np.ndarray, str]]":
    from world2minecraft.core.errors import InputError
    from world2minecraft.minecraftocc.sample_figure import overlay_labels
    from world2minecraft.minecraftocc.store import open_store

    store = open_store(folder)
    keys = store.keys(split or None)
    for number in _chosen(len(keys), most, first):
        sample = store[keys[number]]
        if sample.colour is not None:
            yield sample.colour, keys[number]
        elif not labels:
            raise InputError(folder, "has labels alone, no pictures; add --labels to see those")
        if labels:
            yield overlay_labels(sample), f"{keys[number]} labels"


def _of_tour(
    tour: Path, world: Path, most: int, first: bool, width: int, hour: float | None
) -> "Iterable[tuple[np.ndarray, str]]":
    from world2minecraft.minecraftocc.picture_sheet import draw_views
    from world2minecraft.minecraftocc.scene_sources import open_scene_source
    from world2minecraft.minecraftocc.tours import read_views
    from world2minecraft.rendering.light import LightSettings
    from world2minecraft.rendering.scene import prepare_scene

    volume = open_scene_source(world).volume()
    views = read_views(tour, volume.block_to_room)
    chosen = [views[number] for number in _chosen(len(views), most, first)]
    light = LightSettings() if hour is None else LightSettings(hour=hour)
    shots = [(view.camera, view.camera_to_room) for view in chosen]
    pictures = draw_views(prepare_scene(volume), shots, width, light)
    for view, colour in zip(chosen, pictures, strict=True):
        yaw, pitch = f"{view.pose.yaw_deg:.0f}", f"{view.pose.pitch_deg:.0f}"
        yield colour, f"{view.tour_id} {view.frame}  {view.kind} {yaw} {pitch}"
