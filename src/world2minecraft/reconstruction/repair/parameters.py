"""The parameters of repair, and the reasons for their defaults."""

from dataclasses import dataclass

from world2minecraft.core.errors import UsageError
from world2minecraft.core.parameters import names_where, parameter

COUNT, SHARE = "1 to 100", "0 to 1"


@dataclass(frozen=True)
class RepairParameters:
    """Parameters of repair by rendering.

    enabled: Whether furniture that compares badly with the photos is exchanged.
    max_views: Maximum number of photos that are compared.
    max_objects: Maximum number of objects that are repaired, those with most wrong surface first.
    max_candidates: Maximum number of candidates for each object, its own cells included.
    good: Agreement from which an object is not repaired.
    min_gain: Minimum gain of agreement for which furniture is exchanged.
    max_iou_loss: Maximum loss of an object's IoU.
    mean_iou_loss: Maximum mean loss over all objects.
    """

    enabled: bool = parameter(True)
    max_views: int = parameter(
        6, origin="with 8, headlines of other photos rise as much", bounds=COUNT
    )
    max_objects: int = parameter(20, origin="number of pieces in a furnished room", bounds=COUNT)
    max_candidates: int = parameter(
        5,
        origin="with 7, no headline of eight captures is higher; with 4, two are lower",
        bounds=COUNT,
    )
    good: float = parameter(
        0.75, unit="agreement", origin="most furniture of its true template", bounds=SHARE
    )
    min_gain: float = parameter(
        0.05, unit="agreement", origin="gains above it are found in other photos too", bounds=SHARE
    )
    max_iou_loss: float = parameter(
        0.25,
        unit="IoU",
        origin="a sofa cut in two and turned matches its cells better by 0.23 than the right sofa",
        bounds=SHARE,
    )
    mean_iou_loss: float = parameter(
        0.02, unit="IoU", origin="about the noise of a scan", bounds=SHARE
    )

    def __post_init__(self):
        for name in names_where(self, bounds=COUNT):
            if not 1 <= getattr(self, name) <= 100:
                raise UsageError(f"repair.{name} must be 1 to 100, got {getattr(self, name)}")
        for name in names_where(self, bounds=SHARE):
            if not 0 <= getattr(self, name) <= 1:
                given = getattr(self, name)
                raise UsageError(f"repair.{name} must be between 0 and 1, got {given}")
