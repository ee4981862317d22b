"""The parameters of matching templates and the reasons for their defaults."""

from dataclasses import dataclass

from world2minecraft.core.errors import UsageError
from world2minecraft.core.parameters import names_where, parameter

ABOVE_0, SHARE, UP_TO_8 = "above 0", "0 to 1", "0 to 8"


@dataclass(frozen=True)
class RetrievalParameters:
    """Parameters of template matching.

    min_confidence: Minimum confidence of an object's class for a template; below it, the object is
        built as a simple volume of its own cells.
    min_iou: Minimum IoU of a template; below it, the object is built from its own cells.
    shift_cells: Maximum shift of a template from the object's box along each axis.
    size_slack: Maximum difference between the sides of a template and the object's box.
    finalists: Number of coarse candidates that are refined.
    alternatives: Number of other templates and rotations listed with each placement.
    cut_below: IoU below which cutting an object into runs is tried.
    cut_gain: Minimum increase in IoU per cut.
    cut_from_m: Minimum length of an object that may be cut.
    max_runs: Maximum number of runs into which an object is cut.
    min_run_share: Minimum share of the object's cells for a run to be matched. Smaller runs are
        built from their cells and count as unmatched.
    min_run_cells: Minimum number of floor plan cells of a run; smaller runs are merged with their
        neighbours.
    size_weight: Maximum IoU penalty for an unusual size or parameter.
    front_weight: Maximum IoU bonus for agreement with the detected front of the object.
    name_weight: Bonus, times its probability, of templates that show the name of the object.
    name_min_iou: Minimum IoU of such a template.
    beyond_weight: Maximum score penalty for a template in unseen space outside the object's box.
    seat_below: IoU below which a chair may be replaced by a chair of typical size that is rotated
        against the grid or mostly hidden.
    seat_met, seat_opposed: If no template of a chair reaches ``min_iou``, a whole chair is placed
        if it covers at least the share ``seat_met`` of the object's cells and at most the share
        ``seat_opposed`` of it is in space seen as free.
    seat_look_m: Maximum distance of a table that a chair of unknown orientation is turned to.
    variants: Whether a match may be replaced by another design of its family, by size, parameters
        and colour.
    paper_compat: Whether to use the paper's equation exactly. All cells of template and object
        count, seen or not, ties are decided by library order, and objects are never cut.
    """

    min_confidence: float = parameter(
        0.5,
        unit="probability",
        origin="of the objects of 81 NYUv2 frames, 20 % have the right class below 0.5 and 42 % "
        "above it; of those of 13 generated rooms without label images, 16 % and 84 %",
        bounds=SHARE,
    )
    min_iou: float = parameter(
        0.5,
        unit="IoU",
        origin="a poorly matching template looks worse than the object's own cells",
        bounds=SHARE,
    )
    shift_cells: int = parameter(
        1,
        unit="cells",
        origin="a box is off by one cell if noise adds or removes a layer",
        bounds=UP_TO_8,
    )
    size_slack: int = parameter(
        1,
        unit="cells",
        origin="a box is off by one cell if noise adds or removes a layer",
        bounds=UP_TO_8,
    )
    finalists: int = parameter(6, origin="docs/explanation/furniture.md", bounds=ABOVE_0)
    alternatives: int = parameter(5, origin="number that the editor shows", bounds=UP_TO_8)
    cut_below: float = parameter(
        0.75,
        unit="IoU",
        origin="an L of two equal wings fills 5/9 to 3/4 of its box",
        bounds=SHARE,
    )
    cut_gain: float = parameter(
        0.1,
        unit="IoU",
        origin="with lower values, noise cuts a table of a real kitchen into several",
        bounds=SHARE,
    )
    cut_from_m: float = parameter(
        1.2,
        unit="m",
        origin="minimum length of two chairs side by side and of the wings of an L",
    )
    max_runs: int = parameter(8, origin="kitchens have four to six runs", bounds=ABOVE_0)
    min_run_share: float = parameter(
        0.08, unit="share", origin="docs/explanation/furniture.md", bounds=SHARE
    )
    min_run_cells: int = parameter(
        6, unit="cells", origin="docs/explanation/furniture.md", bounds=ABOVE_0
    )
    size_weight: float = parameter(
        0.01, unit="IoU", origin="only decides between equal matches", bounds=SHARE
    )
    front_weight: float = parameter(
        0.05,
        unit="IoU",
        origin="in noisy scans of generated rooms, the rotations of a seat differ by 0.2 in IoU, "
        "those of a box at a wall not at all",
        bounds=SHARE,
    )
    beyond_weight: float = parameter(
        0.1, unit="IoU", origin="does not outweigh a clear match", bounds=SHARE
    )
    name_weight: float = parameter(
        0.6,
        unit="IoU",
        origin="of 105 named objects in eight generated rooms, 86 become furniture of their name, "
        "and 46 without a bonus",
        bounds=SHARE,
    )
    name_min_iou: float = parameter(
        0.3,
        unit="IoU",
        origin="the true templates of half-seen and thin objects reach 0.3 to 0.5",
        bounds=SHARE,
    )
    seat_below: float = parameter(
        0.6, unit="IoU", origin="docs/explanation/furniture.md", bounds=SHARE
    )
    seat_met: float = parameter(
        0.5, unit="share", origin="docs/explanation/furniture.md", bounds=SHARE
    )
    seat_opposed: float = parameter(
        0.2, unit="share", origin="limit of the construction stage", bounds=SHARE
    )
    seat_look_m: float = parameter(1.0, unit="m", origin="docs/explanation/furniture.md")
    variants: bool = parameter(True)
    paper_compat: bool = parameter(False)

    def __post_init__(self):
        for bounds, most in ((SHARE, 1), (UP_TO_8, 8)):
            for name in names_where(self, bounds=bounds):
                given = getattr(self, name)
                if not 0 <= given <= most:
                    raise UsageError(f"furnish.{name} must be between 0 and {most}, got {given}")
        for name in names_where(self, bounds=ABOVE_0):
            if getattr(self, name) < 1:
                raise UsageError(f"furnish.{name} must be above 0, got {getattr(self, name)}")
