"""The parameters of finding objects and the reasons for their defaults."""

from dataclasses import dataclass

from world2minecraft.core.errors import UsageError
from world2minecraft.core.parameters import names_where, parameter

ABOVE_0 = "above 0"


@dataclass(frozen=True)
class InstanceParameters:
    """Parameters of finding objects, with lengths in cells; docs/sweeps.md shows their effects.

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
        origin="the smallest that sees a neighbourhood; object F1 at 1, 3 and 5: 0.957, 0.959, "
        "0.956 with 2D labels",
    )
    density_threshold: float = parameter(
        0.2,
        unit="share",
        origin="takes shells with their edges and leaves specks and poles to the growing step; "
        "from 0.4 on objects fall apart",
    )
    cluster_radius: float = parameter(
        2.0,
        unit="cells",
        origin="bridges a one-cell hole; at 1 holes part objects, at 4 neighbours merge where "
        "labels are poor",
        bounds=ABOVE_0,
    )
    min_samples: int = parameter(
        4,
        unit="cells",
        origin="less than any shell has within two cells and more than a bridge of noise between "
        "two objects; from 8 on thin things have no core",
        bounds=ABOVE_0,
    )
    min_cells: int = parameter(
        8,
        unit="cells",
        origin="at 0.08 m the face of a book; 5 finds a few cups more with 2D labels (0.962) and "
        "takes crumbs for objects with geometric ones (0.761, at 8 0.780)",
        bounds=ABOVE_0,
    )
    join_radius: float = parameter(
        5.0,
        unit="cells",
        origin="the height of a chair's seat, for legs that a scan has torn off; measured on "
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
