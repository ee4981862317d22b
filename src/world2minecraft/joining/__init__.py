"""Several finished runs become one home: rooms set beside each other by their doors.

``join`` reads, places, merges, writes and builds; ``place_runs`` and ``merged`` are its pure parts.
"""

from world2minecraft.joining.homes import join, read_runs
from world2minecraft.joining.merging import Home, merged
from world2minecraft.joining.moving import Move, Run, moved
from world2minecraft.joining.placing import Placed, parse_place, place_runs

__all__ = [
    "Home",
    "Move",
    "Placed",
    "Run",
    "join",
    "merged",
    "moved",
    "parse_place",
    "place_runs",
    "read_runs",
]
