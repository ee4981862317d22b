"""Closed storage families: chests of drawers, sideboards, wardrobes, glass cabinets, chests.

If the depth leaves space in front of the body, doors are plates or have buttons as handles.
Otherwise the front blocks have the role ``face``, such as barrels.
"""

from collections.abc import Sequence

from world2minecraft.furniture.block_plan import Numbers, Plan
from world2minecraft.furniture.box_primitives import legs, part, slab
from world2minecraft.furniture.families.fronts import (
    Body,
    body_of,
    door_columns,
    faces,
    handles,
    panels,
)
from world2minecraft.furniture.family import Family
from world2minecraft.furniture.template import BlockSize, LocalBlock, Part
from world2minecraft.furniture.template_parameters import Look

DOOR_M, HANDLE_M, GAP_M, LID_M = 0.02, 0.02, 0.008, 0.04
DOOR_WIDTH_M, DRAWER_M = 0.5, 0.22
LEGS_M = {"none": 0.0, "short": 0.06, "tall": 0.15}
GLASS_FROM = 0.35  # The share of the height under which a glass cabinet is closed.


def _case(depth: float, width: float, height: float, look: Look) -> list[Part]:
    base = min(LEGS_M[look.option("legs")], height / 4)
    front = look.option("front")
    x, y = depth / 2, width / 2
    if front == "plain":
        door = min(DOOR_M, x)
        return [
            part("body", (-x, x - door), (-y, y), (0.0, height)),
            part("door", (x - door, x), (-y, y), (0.0, height)),
        ]
    face = max(x - DOOR_M - HANDLE_M, 0.0)
    lid = min(LID_M, height / 4) if front == "lid" else 0.0
    found = [part("body", (-x, face), (-y, y), (base, height - lid))]
    if base > 0:
        found += legs(depth - (x - face), width, base, 0.05)
        shift = (face - x) / 2
        found[1:] = [_moved(one, shift) for one in found[1:]]
    if front == "lid":
        return [*found, slab("door", depth, width, height - lid, height)]
    rows, columns = _divided(width, height - base, front)
    return found + [
        one
        for row in range(rows)
        for column in range(columns)
        for one in _leaf((face, x), width, (base, height), (row, rows), (column, columns), front)
    ]


def _moved(one: Part, along: float) -> Part:
    box = one.box_m.copy()
    box[[0, 3]] += along
    return one._replace(box_m=box)


def _divided(width: float, height: float, front: str) -> tuple[int, int]:
    """Return how many rows and columns of leaves a front has."""
    if front == "drawers":
        return max(2, round(height / DRAWER_M)), max(1, round(width / 1.0))
    return 1, max(1, round(width / DOOR_WIDTH_M))


def _leaf(
    x: tuple[float, float],
    width: float,
    z: tuple[float, float],
    row: tuple[int, int],
    column: tuple[int, int],
    front: str,
) -> list[Part]:
    """Return one door or drawer with its handle."""
    wide, tall = width / column[1], (z[1] - z[0]) / row[1]
    low_y, low_z = -width / 2 + column[0] * wide, z[0] + row[0] * tall
    across = (low_y + GAP_M, low_y + wide - GAP_M)
    up = (low_z + GAP_M, low_z + tall - GAP_M)
    middle = (x[0] + x[1]) / 2
    role = "glass" if front in ("glass", "sliding") else "door"
    if front == "drawers":
        knob = ((across[0] + across[1]) / 2, (up[0] + up[1]) / 2)
    else:
        inner = across[1] - 0.05 if column[0] % 2 == 0 else across[0] + 0.05
        knob = (inner, (up[0] + up[1]) / 2)
    half = min(0.06, tall / 4)
    handle_y = (max(knob[0] - 0.02, across[0]), min(knob[0] + 0.02, across[1]))
    return [
        part(role, (x[0], middle), across, up),
        part("handle", (middle, x[1]), handle_y, (knob[1] - half, knob[1] + half)),
    ]


