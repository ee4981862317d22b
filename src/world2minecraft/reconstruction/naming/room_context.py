"""What the other objects of a room say of an object: the cabinet beside a toilet is a washbasin.

The segmentation network votes for the 40 classes of NYUv2, which lack ovens and showers, and calls
the body of a washstand a cabinet and its top a counter, as NYUv2's annotators do. So votes alone
name no washstand and no stove, and take any dark box for a shower.
"""

from collections.abc import Callable, Sequence

from world2minecraft.core.classes import CLASS_DISPLAY_NAMES
from world2minecraft.core.vocabulary import NYU40_COUNT, nyu40_names
from world2minecraft.reconstruction.naming.name_model import ObjectTraits
from world2minecraft.reconstruction.naming.name_votes import class_votes

Named = Sequence[tuple[str, float]]

SURE = 0.6  # Of the name of the object that tells the kind of the room.
# Of a fitting: washbasins of 14 NYUv2 and 20 generated bathrooms, docs/explanation/names.md.
CONFIDENCE = 0.7
BATHROOM = ("toilet", "bathtub", "shower curtain")
KITCHEN = ("refrigerator", "dishwasher", "oven", "stove")
CUPBOARDS = ("wall cabinet", "kitchen island")
IN_KITCHENS = {"washbasin": "sink", "wardrobe": "cabinet", "dresser": "cabinet"}
BASINS = ("washbasin", "sink")
STOVES = ("stove", "oven")

BODY = ("cabinet", "counter", "sink", "dresser", "night stand", "other furniture")
BODY_SHARE, TOP_SHARE = 0.6, 0.01  # Of the votes of a washstand.
SINK_SHARE = 0.03  # Of the votes of a kitchen's sink counter; other counters have 0.01.
TOP_M, WIDTH_M = (0.6, 1.2), (0.35, 2.2)
# NYUv2 labels stoves as other structure. Other cupboards of kitchens have 0.1 of such votes.
STOVE_SHARE = 0.13
STOVE_TOP_M, STOVE_WIDTH_M = (0.7, 1.15), (0.4, 1.1)


def name_by_context(objects: Sequence[ObjectTraits], names: Named) -> list[tuple[str, float]]:
    """Return the names of the objects of one room, corrected by what the others are.

    A room with a toilet, bath or shower curtain is a bathroom, and its basin a washbasin. A room
    with wall cabinets, a refrigerator, oven or dishwasher and no toilet is a kitchen, whose basin
    is a sink and whose wardrobes are cabinets. One object without such a name becomes the basin of
    a bathroom or kitchen that has none, and the stove of a kitchen with a refrigerator but no
    stove. Showers stand in bathrooms only.

    Args:
        objects: Objects of one room.
        names: Their names and probabilities.
    """
    result = list(names)
    bathroom = _has(names, BATHROOM, SURE)
    cooks = _has(names, KITCHEN, SURE)
    kitchen = not bathroom and (cooks or _has(names, CUPBOARDS))
    for number, (name, sure) in enumerate(names):
        if name == "shower" and not bathroom and not _is_labelled(objects[number]):
            result[number] = (CLASS_DISPLAY_NAMES[objects[number].class_id], sure)
        if kitchen and name in IN_KITCHENS:
            result[number] = (IN_KITCHENS[name], sure)
    if bathroom and not _has(result, BASINS):
        _give(result, "washbasin", objects, _washstand)
    if kitchen and not _has(result, BASINS):
        _give(result, "sink", objects, _sink_counter)
    if kitchen and cooks and not _has(result, STOVES):
        _give(result, "stove", objects, _stove)
    return result


def _has(names: Named, wanted: Sequence[str], least: float = 0.0) -> bool:
    return any(name in wanted and sure >= least for name, sure in names)


def _is_labelled(item: ObjectTraits) -> bool:
    """Return whether label images that state names vote for the object."""
    return bool(item.votes[NYU40_COUNT:].any())


def _give(
    names: list[tuple[str, float]],
    name: str,
    objects: Sequence[ObjectTraits],
    score: Callable[[ObjectTraits], float],
) -> None:
    """Name the object with the highest score over 0; what is sure to be something else stays."""
    kept = (*BATHROOM, *KITCHEN, *BASINS)
    scores = [
        0.0 if names[number][0] in kept else score(item) for number, item in enumerate(objects)
    ]
    if max(scores, default=0.0) > 0:
        names[scores.index(max(scores))] = (name, CONFIDENCE)


def _washstand(item: ObjectTraits) -> float:
    """Return the votes for the top of a washstand, or 0 for what is none."""
    return _votes_for_top(item, ("counter", "sink"), TOP_SHARE)


def _sink_counter(item: ObjectTraits) -> float:
    """Return the votes for the sink of a counter, or 0 for what has none."""
    return _votes_for_top(item, ("sink",), SINK_SHARE)


def _votes_for_top(item: ObjectTraits, top: Sequence[str], least: float) -> float:
    share = _share(item, top)
    if not _fits(item, TOP_M, WIDTH_M) or _share(item, BODY) < BODY_SHARE or share < least:
        return 0.0
    return share * item.vote_count


def _stove(item: ObjectTraits) -> float:
    """Return the share of the votes for a stove, or 0 for what is none."""
    share = _share(item, ("other structure",))
    return share if _fits(item, STOVE_TOP_M, STOVE_WIDTH_M) and share >= STOVE_SHARE else 0.0


def _fits(item: ObjectTraits, top_m: tuple[float, float], width_m: tuple[float, float]) -> bool:
    high_m, across = item.bottom_m + item.size_m[2], max(item.size_m[:2])
    return top_m[0] <= high_m <= top_m[1] and width_m[0] <= across <= width_m[1]


def _share(item: ObjectTraits, classes: Sequence[str]) -> float:
    ids = nyu40_names()
    return float(class_votes(item.votes)[[ids[name] - 1 for name in classes]].sum())
