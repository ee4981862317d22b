"""The kinds of rooms: how large they are, what their floor is, what recipe furnishes them."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from world2minecraft.procgen.rooms import daily_rooms, side_rooms
from world2minecraft.procgen.rooms.colour_scheme import Style
from world2minecraft.procgen.rooms.furniture_model import whole
from world2minecraft.procgen.rooms.placement import Plan, Rug


@dataclass(frozen=True)
class Kind:
    """A kind of room: the range of its inner sides in metres, its floor, and its recipe."""

    short_m: tuple[float, float]
    long_m: tuple[float, float]
    floor: str  # planks or tiles
    furnish: "Callable[[Plan, Style], tuple[Rug, ...] | None]"


KINDS: dict[str, Kind] = {
    "living": Kind((3.6, 4.4), (4.4, 5.4), "planks", daily_rooms.furnish_living),
    "bed": Kind((3.2, 3.8), (3.8, 4.6), "planks", daily_rooms.furnish_bed),
    "kitchen": Kind((2.9, 3.5), (3.7, 4.6), "tiles", daily_rooms.furnish_kitchen),
    "dining": Kind((3.4, 4.0), (4.2, 5.0), "planks", daily_rooms.furnish_dining),
    "study": Kind((3.0, 3.6), (3.6, 4.4), "planks", daily_rooms.furnish_study),
    "bathroom": Kind((1.9, 2.4), (2.5, 3.3), "tiles", side_rooms.furnish_bathroom),
    "hall": Kind((1.6, 2.1), (3.2, 4.8), "tiles", side_rooms.furnish_hall),
    "office": Kind((3.2, 4.0), (4.0, 5.2), "planks", side_rooms.furnish_office),
    "children": Kind((2.8, 3.4), (3.4, 4.4), "planks", side_rooms.furnish_children),
}


BASE_KINDS = ("bed", "dining", "kitchen", "living", "study")


def random_size(kind: Kind, rng: np.random.Generator) -> tuple[float, float, float]:
    """Return inner sides and height of a room of a kind, multiples of 2 cm."""
    short, long = whole(rng.uniform(*kind.short_m)), whole(rng.uniform(*kind.long_m))
    height = whole(rng.uniform(2.4, 2.7))
    return (long, short, height) if rng.random() < 0.6 else (short, long, height)
