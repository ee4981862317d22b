"""Export to R2R-style JSON: paths over named viewpoints, and the navigation graph of each scene.

The output folder contains::

    R2R_SPLIT.json         [{distance, scan, path_id, path, heading, instructions, ...}]
    connectivity/SCENE_connectivity.json   viewpoints, poses and neighbours, for R2R's scripts
    viewpoints.json        the position and the images of each viewpoint

A viewpoint is a position where an image was taken. Turns on the spot share one viewpoint. As in
R2R, heading 0 is north, and headings increase clockwise in radians. Positions are in metres from
the world's origin, with x east, y north and z up.
"""

import math
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.files import write_json
from world2minecraft.navigation.exporters.options import ExportedFile
from world2minecraft.navigation.types import SPLITS, Keyframe, Trajectory

EYE_M = 1.5  # Height of a camera in R2R, whose evaluation does not use it.
_Place = tuple[float, float, float]


def write_r2r(root: Path, trajectories: Sequence[Trajectory]) -> list[ExportedFile]:
    """Write trajectories as R2R paths, and return the written files.

    Raises:
        OutputError: If the folder cannot be written.
    """
    graph = _Graph()
    entries: dict[str, list[dict[str, Any]]] = {split: [] for split in SPLITS}
    for number, one in enumerate(trajectories, 1):
        path = graph.add(one)
        if one.instructions:
            entries[one.split].append(_entry(one, number, path))
    written = []
    for split, rows in entries.items():
        if rows:
            write_json(root / f"R2R_{split}.json", rows)
            written.append(ExportedFile(f"R2R_{split}", len(rows)))
    for scene in graph.scenes:
        write_json(root / "connectivity" / f"{scene}_connectivity.json", graph.connectivity(scene))
    write_json(root / "viewpoints.json", graph.viewpoints())
    return written


def heading(yaw_deg: float) -> float:
    """Convert the game's yaw in degrees to R2R's heading in radians, 0 to 2 pi.

    Example:
        >>> heading(180.0), round(heading(-90.0), 4)  # North, east.
        (0.0, 1.5708)
    """
    return math.radians((yaw_deg + 180.0) % 360.0)


def _entry(one: Trajectory, number: int, path: list[str]) -> dict[str, Any]:
    return {
        "distance": round(one.path_m, 4),
        "scan": one.scene_id,
        "path_id": number,
        "path": path,
        "heading": round(heading(one.keyframes[0].stance.yaw_deg), 6),
        "instructions": [instruction.text for instruction in one.instructions],
        "trajectory_id": one.trajectory_id,
    }


class _Graph:
    """A navigation graph of viewpoints by scene and position."""

    def __init__(self):
        self.scenes: dict[str, dict[_Place, dict[str, Any]]] = {}
        self._edges: dict[str, set[tuple[int, int]]] = {}

    def add(self, one: Trajectory) -> list[str]:
        """Add the viewpoints of a trajectory, and return their IDs in order."""
        views = self.scenes.setdefault(one.scene_id, {})
        edges = self._edges.setdefault(one.scene_id, set())
        way: list[int] = []
        for keyframe in one.keyframes:
            view = self._view(one, keyframe)
            view["images"].append(
                {"image": keyframe.image, "heading": round(heading(keyframe.stance.yaw_deg), 6)}
            )
            if not way or way[-1] != view["number"]:
                way.append(view["number"])
        edges.update((min(pair), max(pair)) for pair in pairwise(way))
        names = [view["id"] for view in views.values()]
        return [names[number] for number in way]

    def _view(self, one: Trajectory, keyframe: Keyframe) -> dict[str, Any]:
        views, stance = self.scenes[one.scene_id], keyframe.stance
        metres = np.array([stance.x, -stance.z, stance.y]) * one.metres_per_block
        x, y, z = (float(value) for value in np.round(metres, 2) + 0.0)
        name = f"{one.scene_id}_{len(views):04}"
        fresh = {"id": name, "number": len(views), "position": [x, y, z], "images": []}
        return views.setdefault((x, y, z), fresh)

    def connectivity(self, scene: str) -> list[dict[str, Any]]:
        """Return a scene's graph in the format of R2R's ``*_connectivity.json``."""
        views, edges = list(self.scenes[scene].values()), self._edges[scene]
        rows = []
        for view in views:
            pose = np.eye(4)
            pose[:3, 3] = np.add(view["position"], [0, 0, EYE_M])
            number = view["number"]
            joined = [(min(number, n), max(number, n)) in edges for n in range(len(views))]
            rows.append(
                {
                    "image_id": view["id"],
                    "pose": pose.ravel().tolist(),
                    "included": True,
                    "visible": joined,
                    "unobstructed": joined,
                    "height": EYE_M,
                }
            )
        return rows

    def viewpoints(self) -> dict[str, dict[str, Any]]:
        """Return the position and images of each viewpoint by its ID."""
        return {
            view["id"]: {"scan": scene, "position": view["position"], "images": view["images"]}
            for scene, views in self.scenes.items()
            for view in views.values()
        }
