"""The parameters of finding objects and the reasons for their defaults."""

from dataclasses import dataclass

from world2minecraft.core.errors import UsageError
from world2minecraft.core.parameters import names_where, parameter

ABOVE_0 = "above 0"


@dataclass(frozen=True)
class InstanceParameters:
    """Parameters of the object detection, in cells; effects: docs/results/recognition.md.

    The paper states no values. Results are stable over wide ranges, since the passes after
    clustering split and merge objects.

    density_kernel: Side of the uniform density kernel (the paper's k); must be odd.
    density_threshold: Minimum filled share of the kernel for a candidate cell (the paper's tau). In
        one-cell shells, a flat part has 9/27, a straight edge 6/27 and a pole 3/27.
    cluster_radius: Maximum L2 distance of neighbouring candidates in a cluster (the paper's eta).
    min_samples: Minimum number of neighbours of a DBSCAN core point, including itself.
    min_cells: Minimum number of cells of an object.
    join_radius: Maximum distance of a loose cell from the object of its class that it is added to.
    paper_compat: Whether to stop after the paper's Algorithm 1. Each cluster is then an object of
        any size, and cells not connected to a cluster belong to no object.
    """

    density_kernel: int = parameter(
        3,
        unit="cells",
        origin="smallest kernel that covers a neighbourhood; the object F1 with 2D labels is "
        "0.957, 0.959 and 0.956 at 1, 3 and 5",
    )
    density_threshold: float = parameter(
        0.2,
        unit="share",
        origin="includes shells and their edges, but not specks and poles, which are added later; "
        "at 0.4 and above, objects fall apart",
    )
    cluster_radius: float = parameter(
        2.0,
        unit="cells",
        origin="bridges holes of one cell; at 1, holes divide objects, and at 4, neighbours with "
        "poor labels are merged",
        bounds=ABOVE_0,
    )
    min_samples: int = parameter(
        4,
        unit="cells",
        origin="fewer cells than any shell has within two cells, and more than a bridge of noise "
        "between two objects has; at 8 and above, thin objects have no core points",
        bounds=ABOVE_0,
    )
    min_cells: int = parameter(
        8,
        unit="cells",
        origin="size of a book's cover at 0.08 m; with 5, a few more cups are found with 2D labels "
        "(F1 0.962), but noise becomes objects with geometric labels (F1 0.761, 0.780 at 8)",
        bounds=ABOVE_0,
    )
    join_radius: float = parameter(
        5.0,
        unit="cells",
        origin="height of a chair's seat, for legs that the scan separates; measured on "
        "generated chairs",
    )
    paper_compat: bool = parameter(False)

    def __post_init__(self):
        if self.density_kernel < 1 or self.density_kernel % 2 == 0:
            raise UsageError(
                f"find.density_kernel must be odd and above 0, got {self.density_kernel}"
            )
        if not 0 <= self.density_threshold <= 1:
            raise UsageError(
                f"find.density_threshold must be between 0 and 1, got {self.density_threshold}"
            )
        for name in names_where(self, bounds=ABOVE_0):
            if not getattr(self, name) > 0:
                raise UsageError(f"find.{name} must be above 0, got {getattr(self, name)}")
        if not self.join_radius >= 0:
            raise UsageError(f"find.join_radius must be 0 or more, got {self.join_radius}")
