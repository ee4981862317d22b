"""Join several finished runs into one home by placing rooms next to each other at their doors.

``join`` reads, places, merges, writes and builds runs; ``place_runs`` and ``merge_runs`` are its
parts without file access.
"""

from world2minecraft.reconstruction.homes.join_runs import join, read_runs
from world2minecraft.reconstruction.homes.merged_run import Home, merge_runs
from world2minecraft.reconstruction.homes.moved_run import Move, Run, move_run
from world2minecraft.reconstruction.homes.room_placement import Placed, parse_place, place_runs

__all__ = [
    "Home",
    "Move",
    "Placed",
    "Run",
    "join",
    "merge_runs",
    "move_run",
    "parse_place",
    "place_runs",
    "read_runs",
]
