"""How views are fused: every number that decides it, and where it comes from."""

from dataclasses import dataclass, replace
from typing import Any

from world2minecraft.core.errors import UsageError

_ABOVE_0 = ("hit_log_odds", "limit_log_odds", "pose_m", "sure_m")
_NOT_BELOW_0 = (
    "network_weight",
    "nudge_m",
    "clear_m",
    "clear_growth",
    "sigma_m",
    "sigma_growth",
    "pose_growth",
    "merge_m",
    "merge_sigmas",
)


@dataclass(frozen=True)
class FuseParameters:
    """How views are fused. docs/fusion.md tells what each figure does to generated rooms.

    voxel_m: the paper's cell, 0.08 m.
    hit_log_odds, free_log_odds, limit_log_odds: a trial on a synthetic room.
    network_weight: what the log-odds of a network's grid count. At 0.05 a view that is sure adds
        or takes 0.2: it carves as one ray does, and a look of depth at a surface outweighs four.
    nudge_m: a surface point belongs to the cell of the matter behind it, this far along its
        normal: half of the 2 cm sub-cell by which truth is counted.
    min_share: the part of a cell's face that a view must see of it: at 0.05 edges grow, at 0.15
        chair legs go.
    min_points: a single point is noise.
    clear_m, clear_growth: rays stop ``clear_m + clear_growth * distance`` before their point, so
        that noise does not eat the surface.
    solid_share: a cell is occupied where its surface leaves this share of it solid: 4 of 64
        sub-cells, the rule by which SSCNet made its labels.
    sigma_m, sigma_growth: the standard deviation of depth at z metres is
        ``sigma_m + sigma_growth * (z - 0.4)^2``, what structured-light cameras are known for.
    pose_m, pose_growth: that of a view's pose as seen at z metres: ``pose_m + pose_growth * z``;
        0.0015 is 0.09 degrees.
    merge_m, merge_sigmas: the points of two neighbouring cells along their normal are one surface
        where their planes lie nearer than ``merge_m + merge_sigmas * sigma``.
    sure_m: how far its surface must lie from the rule's edge for one log-odd of certainty.
    """

    voxel_m: float = 0.08
    hit_log_odds: float = 0.9
    free_log_odds: float = -0.2
    limit_log_odds: float = 6.0
    network_weight: float = 0.05
    nudge_m: float = 0.01
    min_share: float = 0.1
    min_points: int = 2
    clear_m: float = 0.075
    clear_growth: float = 0.0
    solid_share: float = 0.0625
    sigma_m: float = 0.0012
    sigma_growth: float = 0.0019
    pose_m: float = 0.003
    pose_growth: float = 0.0015
    merge_m: float = 0.016
    merge_sigmas: float = 3.0
    sure_m: float = 0.003

    def __post_init__(self):
        for name in _ABOVE_0:
            if not getattr(self, name) > 0:
                raise UsageError(f"fuse.{name} must be above 0, not {getattr(self, name):g}")
        for name in _NOT_BELOW_0:
            if not getattr(self, name) >= 0:
                raise UsageError(f"fuse.{name} must be 0 or more, not {getattr(self, name):g}")
        if not self.free_log_odds <= 0:
            raise UsageError(f"fuse.free_log_odds must be 0 or less, not {self.free_log_odds:g}")
        if self.min_points < 1:
            raise UsageError(f"fuse.min_points must be 1 or more, not {self.min_points}")
        for name in ("min_share", "solid_share"):
            if not 0 <= getattr(self, name) <= 1:
                given = getattr(self, name)
                raise UsageError(f"fuse.{name} must lie between 0 and 1, not {given:g}")

    def suited(self, depth_kind: str) -> "FuseParameters":
        """Return the parameters for another kind of depth; what was chosen by hand stays.

        Depth from stereo errs more with distance than a sensor's, and by whole patches; so does
        that of a network.
        """
        default = FuseParameters(self.voxel_m)
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
