"""How templates are matched: every number that decides it, and where it comes from."""

from dataclasses import dataclass

from world2minecraft.core.errors import UsageError

SHARES = (
    "min_iou",
    "cut_below",
    "cut_gain",
    "min_run_share",
    "size_weight",
    "front_weight",
    "beyond_weight",
    "seat_below",
    "seat_met",
    "seat_opposed",
)


@dataclass(frozen=True)
class FurnishParameters:
    """How templates are matched.

    min_iou: below it an object is built from its own cells: a poor box is worse than the
        object's own crumbs.
    shift_cells: how far a template moves from where the object's box says, along each axis; a
        box is a cell off where noise adds or loses a layer.
    size_slack: how many cells a template's side may differ from the object's box; the same.
    finalists: how many of the first, coarse trials are refined.
    alternatives: how many other templates and turns a placement lists.
    cut_below: an object matched worse than this is cut into runs, in case they match better. An
        L of two equal wings fills 5/9 to 3/4 of its box.
    cut_gain: by how much the runs together must match better than the whole, for each cut; less
        lets noise cut a table into several (seen on a real kitchen).
    cut_from_m: an object shorter than this is not cut: two chairs side by side are not shorter,
        and the wings of an L are not either.
    max_runs: into how many runs an object is cut at most; a kitchen has four to six.
    min_run_share: a run with less of the object's cells than this stays its own cells and counts
        as unmatched when a cut is weighed: crumbs always match something.
    min_run_cells: a run of fewer cells of the floor plan is left to its neighbours.
    size_weight: how much IoU an unusual size or parameter may cost: it decides between equals.
    front_weight: how much IoU the front that find/ saw may bring. The turns of a seat differ by
        0.2 on noisy scans of generated rooms, those of a box at a wall by nothing.
    beyond_weight: the score that a template loses where it lies wholly in the unseen outside the
        object's box; a tenth, so that it outweighs no clear match.
    seat_below: a chair matched worse than this may be one of usual size that lies across the
        grid or is hidden for the most part.
    seat_met, seat_opposed: where no template of a chair reaches ``min_iou``, a whole chair is put
        all the same that meets this share of the object's cells, in or beside it, and of which at
        most so much stands in space that was seen free; build/ refuses more.
    seat_look_m: a chair whose turn its cells leave open looks to a table this near.
    variants: another design of a match's family may stand for it, by size, parameters and colour.
    paper_compat: the paper's equation to the letter: every cell of the template and of the
        object counts, seen or not, nothing breaks ties but the library's order, and nothing is
        cut into runs.
    """

    min_iou: float = 0.5
    shift_cells: int = 1
    size_slack: int = 1
    finalists: int = 6
    alternatives: int = 5
    cut_below: float = 0.75
    cut_gain: float = 0.1
    cut_from_m: float = 1.2
    max_runs: int = 8
    min_run_share: float = 0.08
    min_run_cells: int = 6
    size_weight: float = 0.01
    front_weight: float = 0.05
    beyond_weight: float = 0.1
    seat_below: float = 0.6
    seat_met: float = 0.5
    seat_opposed: float = 0.2
    seat_look_m: float = 1.0
    variants: bool = True
    paper_compat: bool = False

    def __post_init__(self):
        for name in SHARES:
            if not 0 <= getattr(self, name) <= 1:
                given = getattr(self, name)
                raise UsageError(f"furnish.{name} must lie between 0 and 1, not {given}")
        for name in ("shift_cells", "size_slack", "alternatives"):
            if not 0 <= getattr(self, name) <= 8:
                given = getattr(self, name)
                raise UsageError(f"furnish.{name} must lie between 0 and 8, not {given}")
        for name in ("finalists", "max_runs", "min_run_cells"):
            if getattr(self, name) < 1:
                raise UsageError(f"furnish.{name} must be above 0, not {getattr(self, name)}")
