"""Where an agent has been, in words that it could have counted itself: steps ahead, to the side.

Directions are those of the start: x metres ahead of it, and to its right. Nothing of the scene's
map is in it; a model that reads it knows what odometry knows.
"""

import math
from collections.abc import Sequence

from world2minecraft.navigation.values import Stance

MOST_PLACES = 12  # Of a map in words; those between are left out evenly.
LEAST_M = 0.5  # Places nearer to the last one are the same place.


def relative_m(start: Stance, stance: Stance, metres_per_block: float) -> tuple[float, float]:
    """Return how far a stance is ahead of the start and to its right, metres.

    Example:
        >>> relative_m(Stance(0, 64, 0, 90), Stance(-4, 64, 0, 0), 0.25)  # Yaw 90 looks west.
        (1.0, 0.0)
    """
    yaw = math.radians(start.yaw_deg)
    x, z = stance.x - start.x, stance.z - start.z
    ahead = -math.sin(yaw) * x + math.cos(yaw) * z
    right = -math.cos(yaw) * x - math.sin(yaw) * z
    return (
        round(ahead * metres_per_block, 2) + 0.0,
        round(right * metres_per_block, 2) + 0.0,
    )


def facing(start: Stance, stance: Stance) -> str:
    """Return where one looks, by the direction of the start.

    Example:
        >>> facing(Stance(0, 0, 0, 170), Stance(0, 0, 0, -100))
        '90 degrees right of the start'
    """
    turned = (stance.yaw_deg - start.yaw_deg + 180) % 360 - 180
    if abs(turned) < 0.5:
        return "as at the start"
    if abs(turned) > 179.5:
        return "back"
    return f"{abs(turned):.0f} degrees {'right' if turned > 0 else 'left'} of the start"


def trail_text(stances: Sequence[Stance], metres_per_block: float) -> str:
    """Return a map in words: the places that were visited, the last one where one stands."""
    start, here = stances[0], stances[-1]
    kept = [0]
    for number, stance in enumerate(stances):
        last = stances[kept[-1]]
        away = math.dist(stance.feet, last.feet) * metres_per_block
        if away >= LEAST_M:
            kept.append(number)
    if len(kept) > MOST_PLACES:
        last_index = len(kept) - 1
        kept = [kept[round(i * last_index / (MOST_PLACES - 1))] for i in range(MOST_PLACES)]
    lines = []
    for place, number in enumerate(kept):
        ahead, right = relative_m(start, stances[number], metres_per_block)
        lines.append(f"Place {place}: {_place(ahead, right)} (move {number})")
    ahead, right = relative_m(start, here, metres_per_block)
    lines.append(f"You are {_place(ahead, right)} and look {facing(start, here)}.")
    return "\n".join(lines)


def _place(ahead: float, right: float) -> str:
    if not ahead and not right:
        return "at the start"
    words = []
    if ahead:
        words.append(f"{abs(ahead):g} m {'ahead of' if ahead > 0 else 'behind'} the start")
    if right:
        words.append(f"{abs(right):g} m to its {'right' if right > 0 else 'left'}")
    return ", ".join(words)
