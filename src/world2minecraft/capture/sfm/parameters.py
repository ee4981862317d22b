"""Parameters of structure from motion, with the reason for each value."""

from dataclasses import dataclass

from world2minecraft.core.parameters import fact_by_name, names_where, parameter

ABOVE_0 = "above 0"


@dataclass(frozen=True)
class SfmParameters:
    """How features are taken, matched, and made into poses. Pixels are those of 640 wide pictures.

    working_px: pixels of the image that features are sought in; smaller pictures are enlarged up
        to twice.
    most_features: kept of a photo, the largest first.
    strong: of these, how many tell which photos are alike.
    least_strong: how many of the strong ones must match for two photos to be alike.
    exhaustive: up to so many photos each is compared with each; above, with its neighbours in
        order and those that share most words with it.
    partners, neighbours: how many of the most alike, and of those next in order, a photo is
        matched with in full.
    least_matches: that fit one geometry, for two photos to be linked.
    good_px: stated poses whose reprojection error is at most this stay as they are.
    gates_px: rounds of refining stated poses; what lies farther from its point is no match.
    wide_px: how far stated poses may be off to be measured.
    outlier_px: a stated pose whose matches are off by more, and by over ``outlier_times`` the
        usual, is wrong.
    seed: of all chance in it.
    """

    working_px: int = parameter(
        1_230_000,
        unit="px",
        origin="640x480 in its own size gives half the points and 0.8 px instead of 0.68",
        limits=(10_000, 10_000_000),
    )
    most_features: int = parameter(4000, unit="features", origin="not recorded", limits=(1, 20_000))
    strong: int = parameter(
        500,
        unit="features",
        origin="of the kitchen's pairs that match at all, 500 find 99 % at least_strong",
        limits=(1, 20_000),
    )
    least_strong: int = parameter(8, unit="features", origin="measured with strong")
    exhaustive: int = parameter(120, unit="photos", origin="not recorded", limits=(1, 20_000))
    partners: int = parameter(
        12,
        unit="photos",
        origin="with 12 the kitchen's model is that of all pairs, in half the time",
        limits=(1, 20_000),
    )
    neighbours: int = parameter(3, unit="photos", origin="not recorded")
    least_matches: int = parameter(20, unit="matches", origin="not recorded", limits=(1, 20_000))
    good_px: float = parameter(
        1.0,
        unit="px",
        origin="a guess: stereo at half size needs about half a pixel of its own",
        bounds=ABOVE_0,
    )
    gates_px: tuple[float, ...] = parameter(
        (12.0, 4.0, 2.0),
        unit="px",
        origin="a fourth round changes the kitchen's error by nothing",
    )
    wide_px: float = parameter(12.0, unit="px", origin="not recorded", bounds=ABOVE_0)
    outlier_px: float = parameter(8.0, unit="px", origin="not recorded", bounds=ABOVE_0)
    outlier_times: float = parameter(4.0, unit="times", origin="not recorded", bounds=ABOVE_0)
    seed: int = parameter(0, origin="any number will do")

    def __post_init__(self):
        for name, (least, most) in fact_by_name(self, "limits").items():
            if not least <= getattr(self, name) <= most:
                raise ValueError(f"{name} must be {least} to {most}, not {getattr(self, name)}")
        for name in names_where(self, bounds=ABOVE_0):
            if not getattr(self, name) > 0:
                raise ValueError(f"{name} must be above 0, not {getattr(self, name)}")
        if not self.gates_px or min(self.gates_px) <= 0:
            raise ValueError(f"gates_px must be above 0, not {self.gates_px}")
