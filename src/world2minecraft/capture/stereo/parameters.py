"""Parameters of stereo, with the reason for each value."""

from dataclasses import dataclass


@dataclass(frozen=True)
class StereoParameters:
    """How depth is found. docs/stereo.md tells what each figure bought on real photos.

    width_px: photos are made this wide: twice that took six times as long and erred more.
    planes: depths tried for each pixel, even in inverse depth; 96 took half as long again for the
        same.
    neighbours: other photos compared with each; best_of: of which so many, those that fit best at
        a pixel, decide there, as the others may not see it. With 8 and 4, 1 % more of what is
        occupied was called free.
    angle_deg: the angle wanted between the rays of two photos; 9 erred by a third more.
    window_px: width of the square that is compared: odd, 3 to 15.
    noise: grey levels that are no texture: what is flatter follows its surroundings.
    small_step, large_step: what a change of depth by one plane, by more costs between pixels, on
        the scale of 0 to 254 for a match.
    guide_cost: what it costs, likewise, to be two planes or more from a sparse point.
    agreeing: so many other photos must find the same depth; agreement: within this share of it.
        Four or more confirm it wholly, fewer leave it with less trust.
    island_share: the part of a picture that depth must fill in one piece, of neighbours that
        differ by less than island_step: nearly half of what was wrong hung on nothing.
    network_alone: photos are not compared at all; the network of ``--depth`` says their depth.
    """

    width_px: int = 320
    planes: int = 64
    neighbours: int = 12
    best_of: int = 6
    angle_deg: float = 4.0
    window_px: int = 9
    noise: float = 4.0
    small_step: float = 20.0
    large_step: float = 240.0
    guide_cost: float = 120.0
    agreeing: int = 1
    agreement: float = 0.03
    island_share: float = 0.003
    island_step: float = 0.01
    network_alone: bool = False

    def __post_init__(self):
        limits = {
            "width_px": (32, 2000),
            "planes": (8, 254),
            "neighbours": (1, 32),
            "best_of": (1, 32),
            "angle_deg": (0.1, 60),
            "window_px": (3, 15),
            "noise": (0, 100),
            "small_step": (0, 10_000),
            "large_step": (0, 10_000),
            "guide_cost": (0, 254),
            "agreeing": (1, 32),
            "agreement": (1e-4, 0.5),
            "island_share": (0, 0.5),
            "island_step": (1e-4, 0.5),
        }
        for name, (least, most) in limits.items():
            if not least <= getattr(self, name) <= most:
                raise ValueError(f"{name} must be {least} to {most}, not {getattr(self, name)}")
        if self.window_px % 2 == 0:
            raise ValueError(f"window_px must be odd, not {self.window_px}")
