"""How frames are registered: every number that decides it, and where it comes from."""

from dataclasses import dataclass, replace
from typing import Any


@dataclass(frozen=True)
class RegisterParameters:
    """How poses and depth scales are refined against the map.

    passes: rounds of "who sees the same surface" and "move all frames"; 0 leaves the scan as it
        is. After five a generated room's poses moved by under 0.1 mm.
    cell_m: width of a surfel; a bit of surface that may be taken for flat.
    jitter_m, jitter_deg: how far poses are off, one sigma an axis, until the scan tells better.
    scale_sigma: how far depth scales are off, likewise; 0 never touches the depth.
    least_scale_sigma: a spread below this is no fault of the depth but of what is taken for flat.
        Of generated scans without any, 0.1 % was found.
    held_share: the part of the surface that only judges.
    """

    passes: int = 5
    cell_m: float = 0.10
    jitter_m: float = 0.008
    jitter_deg: float = 0.3
    scale_sigma: float = 0.03
    least_scale_sigma: float = 0.003
    held_share: float = 0.15

    def __post_init__(self):
        if not 0 <= self.passes <= 20:
            raise ValueError(f"passes must be 0 to 20, not {self.passes}")
        for name in ("cell_m", "jitter_m", "jitter_deg"):
            if not getattr(self, name) > 0:
                raise ValueError(f"{name} must be above 0, not {getattr(self, name)}")
        for name in ("scale_sigma", "least_scale_sigma", "held_share"):
            if not 0 <= getattr(self, name) < 0.5:
                raise ValueError(f"{name} must be 0 to 0.5, not {getattr(self, name)}")

    def suited(self, depth_kind: str) -> "RegisterParameters":
        """Return the parameters for another kind of depth.

        Poses that stereo was computed from meet to fractions of a pixel already, and what looks at
        a mesh stands where it says: only a sensor's frames are moved. A network's depth is off by
        some per cent, each frame its own way, and is evened out where poses stand.
        """
        if depth_kind == "network":
            default = RegisterParameters()
            untouched = {
                k: v for k, v in OF_NETWORKS.items() if getattr(self, k) == getattr(default, k)
            }
            return replace(self, **untouched)
        return self if depth_kind == "sensor" else replace(self, passes=0)


# Poses are those of photos; scales differ by what monocular networks are known for.
OF_NETWORKS: dict[str, Any] = {"jitter_m": 0.002, "jitter_deg": 0.05, "scale_sigma": 0.05}
