"""Parameters of structure from motion, with the reason for each value."""

from dataclasses import dataclass

from world2minecraft.core.parameters import fact_by_name, names_where, parameter

ABOVE_0 = "above 0"


@dataclass(frozen=True)
class SfmParameters:
    """Parameters of structure from motion. Pixel thresholds are for images 640 pixels wide.

    Attributes:
        working_px: Number of pixels of the image for feature extraction; smaller images are
            enlarged up to twice.
        most_features: Maximum number of features per photo, the largest first.
        strong: Number of largest features used to find similar photos.
        least_strong: Minimum number of matching strong features of similar photos.
        exhaustive: Maximum number of photos for which all pairs are compared; above it, each photo
            is compared with its neighbours in order and the photos with the most common visual
            words.
        partners: Number of most similar photos that a photo is fully matched with.
        neighbours: Number of following photos that a photo is fully matched with.
        least_matches: Minimum number of geometrically consistent matches between linked photos.
        good_px: Maximum reprojection error at which stated poses are kept unchanged.
        gates_px: Maximum reprojection errors of the refinement rounds.
        wide_px: Maximum reprojection error when stated poses are measured.
        outlier_px: Error above which a stated pose is wrong, if it also exceeds ``outlier_times``
            times the median.
        outlier_times: Multiple of the median error above which a stated pose is wrong, together
            with ``outlier_px``.
        seed: Random seed.
    """

    working_px: int = parameter(
        1_230_000,
        unit="px",
        origin=(
            "without enlargement, 640x480 gives half the points and an error of 0.8 px "
            "instead of 0.68"
        ),
        limits=(10_000, 10_000_000),
    )
    most_features: int = parameter(4000, unit="features", origin="not recorded", limits=(1, 20_000))
    strong: int = parameter(
        500,
        unit="features",
        origin="on the kitchen, 500 features find 99 % of the matching pairs at least_strong",
        limits=(1, 20_000),
    )
    least_strong: int = parameter(8, unit="features", origin="measured with strong")
    exhaustive: int = parameter(120, unit="photos", origin="not recorded", limits=(1, 20_000))
    partners: int = parameter(
        12,
        unit="photos",
        origin="on the kitchen, 12 gives the same model as all pairs, in half the time",
        limits=(1, 20_000),
    )
    neighbours: int = parameter(3, unit="photos", origin="not recorded")
    least_matches: int = parameter(20, unit="matches", origin="not recorded", limits=(1, 20_000))
    good_px: float = parameter(
        1.0,
        unit="px",
        origin="estimated: stereo at half resolution requires an error of about half a pixel",
        bounds=ABOVE_0,
    )
    gates_px: tuple[float, ...] = parameter(
        (12.0, 4.0, 2.0),
        unit="px",
        origin="a fourth round does not change the error on the kitchen",
    )
    wide_px: float = parameter(12.0, unit="px", origin="not recorded", bounds=ABOVE_0)
    outlier_px: float = parameter(8.0, unit="px", origin="not recorded", bounds=ABOVE_0)
    outlier_times: float = parameter(4.0, unit="times", origin="not recorded", bounds=ABOVE_0)
    seed: int = parameter(0, origin="arbitrary")

    def __post_init__(self):
        for name, (least, most) in fact_by_name(self, "limits").items():
            if not least <= getattr(self, name) <= most:
                raise ValueError(
                    f"{name} must be from {least} to {most}, got {getattr(self, name)}"
                )
        for name in names_where(self, bounds=ABOVE_0):
            if not getattr(self, name) > 0:
                raise ValueError(f"{name} must be above 0, got {getattr(self, name)}")
        if not self.gates_px or min(self.gates_px) <= 0:
            raise ValueError(f"gates_px must be above 0, got {self.gates_px}")
