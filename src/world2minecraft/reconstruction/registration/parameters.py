"""The parameters of the registration and the reasons for their defaults."""

from dataclasses import dataclass, replace
from typing import Any

from world2minecraft.core.parameters import names_where, parameter

ABOVE_0, BELOW_HALF = "above 0", "0 to 0.5"


@dataclass(frozen=True)
class RegistrationParameters:
    """Parameters of the refinement of poses and depth scales.

    passes: Number of rounds of matching surfaces and moving all frames; 0 disables the
        registration.
    cell_m: Width of a surfel, a piece of surface that is assumed to be flat.
    jitter_m: Initial standard deviation of camera positions per axis; refined from the scan.
    jitter_deg: Initial standard deviation of camera rotations per axis; refined from the scan.
    scale_sigma: Initial standard deviation of the depth scale of a frame; 0 keeps the depth
        unchanged.
    least_scale_sigma: Spread of the depth scales below which the depth is not changed.
    held_share: Share of the surface that is held out to judge the result.
    """

    passes: int = parameter(
        5, origin="later passes move the poses of a generated room by less than 0.1 mm"
    )
    cell_m: float = parameter(
        0.10, unit="m", origin="surfaces of this width are flat within sensor noise", bounds=ABOVE_0
    )
    jitter_m: float = parameter(
        0.008, unit="m", origin="a first guess; docs/explanation/alignment.md", bounds=ABOVE_0
    )
    jitter_deg: float = parameter(
        0.3, unit="degrees", origin="a first guess; docs/explanation/alignment.md", bounds=ABOVE_0
    )
    scale_sigma: float = parameter(
        0.03, unit="share", origin="a first guess; docs/explanation/alignment.md", bounds=BELOW_HALF
    )
    least_scale_sigma: float = parameter(
        0.003,
        unit="share",
        origin="0.1 % is estimated for generated scans without scale errors",
        bounds=BELOW_HALF,
    )
    held_share: float = parameter(
        0.15, unit="share", origin="docs/explanation/alignment.md", bounds=BELOW_HALF
    )

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

        Poses that stereo is based on are precise to fractions of a pixel, and views of a mesh are
        exact, so only the frames of a sensor are moved. Depth from a network differs by some per
        cent in each frame and is scaled while the poses are kept.
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
