"""Move a finished run by quarter turns and whole cells, exactly and without resampling."""

from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.core.coordinates import apply, rotation_about_z, turn_grid
from world2minecraft.core.types import Layout, ObjectInstance, OccupancyGrid, Placement

DECIMALS = 4  # As in the files of a run.


@dataclass(frozen=True)
class Move:
    """A rotation about the origin of the frame by quarter turns, then a shift by whole cells."""

    quarter_turns: int = 0
    cells: tuple[int, int, int] = (0, 0, 0)

    def __post_init__(self):
        if self.quarter_turns not in (0, 1, 2, 3):
            raise ValueError(f"quarter_turns must be 0 to 3, got {self.quarter_turns}")

    def transform(self, voxel_m: float) -> np.ndarray:
        """Return the 4x4 transform from the old to the new frame."""
        result = rotation_about_z(90.0 * self.quarter_turns)
        result[:3, 3] = np.array(self.cells) * voxel_m
        return result

    def after(self, first: "Move") -> "Move":
        """Return the move that applies ``first`` and then this move."""
        turn = rotation_about_z(90.0 * self.quarter_turns)[:3, :3]
        cells = np.rint(turn @ np.array(first.cells)).astype(int) + np.array(self.cells)
        return Move((self.quarter_turns + first.quarter_turns) % 4, tuple(cells.tolist()))


@dataclass(frozen=True, eq=False)
class Run:
    """The result of a finished run: its grid, objects, placements and rooms."""

    name: str
    grid: OccupancyGrid
    instances: tuple[ObjectInstance, ...]
    placements: tuple[Placement, ...]
    layouts: tuple[Layout, ...]


def move_run(run: Run, move: Move) -> Run:
    """Transform a run by a move."""
    voxel_m = run.grid.voxel_m
    to_new = move.transform(voxel_m)
    return replace(
        run,
        grid=move_grid(run.grid, move),
        instances=tuple(
            replace(
                one,
                center_m=_carried(to_new, one.center_m),
                yaw_deg=(one.yaw_deg + 90.0 * move.quarter_turns) % 360,
                cells=_turned_cells(one.cells, run.grid.shape, move.quarter_turns),
            )
            for one in run.instances
        ),
        placements=tuple(
            replace(
                one,
                center_m=_carried(to_new, one.center_m),
                quarter_turns=(one.quarter_turns + move.quarter_turns) % 4,
                alternatives=tuple(
                    replace(other, quarter_turns=(other.quarter_turns + move.quarter_turns) % 4)
                    for other in one.alternatives
                ),
            )
            for one in run.placements
        ),
        layouts=tuple(move_layout(one, to_new) for one in run.layouts),
    )


def move_grid(grid: OccupancyGrid, move: Move) -> OccupancyGrid:
    """Rotate and shift the cells of a grid."""
    first = np.rint(grid.origin_m / grid.voxel_m).astype(int)
    for _ in range(move.quarter_turns):
        # (x, y) goes to (-y, x): the new minimum corner is that of the old maximum of y.
        shape = grid.shape
        first = np.array([-(first[1] + shape[1]), first[0], first[2]])
        grid = replace(grid, **{name: _once(getattr(grid, name)) for name in _ARRAYS})
    origin = np.round((first + np.array(move.cells)) * grid.voxel_m, 9)
    return replace(grid, origin_m=origin)


def move_layout(layout: Layout, to_new: np.ndarray) -> Layout:
    """Transform a room by a 4x4 quarter turn and shift."""
    openings = tuple(
        replace(one, start_m=_flat(to_new, one.start_m), end_m=_flat(to_new, one.end_m))
        for one in layout.openings
    )
    polygon = np.column_stack([layout.floor_polygon_m, np.zeros(len(layout.floor_polygon_m))])
    turn_deg = float(np.degrees(np.arctan2(to_new[1, 0], to_new[0, 0])))
    return replace(
        layout,
        floor_polygon_m=_carried(to_new, polygon)[:, :2],
        openings=openings,
        objects=tuple(
            replace(
                one,
                center_m=_carried(to_new, one.center_m),
                yaw_deg=round(one.yaw_deg + turn_deg, 6) % 360,
            )
            for one in layout.objects
        ),
        floor_z_m=round(layout.floor_z_m + float(to_new[2, 3]), DECIMALS),
    )


_ARRAYS = ("labels", "confidence", "colour", "source", "instance")


def _once(values: np.ndarray) -> np.ndarray:
    return np.ascontiguousarray(turn_grid(values, 1))


def _turned_cells(cells: np.ndarray, shape: tuple[int, int, int], turns: int) -> np.ndarray:
    across = [shape[0], shape[1]]
    for _ in range(turns):
        cells = np.column_stack([across[1] - 1 - cells[:, 1], cells[:, 0], cells[:, 2]])
        across.reverse()
    return cells.astype(np.int32)


def _carried(to_new: np.ndarray, points_m: np.ndarray) -> np.ndarray:
    return np.round(apply(to_new, points_m), DECIMALS)


def _flat(to_new: np.ndarray, point_m: np.ndarray) -> np.ndarray:
    return _carried(to_new, np.array([*point_m, 0.0]))[:2]
