"""Parameters of structure from motion, with the reason for each value."""

from dataclasses import dataclass


@dataclass(frozen=True)
class SfmParameters:
    """How features are taken, matched, and made into poses. Pixels are those of 640 wide pictures.

    working_px: pixels of the image that features are sought in; smaller pictures are enlarged up
        to twice. 640x480 in its own size gives half the points and 0.8 px instead of 0.68.
    most_features: kept of a photo, the largest first.
    strong: of these, how many tell which photos are alike. Of the kitchen's pairs that match at
        all, 500 find 99 % at ``least_strong``.
    exhaustive: up to so many photos each is compared with each; above, with its neighbours in
        order and those that share most words with it.
    partners, neighbours: how many of the most alike, and of those next in order, a photo is
        matched with in full. With 12 the kitchen's model is that of all pairs, in half the time.
    least_matches: that fit one geometry, for two photos to be linked.
    good_px: stated poses whose reprojection error is at most this stay as they are (a guess:
        stereo at half size needs about half a pixel of its own).
    gates_px: rounds of refining stated poses; what lies farther from its point is no match. A
        fourth round changes the kitchen's error by nothing.
    wide_px: how far stated poses may be off to be measured.
    outlier_px: a stated pose whose matches are off by more, and by over ``outlier_times`` the
        usual, is wrong.
    seed: of all chance in it.
    """

    working_px: int = 1_230_000
    most_features: int = 4000
    strong: int = 500
    least_strong: int = 8
    exhaustive: int = 120
    partners: int = 12
    neighbours: int = 3
    least_matches: int = 20
    good_px: float = 1.0
    gates_px: tuple[float, ...] = (12.0, 4.0, 2.0)
    wide_px: float = 12.0
    outlier_px: float = 8.0
    outlier_times: float = 4.0
    seed: int = 0

    def __post_init__(self):
        if not 10_000 <= self.working_px <= 10_000_000:
            raise ValueError(f"working_px must be 10000 to 10000000, not {self.working_px}")
        for name in ("most_features", "strong", "exhaustive", "partners", "least_matches"):
            if not 1 <= getattr(self, name) <= 20_000:
                raise ValueError(f"{name} must be 1 to 20000, not {getattr(self, name)}")
        for name in ("good_px", "wide_px", "outlier_px", "outlier_times"):
            if not getattr(self, name) > 0:
                raise ValueError(f"{name} must be above 0, not {getattr(self, name)}")
        if not self.gates_px or min(self.gates_px) <= 0:
            raise ValueError(f"gates_px must be above 0, not {self.gates_px}")
