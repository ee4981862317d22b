"""Parameters of stereo, with the reason for each value."""

from dataclasses import dataclass

from world2minecraft.core.parameters import fact_by_name, parameter


@dataclass(frozen=True)
class StereoParameters:
    """Parameters of multi-view stereo (docs/explanation/stereo.md).

    Attributes:
        width_px: Width in pixels that photos are downscaled to.
        planes: Number of depth planes, evenly spaced in inverse depth.
        neighbours: Number of photos compared with each photo.
        best_of: Number of best-matching neighbours that count at each pixel; others may be
            occluded.
        angle_deg: Ideal angle between the rays of two photos.
        window_px: Width of the square matching window, an odd number.
        noise: Grey levels below which variation is not texture.
        small_step: Cost of a change by one plane between neighbouring pixels, for matching costs
            from 0 to 254.
        large_step: Cost of a larger change between neighbouring pixels.
        guide_cost: Cost of a distance of two or more planes from a sparse point.
        agreeing: Minimum number of photos that confirm a depth; confidence grows up to four.
        agreement: Maximum relative difference of depths that count as equal.
        island_share: Minimum size of a connected region of depth, as a share of the image.
        island_step: Maximum relative difference of neighbouring depths in a connected region.
        network_alone: Whether to skip stereo and use the depth predicted by the ``--depth``
            network.
    """

    width_px: int = parameter(
        320,
        unit="px",
        origin="twice the width takes six times as long, with larger errors",
        limits=(32, 2000),
    )
    planes: int = parameter(
        64,
        unit="planes",
        origin="96 planes take 50 % longer, with the same result",
        limits=(8, 254),
    )
    neighbours: int = parameter(
        12,
        unit="photos",
        origin="with 8 neighbours and best_of 4, 1 % more occupied cells were reported as free",
        limits=(1, 32),
    )
    best_of: int = parameter(6, unit="photos", origin="measured with neighbours", limits=(1, 32))
    angle_deg: float = parameter(
        4.0, unit="degrees", origin="9 degrees increase the error by a third", limits=(0.1, 60)
    )
    window_px: int = parameter(9, unit="px", origin="docs/results/photos.md", limits=(3, 15))
    noise: float = parameter(
        4.0, unit="grey levels", origin="docs/results/photos.md", limits=(0, 100)
    )
    small_step: float = parameter(20.0, unit="cost", origin="not recorded", limits=(0, 10_000))
    large_step: float = parameter(
        240.0, unit="cost", origin="docs/results/photos.md", limits=(0, 10_000)
    )
    guide_cost: float = parameter(
        120.0, unit="cost", origin="docs/results/photos.md", limits=(0, 254)
    )
    agreeing: int = parameter(1, unit="photos", origin="docs/results/photos.md", limits=(1, 32))
    agreement: float = parameter(
        0.03, unit="share", origin="docs/results/photos.md", limits=(1e-4, 0.5)
    )
    island_share: float = parameter(
        0.003,
        unit="share",
        origin="almost half of the wrong depth was in isolated regions",
        limits=(0, 0.5),
    )
    island_step: float = parameter(
        0.01, unit="share", origin="measured with island_share", limits=(1e-4, 0.5)
    )
    network_alone: bool = parameter(False)

    def __post_init__(self):
        for name, (least, most) in fact_by_name(self, "limits").items():
            if not least <= getattr(self, name) <= most:
                raise ValueError(
                    f"{name} must be from {least} to {most}, got {getattr(self, name)}"
                )
        if self.window_px % 2 == 0:
            raise ValueError(f"window_px must be odd, got {self.window_px}")
