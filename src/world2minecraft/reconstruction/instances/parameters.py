"""How objects are found: every number that decides it, and where it comes from."""

from dataclasses import dataclass

from world2minecraft.core.errors import UsageError


@dataclass(frozen=True)
class FindParameters:
    """How objects are found. Lengths are in cells; docs/sweeps.md has the curves.

    The paper gives no number. Within wide bounds none matters: the steps after the clusters part
    what they join and join what they part.

    density_kernel: k, the side of the uniform kernel; the smallest that sees a neighbourhood.
        Object F1 at 1, 3 and 5: 0.957, 0.959, 0.956 with 2D labels.
    density_threshold: tau, as a share of the kernel's cells. A scan shows one-cell shells: a
        flat one has 9/27, its straight edge 6/27, a lone pole 3/27. 0.2 takes shells with their
        edges and leaves specks and poles to the growing step; from 0.4 on objects fall apart.
    cluster_radius: eta, the L2 distance that joins candidates: 2 bridges a one-cell hole. At 1
        holes part objects, at 4 neighbours merge where labels are poor.
    min_samples: DBSCAN's core size, the candidate itself included. 4 within two cells is less
        than any shell has and more than a bridge of noise between two objects; from 8 on thin
        things have no core.
    min_cells: an object of fewer cells is a speck: at 0.08 m, 8 cells are the face of a book. 5
        finds a few cups more with 2D labels (0.962) and takes crumbs for objects with geometric
        ones (0.761, at 8 0.780).
    join_radius: cells without an object join one of their class this near: the height of a
        chair's seat, for legs that a scan has torn off (measured on generated chairs).
    paper_compat: stop where Algorithm 1 stops: each cluster is an object whatever its size,
        and what is not connected with a cluster belongs to none.
    """

    density_kernel: int = 3
    density_threshold: float = 0.2
    cluster_radius: float = 2.0
    min_samples: int = 4
    min_cells: int = 8
    join_radius: float = 5.0
    paper_compat: bool = False

    def __post_init__(self):
        if self.density_kernel < 1 or self.density_kernel % 2 == 0:
            raise UsageError(
                f"find.density_kernel must be odd and above 0, not {self.density_kernel}"
            )
        if not 0 <= self.density_threshold <= 1:
            raise UsageError(
                f"find.density_threshold must lie between 0 and 1, not {self.density_threshold}"
            )
        for name in ("cluster_radius", "min_samples", "min_cells"):
            if not getattr(self, name) > 0:
                raise UsageError(f"find.{name} must be above 0, not {getattr(self, name)}")
        if not self.join_radius >= 0:
            raise UsageError(f"find.join_radius must not be negative, not {self.join_radius}")
