"""How frames are registered: every number that decides it, and where it comes from."""

from dataclasses import dataclass, replace
from typing import Any

from world2minecraft.core.parameters import names_where, parameter

ABOVE_0, BELOW_HALF = "above 0", "0 to 0.5"


@dataclass(frozen=True)
class RegistrationParameters:
    """How poses and depth scales are refined against the map.

    passes: rounds of "who sees the same surface" and "move all frames"; 0 leaves the scan as it
        is.
    cell_m: width of a surfel; a bit of surface that may be taken for flat.
    jitter_m, jitter_deg: how far poses are off, one sigma an axis, until the scan tells better.
    scale_sigma: how far depth scales are off, likewise; 0 never touches the depth.
    least_scale_sigma: a spread below this is no fault of the depth but of what is taken for flat.
    held_share: the part of the surface that only judges.
    """

    passes: int = parameter(5, origin="after five a generated room's poses moved by under 0.1 mm")
    cell_m: float = parameter(0.10, unit="m", origin="flat within a sensor's noise", bounds=ABOVE_0)
    jitter_m: float = parameter(
        0.008, unit="m", origin="a first guess; docs/alignment.md", bounds=ABOVE_0
    )
    jitter_deg: float = parameter(
        0.3, unit="degrees", origin="a first guess; docs/alignment.md", bounds=ABOVE_0
    )
    scale_sigma: float = parameter(
        0.03, unit="share", origin="a first guess; docs/alignment.md", bounds=BELOW_HALF
    )
    least_scale_sigma: float = parameter(
        0.003,
        unit="share",
        origin="of generated scans without any, 0.1 % was found",
        bounds=BELOW_HALF,
    )
    held_share: float = parameter(0.15, unit="share", origin="docs/alignment.md", bounds=BELOW_HALF)

    def __post_init__(self):
        if not 0 <= self.passes <= 20:
            raise ValueError(f"passes must be 0 to 20, got {self.passes}")
        for name in names_where(self, bounds=ABOVE_0):
            if not getattr(self, name) > 0:
                raise ValueError(f"{name} must be above 0, got {getattr(self, name)}")
        for name in names_where(self, bounds=BELOW_HALF):
            if not 0 <= getattr(self, name) < 0.5:
                raise ValueError(f"{name} must be 0 to 0.5, got {getattr(self, name)}")

    def suited(self, depth_kind: str) -> "RegistrationParameters":
        """Return the parameters for another kind of depth.

        Poses that stereo was computed from meet to fractions of a pixel already, and what looks at
        a mesh stands where it says: only a sensor's frames are moved. A network's depth is off by
        some per cent, each frame its own way, and is evened out where poses stand.
        """
        if depth_kind == "network":
            default = RegistrationParameters()
            untouched = {
                k: v for k, v in OF_NETWORKS.items() if getattr(self, k) == getattr(default, k)
            }
            return replace(self, **untouched)
        return self if depth_kind == "sensor" else replace(self, passes=0)


# Poses are those of photos; scales differ by what monocular networks are known for.
OF_NETWORKS: dict[str, Any] = {"jitter_m": 0.002, "jitter_deg": 0.05, "scale_sigma": 0.05}
