"""How templates are matched: every number that decides it, and where it comes from."""

from dataclasses import dataclass

from world2minecraft.core.errors import UsageError
from world2minecraft.core.parameters import names_where, parameter

ABOVE_0, SHARE, UP_TO_8 = "above 0", "0 to 1", "0 to 8"


@dataclass(frozen=True)
class RetrievalParameters:
    """How templates are matched.

    min_iou: below it an object is built from its own cells.
    shift_cells: how far a template moves from where the object's box says, along each axis.
    size_slack: how many cells a template's side may differ from the object's box.
    finalists: how many of the first, coarse trials are refined.
    alternatives: how many other templates and turns a placement lists.
    cut_below: an object matched worse than this is cut into runs, in case they match better.
    cut_gain: by how much the runs together must match better than the whole, for each cut.
    cut_from_m: an object shorter than this is not cut.
    max_runs: into how many runs an object is cut at most.
    min_run_share: a run with less of the object's cells than this stays its own cells and counts
        as unmatched when a cut is weighed: crumbs always match something.
    min_run_cells: a run of fewer cells of the floor plan is left to its neighbours.
    size_weight: how much IoU an unusual size or parameter may cost.
    front_weight: how much IoU the front that was found with the object may bring.
    beyond_weight: the score that a template loses where it lies wholly in the unseen outside the
        object's box.
    seat_below: a chair matched worse than this may be one of usual size that lies across the
        grid or is hidden for the most part.
    seat_met, seat_opposed: where no template of a chair reaches ``min_iou``, a whole chair is put
        all the same that meets this share of the object's cells, in or beside it, and of which at
        most so much stands in space that was seen free.
    seat_look_m: a chair whose turn its cells leave open looks to a table this near.
    variants: another design of a match's family may stand for it, by size, parameters and colour.
    paper_compat: the paper's equation to the letter: every cell of the template and of the
        object counts, seen or not, nothing breaks ties but the library's order, and nothing is
        cut into runs.
    """

    min_iou: float = parameter(
        0.5,
        unit="IoU",
        origin="a poor box is worse than the object's own crumbs",
        bounds=SHARE,
    )
    shift_cells: int = parameter(
        1,
        unit="cells",
        origin="a box is a cell off where noise adds or loses a layer",
        bounds=UP_TO_8,
    )
    size_slack: int = parameter(
        1,
        unit="cells",
        origin="a box is a cell off where noise adds or loses a layer",
        bounds=UP_TO_8,
    )
    finalists: int = parameter(6, origin="docs/furniture.md", bounds=ABOVE_0)
    alternatives: int = parameter(5, origin="what an editor can show", bounds=UP_TO_8)
    cut_below: float = parameter(
        0.75,
        unit="IoU",
        origin="an L of two equal wings fills 5/9 to 3/4 of its box",
        bounds=SHARE,
    )
    cut_gain: float = parameter(
        0.1,
        unit="IoU",
        origin="less lets noise cut a table into several, seen on a real kitchen",
        bounds=SHARE,
    )
    cut_from_m: float = parameter(
        1.2,
        unit="m",
        origin="two chairs side by side are not shorter, and the wings of an L are not either",
    )
    max_runs: int = parameter(8, origin="a kitchen has four to six", bounds=ABOVE_0)
    min_run_share: float = parameter(0.08, unit="share", origin="docs/furniture.md", bounds=SHARE)
    min_run_cells: int = parameter(6, unit="cells", origin="docs/furniture.md", bounds=ABOVE_0)
    size_weight: float = parameter(
        0.01, unit="IoU", origin="it decides between equals", bounds=SHARE
    )
    front_weight: float = parameter(
        0.05,
        unit="IoU",
        origin="the turns of a seat differ by 0.2 on noisy scans of generated rooms, those of a "
        "box at a wall by nothing",
        bounds=SHARE,
    )
    beyond_weight: float = parameter(
        0.1, unit="IoU", origin="a tenth outweighs no clear match", bounds=SHARE
    )
    seat_below: float = parameter(0.6, unit="IoU", origin="docs/furniture.md", bounds=SHARE)
    seat_met: float = parameter(0.5, unit="share", origin="docs/furniture.md", bounds=SHARE)
    seat_opposed: float = parameter(
        0.2, unit="share", origin="construction refuses more", bounds=SHARE
    )
    seat_look_m: float = parameter(1.0, unit="m", origin="docs/furniture.md")
    variants: bool = parameter(True)
    paper_compat: bool = parameter(False)

    def __post_init__(self):
        for name in names_where(self, bounds=SHARE):
            if not 0 <= getattr(self, name) <= 1:
                given = getattr(self, name)
                raise UsageError(f"furnish.{name} must be between 0 and 1, got {given}")
        for name in names_where(self, bounds=UP_TO_8):
            if not 0 <= getattr(self, name) <= 8:
                given = getattr(self, name)
                raise UsageError(f"furnish.{name} must be between 0 and 8, got {given}")
        for name in names_where(self, bounds=ABOVE_0):
            if getattr(self, name) < 1:
                raise UsageError(f"furnish.{name} must be above 0, got {getattr(self, name)}")
