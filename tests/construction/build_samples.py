"""Small rooms for the tests of the builder, made cell by cell."""

import numpy as np

from world2minecraft.core.types import OccupancyGrid, Placement

VOXEL_M = 0.08
PAD = 2
WHITE, WOOD, RED, DARK = (230, 228, 224), (162, 131, 79), (150, 35, 40), (40, 40, 45)
CEILING, FLOOR, WALL, WINDOW, CHAIR, TABLE, TVS, FURN, OBJS = 1, 2, 3, 4, 5, 8, 9, 10, 11


class Sketch:
    """A room to draw into: the inner box begins at cell (0, 0, 0); all is seen and free at first.

    Cells outside the plan are unseen; the shell is one cell thick, outside the inner box.
    """

    def __init__(self, size=(50, 25, 30), notch=None, ceiling=True, walls=True):
        x, y, z = size
        self.size = size
        shape = (x + 2 * PAD, y + 2 * PAD, z + 3)
        self.labels = np.full(shape, 255, np.uint8)
        self.colour = np.zeros((*shape, 3), np.uint8)
        self.instance = np.zeros(shape, np.uint16)
        plan = np.zeros(shape[:2], bool)
        plan[PAD : PAD + x, PAD : PAD + y] = True
        if notch is not None:
            plan[PAD + notch[0] : PAD + x, PAD + notch[1] : PAD + y] = False
        self.plan = plan
        self.labels[plan, 1 : z + 1] = 0
        self.labels[plan, 0] = FLOOR
        self.colour[plan, 0] = WOOD
        if walls:
            ring = np.zeros_like(plan)
            for i, j in np.argwhere(plan):
                ring[i - 1 : i + 2, j - 1 : j + 2] = True
            ring &= ~plan
            self.labels[ring, 1 : z + 1] = WALL
            self.colour[ring, 1 : z + 1] = WHITE
        if ceiling:
            self.labels[plan, z + 1] = CEILING
            self.colour[plan, z + 1] = WHITE

    def at(self, x, y, z):
        """Slices of the arrays for ranges of inner cells."""
        return (
            slice(x[0] + PAD, x[1] + PAD),
            slice(y[0] + PAD, y[1] + PAD),
            slice(z[0] + 1, z[1] + 1),
        )

    def put(self, x, y, z, label, colour, instance=0):
        where = self.at(x, y, z)
        self.labels[where] = label
        self.colour[where] = colour
        self.instance[where] = instance
        return self

    def grid(self) -> OccupancyGrid:
        origin = np.array([-PAD * VOXEL_M, -PAD * VOXEL_M, -VOXEL_M])
        source = np.where(self.labels == 255, 0, 1).astype(np.uint8)
        confidence = np.where(source > 0, 1, 0).astype(np.float16)
        return OccupancyGrid(
            self.labels, confidence, self.colour, source, self.instance, VOXEL_M, origin
        )

    @property
    def corner_m(self) -> np.ndarray:
        return np.array([0.0, self.size[1] * VOXEL_M])


def l_room() -> Sketch:
    """An L: the notch is at high x and high y; a red chair stands at low x and low y."""
    sketch = Sketch(notch=(30, 14))
    sketch.put((2, 8), (2, 8), (5, 6), CHAIR, RED, 1)
    return sketch.put((2, 3), (2, 8), (0, 11), CHAIR, RED, 1)


def furnished(size=(50, 25, 30)) -> Sketch:
    """A room with a window, a doorway, a table and a cupboard under a dark top."""
    sketch = Sketch(size)
    x, y, _ = size
    sketch.put((20, 34), (-1, 0), (12, 24), WINDOW, (180, 200, 210))
    sketch.put((x, x + 1), (8, 18), (0, 25), 0, 0)
    sketch.put((16, 36), (8, 16), (8, 9), TABLE, WOOD, 1)
    for i in (16, 35):
        for j in (8, 15):
            sketch.put((i, i + 1), (j, j + 1), (0, 8), TABLE, WOOD, 1)
    sketch.put((0, 8), (0, y), (0, 10), FURN, RED, 2)
    return sketch.put((0, 8), (0, y), (10, 11), FURN, DARK, 2)


def placement(template, class_id, center_m, size_m, turns=0, number=1) -> Placement:
    return Placement(
        object_id=number,
        class_id=class_id,
        template=template,
        center_m=np.array(center_m, np.float64),
        size_m=np.array(size_m, np.float64),
        quarter_turns=turns,
        iou=1.0,
    )