def _case_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan, body = Plan(size, look), body_of(size)
    base = plan.layers(LEGS_M[look.option("legs")])
    base = base if size.height > base + 1 else 0
    for i in {0, body.face}:
        for j in {0, size.width - 1}:
            plan.put("leg", i, j, range(base), "fence")
    plan.put("body", range(body.depth), plan.width, range(base, size.height))
    _FRONTS[look.option("front")](plan, body, range(base, size.height))
    return plan.blocks


def _doors(plan: Plan, body: Body, rows: range) -> None:
    low = len(rows) < 5
    layer = rows[-2] if low and len(rows) > 2 else _middle(rows)
    _closed(plan, body, rows, door_columns(plan.size.width, plan.size.per_metre), layer)


def _lockers(plan: Plan, body: Body, rows: range) -> None:
    """Give each column its own door."""
    _closed(plan, body, rows, plan.width, _middle(rows))


def _closed(plan: Plan, body: Body, rows: range, columns: Sequence[int], layers: Numbers) -> None:
    if body.front is None:
        faces(plan, "face", body.face, plan.width, rows)
        return
    plan.put("door", body.face, plan.width, rows)
    handles(plan, body, "handle", columns, layers)


def _middle(rows: range) -> int:
    return rows[len(rows) // 2] if len(rows) > 4 else rows[-1]


def _drawers(plan: Plan, body: Body, rows: range) -> None:
    width = plan.size.width
    columns = [width // 4, width - 1 - width // 4] if width > 3 else [width // 2]
    _closed(plan, body, rows, columns if plan.size.per_metre >= 3 else plan.width, rows)


def _panels(plan: Plan, body: Body, rows: range) -> None:
    if body.front is None:
        faces(plan, "face", body.face, plan.width, rows)
        return
    width = plan.size.width
    open_bay = range(width // 3, width - width // 3) if len(rows) < 3 and width > 3 else range(0)
    columns = [j for j in plan.width if j not in open_bay]
    panels(plan, body, "door", columns, rows)


def _glass(plan: Plan, body: Body, rows: range) -> None:
    """Show the upper part of a cabinet through glass, under a closed top."""
    closed = max(1, round(GLASS_FROM * len(rows))) if len(rows) > 1 else 0
    top = rows[-1:] if len(rows) > 3 else range(0)
    seen = [k for k in rows[closed:] if k not in top]
    plan.put("glass", body.face, plan.width, seen)
    if body.depth > 1:
        plan.put("door", range(body.face), plan.width, seen)
    handles(plan, body, "handle", door_columns(plan.size.width, plan.size.per_metre), rows[0])


def _sliding(plan: Plan, body: Body, rows: range) -> None:
    """Set a mirror or glass door into every second pair of columns."""
    step = 2 if plan.size.width >= 4 else 1
    columns = [j for j in plan.width if (j // step) % 2 == 0]
    plan.put("door", body.face, plan.width, rows)
    plan.put("glass", body.face, columns, rows)


def _lid(plan: Plan, body: Body, rows: range) -> None:
    top = rows[-1]
    if len(rows) == 1:
        plan.put_state("face", _chest(plan, "single"), 0, plan.width, top)
        plan.drop(range(1, body.depth), plan.width, top)
        if plan.size.width == 2:
            plan.put_state("face", _chest(plan, "right"), 0, 0, top)
            plan.put_state("face", _chest(plan, "left"), 0, 1, top)
        return
    plan.put("door", range(body.depth), plan.width, top, "slab", type="bottom")
    handles(plan, body, "handle", [plan.size.width // 2], rows[-2])


def _chest(plan: Plan, kind: str) -> str:
    return f"{plan.look.state('face')}[facing=east,type={kind}]"


_FRONTS = {
    "plain": _doors,  # Doors as one plate, which is all that a scan at 8 cm can tell.
    "doors": _doors,
    "drawers": _drawers,
    "lockers": _lockers,
    "panels": _panels,
    "glass": _glass,
    "sliding": _sliding,
    "lid": _lid,
}

CASE = Family(
    build=_case,
    design=_case_blocks,
    roles=("body", "door", "face", "glass", "handle", "leg"),
    options={"front": tuple(_FRONTS), "legs": tuple(LEGS_M)},
)
