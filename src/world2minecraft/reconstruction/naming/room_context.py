"""What the other objects of a room say of an object: the cabinet beside a toilet is a washbasin.

The segmentation network calls the body of a washstand a cabinet and its top a counter, as NYUv2's
annotators do, so votes alone never name one.
"""

from collections.abc import Sequence

from world2minecraft.core.vocabulary import nyu40_names
from world2minecraft.reconstruction.naming.name_model import ObjectTraits

WASHBASIN = "washbasin"
BATHROOM = ("toilet", "bathtub", "shower")
BASINS = ("washbasin", "sink")
SURE = 0.6  # Of the name of the object that makes the room a bathroom.
CONFIDENCE = 0.7  # Of the washbasin: 14 bathrooms of NYUv2 and 20 generated ones, docs/names.md.
BODY = ("cabinet", "counter", "sink", "dresser", "night stand", "other furniture")
TOP = ("counter", "sink")
BODY_SHARE, TOP_SHARE = 0.6, 0.01  # Of the votes of a washstand.
TOP_M, WIDTH_M = (0.6, 1.2), (0.35, 2.2)


def find_washbasin(
    objects: Sequence[ObjectTraits], names: Sequence[tuple[str, float]]
) -> int | None:
    """Return the object that is the washbasin of a bathroom without one, or None.

    It is as high as a washstand, and most of its votes are for cabinets and what
    is on them. Of several, it is the one with most votes for counters and sinks.

    Args:
        objects: Objects of one room.
        names: Their names and probabilities.
    """
    if any(name in BASINS for name, _ in names):
        return None
    if not any(name in BATHROOM and sure >= SURE for name, sure in names):
        return None
    ids = nyu40_names()
    body, top = ([ids[name] - 1 for name in part] for part in (BODY, TOP))
    best, most = None, 0.0
    for number, item in enumerate(objects):
        across = max(item.size_m[:2])
        high_m = item.bottom_m + item.size_m[2]
        fits = TOP_M[0] <= high_m <= TOP_M[1] and WIDTH_M[0] <= across <= WIDTH_M[1]
        if not fits or item.votes[body].sum() < BODY_SHARE:
            continue
        share = float(item.votes[top].sum())
        if share >= TOP_SHARE and share * item.vote_count > most:
            best, most = number, share * item.vote_count
    return best
