"""The parameters of the fusion and the reasons for their defaults."""

from dataclasses import dataclass, replace
from typing import Any

from world2minecraft.core.errors import UsageError
from world2minecraft.core.parameters import names_where, parameter

ABOVE_0, NOT_BELOW_0, SHARE = "above 0", "0 or more", "0 to 1"


@dataclass(frozen=True)
class FusionParameters:
    """Parameters of the fusion; docs/results/fusion.md has their effects on generated rooms.

    voxel_m: Cell size.
    hit_log_odds: Log-odds added to a cell by a view that sees a surface in it.
    free_log_odds: Log-odds added to a cell by a ray that crosses it; must not be positive.
    limit_log_odds: Maximum absolute value of the log-odds of a cell.
    network_weight: Factor on the log-odds of a network's grid.
    nudge_m: Distance behind a surface point, along its normal, at which the point is assigned to a
        cell.
    min_share: Minimum share of a cell's face that a view must see to count as a hit.
    min_points: Minimum number of points in a cell for a view to count as a hit.
    clear_m, clear_growth: Rays stop ``clear_m + clear_growth * distance`` in front of their point,
        so that noise does not remove the surface.
    solid_share: Minimum solid share of a cell, behind its surface, for the cell to be occupied.
    sigma_m, sigma_growth: The standard deviation of depth at z metres is
        ``sigma_m + sigma_growth * (z - 0.4)^2``.
    pose_m, pose_growth: The standard deviation of a surface point at z metres due to the camera
        pose is ``pose_m + pose_growth * z``.
    merge_m, merge_sigmas: Points of two neighbouring cells belong to one surface if their planes
        are closer than ``merge_m + merge_sigmas * sigma``.
    sure_m: Distance of a surface from the decision threshold that corresponds to a log-odds of 1.
    """

    voxel_m: float = parameter(
        0.08, unit="m", origin="the paper's cell", typed="--voxel 0.08", copy_of="voxel_m"
    )
    hit_log_odds: float = parameter(
        0.9, unit="log-odds", origin="tuned on a synthetic room", bounds=ABOVE_0
    )
    free_log_odds: float = parameter(-0.2, unit="log-odds", origin="tuned on a synthetic room")
    limit_log_odds: float = parameter(
        6.0, unit="log-odds", origin="tuned on a synthetic room", bounds=ABOVE_0
    )
    network_weight: float = parameter(
        0.05,
        unit="share",
        origin="a fully confident view changes the log-odds by 0.2, as much as one ray; one "
        "measured surface outweighs four such views",
        bounds=NOT_BELOW_0,
    )
    nudge_m: float = parameter(
        0.01,
        unit="m",
        origin="half of a 2 cm sub-cell of the ground truth",
        bounds=NOT_BELOW_0,
    )
    min_share: float = parameter(
        0.1,
        unit="share",
        origin="at 0.05 edges grow, at 0.15 chair legs vanish",
        bounds=SHARE,
    )
    min_points: int = parameter(2, unit="points", origin="a single point is noise")
    clear_m: float = parameter(
        0.075, unit="m", origin="sensor noise in front of a surface", bounds=NOT_BELOW_0
    )
    clear_growth: float = parameter(
        0.0, unit="m per m", origin="sensor noise is covered by clear_m", bounds=NOT_BELOW_0
    )
    solid_share: float = parameter(
        0.0625,
        unit="share",
        origin="4 of 64 sub-cells, as in the labels of SSCNet",
        bounds=SHARE,
    )
    sigma_m: float = parameter(
        0.0012, unit="m", origin="published for structured-light cameras", bounds=NOT_BELOW_0
    )
    sigma_growth: float = parameter(
        0.0019, unit="1/m", origin="published for structured-light cameras", bounds=NOT_BELOW_0
    )
    pose_m: float = parameter(
        0.003, unit="m", origin="pose error after registration", bounds=ABOVE_0
    )
    pose_growth: float = parameter(
        0.0015, unit="m per m", origin="a rotation error of 0.09 degrees", bounds=NOT_BELOW_0
    )
    merge_m: float = parameter(0.016, unit="m", origin="docs/results/fusion.md", bounds=NOT_BELOW_0)
    merge_sigmas: float = parameter(
        3.0, unit="sigmas", origin="covers nearly all noise of a surface", bounds=NOT_BELOW_0
    )
    sure_m: float = parameter(0.003, unit="m", origin="docs/explanation/fusion.md", bounds=ABOVE_0)

    def __post_init__(self):
        for name in names_where(self, bounds=ABOVE_0):
            if not getattr(self, name) > 0:
                raise UsageError(f"fuse.{name} must be above 0, got {getattr(self, name):g}")
        for name in names_where(self, bounds=NOT_BELOW_0):
            if not getattr(self, name) >= 0:
                raise UsageError(f"fuse.{name} must be 0 or more, got {getattr(self, name):g}")
        if not self.free_log_odds <= 0:
            raise UsageError(f"fuse.free_log_odds must be 0 or less, got {self.free_log_odds:g}")
        if self.min_points < 1:
            raise UsageError(f"fuse.min_points must be 1 or more, got {self.min_points}")
        for name in names_where(self, bounds=SHARE):
            if not 0 <= getattr(self, name) <= 1:
                given = getattr(self, name)
                raise UsageError(f"fuse.{name} must be between 0 and 1, got {given:g}")

    def suited(self, depth_kind: str) -> "FusionParameters":
        """Return the parameters for another kind of depth; changed parameters are kept.

        Depth from stereo or from a network has larger errors at a distance than measured depth, and
        whole patches are affected.
        """
        default = FusionParameters(self.voxel_m)
        changes = BY_DEPTH_KIND.get(depth_kind, {})
        untouched = {k: v for k, v in changes.items() if getattr(self, k) == getattr(default, k)}
        return replace(self, **untouched)


_COMPUTED: dict[str, Any] = {
    "free_log_odds": -0.25,
    "min_share": 0.08,
    "clear_m": 0.12,
    "clear_growth": 0.03,
    "sigma_m": 0.004,
    "sigma_growth": 0.004,
}
BY_DEPTH_KIND: dict[str, dict[str, Any]] = {"stereo": _COMPUTED, "network": _COMPUTED}
