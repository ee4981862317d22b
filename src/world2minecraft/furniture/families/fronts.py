"""Fronts of cupboards: the depth of the solid body, and the plates and handles on its face.

A cupboard of 0.6 m is 1.2 blocks deep at two blocks per metre: one block for the body, and a plate
or a handle in the cell in front of it, which fills the rest. The front thus needs no whole block of
its own.
"""

from typing import NamedTuple

from world2minecraft.furniture.block_plan import Numbers, Plan, panel_properties
from world2minecraft.furniture.template import BlockSize
from world2minecraft.minecraft.block_table import block_table

MIN_REST, MAX_REST = 0.04, 0.7  # Of a block: what a front stands in; more is body.
COARSE = 1.5  # Up to so many blocks a metre a front beyond the body would be in people's way.


class Body(NamedTuple):
    """The cells of a cupboard body: the number of solid cells in depth, and the front cell."""

    depth: int
    front: int | None  # i of the cell before the body, None where the size leaves none

    @property
    def face(self) -> int:
        """The index i of the foremost solid cell."""
        return self.depth - 1


def body_of(size: BlockSize) -> Body:
    """Return the depth of the solid body for a size, and the position of its front.

    If the depth is a whole number of blocks, or rounds up to one, the front protrudes by its own
    thickness, but the body stays in place.
    """
    whole = int(size.exact[0])
    rest = size.exact[0] - whole
    if whole and MIN_REST <= rest <= MAX_REST:
        return Body(whole, whole)
    return Body(size.depth, size.depth if size.per_metre > COARSE else None)


def handles(plan: Plan, body: Body, role: str, j: Numbers, k: Numbers) -> None:
    """Place buttons as handles on the face of a body, if the size leaves space for them."""
    if body.front is not None:
        properties = {"face": "wall", "facing": "east", "powered": "false"}
        plan.put(role, body.front, j, k, "button", **properties)


def panels(plan: Plan, body: Body, role: str, j: Numbers, k: Numbers) -> None:
    """Place upright plates on the face of a body, or replace the face if there is no space."""
    if body.front is None:
        plan.put(role, body.face, j, k)
    else:
        plan.put(role, body.front, j, k, "trapdoor", **panel_properties("back"))


def door_columns(width: int, per_metre: float) -> list[int]:
    """Return the columns j with a handle, one per door, with doors in pairs about their centre."""
    if per_metre < 3:
        return list(range(width))
    if width < 4:
        return [width // 2]
    columns = []
    for start in range(0, width - width % 4, 4):
        columns += [start + 1, start + 2]
    if width % 4:
        columns.append(width - 1 - (width % 4) // 2)
    return columns


def faces(plan: Plan, role: str, i: Numbers, j: Numbers, k: Numbers) -> None:
    """Place whole blocks of a role, with the front of directional blocks towards the front."""
    state = plan.look.state(role)
    block = block_table().blocks.get(state)
    turnable = block is not None and any(name == "facing" for name, _ in block.properties)
    plan.put_state(role, f"{state}[facing=east]" if turnable else state, i, j, k)
