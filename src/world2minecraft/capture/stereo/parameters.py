"""Parameters of stereo, with the reason for each value."""

from dataclasses import dataclass

from world2minecraft.core.parameters import fact_by_name, parameter


@dataclass(frozen=True)
class StereoParameters:
    """How depth is found. docs/stereo.md tells what each figure bought on real photos.

    width_px: photos are made this wide.
    planes: depths tried for each pixel, even in inverse depth.
    neighbours: other photos compared with each; best_of: of which so many, those that fit best at
        a pixel, decide there, as the others may not see it.
    angle_deg: the angle wanted between the rays of two photos.
    window_px: width of the square that is compared, an odd number.
    noise: grey levels that are no texture: what is flatter follows its surroundings.
    small_step, large_step: what a change of depth by one plane, by more costs between pixels, on
        the scale of 0 to 254 for a match.
    guide_cost: what it costs, likewise, to be two planes or more from a sparse point.
    agreeing: so many other photos must find the same depth; agreement: within this share of it.
        Four or more confirm it wholly, fewer leave it with less trust.
    island_share: the part of a picture that depth must fill in one piece, of neighbours that
        differ by less than island_step.
    network_alone: photos are not compared at all; the network of ``--depth`` says their depth.
    """

    width_px: int = parameter(
        320,
        unit="px",
        origin="twice that took six times as long and erred more",
        limits=(32, 2000),
    )
    planes: int = parameter(
        64,
        unit="planes",
        origin="96 took half as long again for the same",
        limits=(8, 254),
    )
    neighbours: int = parameter(
        12,
        unit="photos",
        origin="with 8, and best_of 4, 1 % more of what is occupied was called free",
        limits=(1, 32),
    )
    best_of: int = parameter(6, unit="photos", origin="measured with neighbours", limits=(1, 32))
    angle_deg: float = parameter(
        4.0, unit="degrees", origin="9 erred by a third more", limits=(0.1, 60)
    )
    window_px: int = parameter(9, unit="px", origin="docs/stereo.md", limits=(3, 15))
    noise: float = parameter(4.0, unit="grey levels", origin="docs/stereo.md", limits=(0, 100))
    small_step: float = parameter(20.0, unit="cost", origin="not recorded", limits=(0, 10_000))
    large_step: float = parameter(240.0, unit="cost", origin="docs/stereo.md", limits=(0, 10_000))
    guide_cost: float = parameter(120.0, unit="cost", origin="docs/stereo.md", limits=(0, 254))
    agreeing: int = parameter(1, unit="photos", origin="docs/stereo.md", limits=(1, 32))
    agreement: float = parameter(0.03, unit="share", origin="docs/stereo.md", limits=(1e-4, 0.5))
    island_share: float = parameter(
        0.003,
        unit="share",
        origin="nearly half of what was wrong hung on nothing",
        limits=(0, 0.5),
    )
    island_step: float = parameter(
        0.01, unit="share", origin="measured with island_share", limits=(1e-4, 0.5)
    )
    network_alone: bool = parameter(False)

    def __post_init__(self):
        for name, (least, most) in fact_by_name(self, "limits").items():
            if not least <= getattr(self, name) <= most:
                raise ValueError(f"{name} must be {least} to {most}, not {getattr(self, name)}")
        if self.window_px % 2 == 0:
            raise ValueError(f"window_px must be odd, not {self.window_px}")
