"""Sofa families: armchairs, sofas, corner sofas and benches.

If the material has stairs and slabs (wood, stone), the heights of seat, arms and back are accurate
to half a block. Cloth only has whole blocks, so a sofa in a strong colour looks thickly
upholstered.
"""

from collections.abc import Iterable
from typing import NamedTuple

from world2minecraft.furniture.block_plan import FACING, Plan, Side
from world2minecraft.furniture.box_primitives import arms, backrest, part, slab
from world2minecraft.furniture.family import Family
from world2minecraft.furniture.template import BlockSize, Build, LocalBlock, Part, Span
from world2minecraft.furniture.template_parameters import Look

FINE = 3.0  # Blocks per metre from which a seat has layers of its own.
WIDE = 3  # Blocks of a seat from which its ends may be arms.
BACK_M, ARM_M = 0.2, 0.18


def _upholstered(back_m: float, arm_m: float) -> Build:
    def build(depth: float, width: float, height: float, look: Look) -> list[Part]:
        """Return the seat, the backrest and the arms."""
        seat = min(look["seat_height"], 0.7 * height)
        ends = arms(depth, width, seat, min(look["arm_height"], height), arm_m)
        # Full arms are upholstered like the seat, low ones are of wood.
        padded = [one._replace(role="seat") for one in ends]
        sides = {"none": [], "low": ends, "full": padded}[look.option("arms")]
        return [
            slab("seat", depth, width, 0.0, seat),
            backrest(depth, width, seat, height, back_m),
            *sides,
        ]

    return build


class _Run(NamedTuple):
    """The cells of a seat in plan: its back cells with their side, and its arm cells."""

    seat: list[tuple[int, int]]
    back: list[tuple[int, int, Side]]
    arms: list[tuple[int, int, Side]]


def _straight(size: BlockSize, armed: bool) -> _Run:
    last = size.width - 1
    back: list[tuple[int, int, Side]] = [(0, j, "back") for j in range(size.width)]
    ends: list[tuple[int, Side]] = [(0, "right"), (last, "left")] if armed and last else []
    sides: list[tuple[int, int, Side]] = [
        (i, j, side) for j, side in ends for i in range(size.depth)
    ]
    return _Run([(i, j) for i in range(size.depth) for j in range(size.width)], back, sides)


def _lay(plan: Plan, run: _Run) -> list[LocalBlock]:
    shaped = plan.look.has("seat", "stairs", "slab")
    if plan.size.per_metre >= FINE:
        (_shaped_layers if shaped else _plush_layers)(plan, run)
    elif shaped:
        _stair_seat(plan, run)
    else:
        _plush_seat(plan, run)
    return plan.blocks


def _stair_seat(plan: Plan, run: _Run) -> None:
    """Lay a seat of slabs with stairs as back and arms, and panels over the back."""
    for i, j in run.seat:
        plan.slab("seat", i, j, 0)
    deep = plan.size.depth > 1
    turned: dict[tuple[int, int], Side] = {(i, j): side for i, j, side in run.arms}
    for i, j, side in run.back:
        plan.stairs("seat", i, j, 0, side)
    for (i, j), side in turned.items():
        corner = any((i, j) == cell[:2] for cell in run.back)
        if not corner or (not deep and plan.size.width >= WIDE):
            plan.stairs("arm", i, j, 0, side)
    for i, j, side in run.back:
        if plan.look.has("back", "trapdoor"):
            plan.panel("back", i, j, range(1, plan.size.height), side)
        elif plan.size.height > 1:
            _column(plan, "back", i, j, _halves(plan.size.exact[2]))


def _plush_seat(plan: Plan, run: _Run) -> None:
    """Lay a seat of whole blocks; its back is a layer higher, its arms have a plate on them."""
    if plan.size.height == 1:
        _as_stairs(plan, run)
        return
    for i, j in run.seat:
        plan.put("seat", i, j, 0)
    for i, j, _ in run.arms if plan.size.width >= WIDE else ():
        if plan.look.has("arm", "trapdoor"):
            plan.plate("arm", i, j, 1, "bottom")
    for i, j, _ in run.back:
        plan.put("back", i, j, range(1, plan.size.height))


def _as_stairs(plan: Plan, run: _Run) -> None:
    """Lay one layer of stairs and slabs: blocks of cloth would read as a box.

    They are of the arms' wood, or of what comes nearest to the seat's colour and has stairs.
    """
    slab = plan.look.state("arm", "slab", type="bottom")
    for i, j in run.seat:
        plan.put_state("seat", slab, i, j, 0)
    ends: dict[tuple[int, int], Side] = {(i, j): side for i, j, side in run.arms}
    if plan.size.width < WIDE:
        ends = {}
    for i, j, side in run.back:
        facing = FACING[ends.get((i, j), side)]
        stairs = plan.look.state("arm", "stairs", facing=facing, half="bottom")
        plan.put_state("seat", stairs, i, j, 0)


def _shaped_layers(plan: Plan, run: _Run) -> None:
    """Lay seat, arms and back at their heights, to half a block."""
    look, scale = plan.look, plan.size.per_metre
    seat = _halves(look["seat_height"] * scale)
    top = max(_halves(plan.size.exact[2]), seat + 1)
    arm = min(max(_halves(look.get("arm_height", 0.0) * scale), seat + 0.5), top)
    for i, j in run.seat:
        _column(plan, "seat", i, j, seat)
    for i, j, _ in run.arms:
        _column(plan, "arm", i, j, arm)
    for i, j, _ in run.back:
        _column(plan, "back", i, j, top)


def _column(plan: Plan, role: str, i: int, j: int, height: float) -> None:
    whole = int(height)
    plan.put(role, i, j, range(whole))
    if height > whole:
        plan.slab(role, i, j, whole)


def _plush_layers(plan: Plan, run: _Run) -> None:
    """Lay seat, arms and back in whole blocks, each higher than the one before."""
    look, scale = plan.look, plan.size.per_metre
    seat = max(1, round(look["seat_height"] * scale))
    low = look.option("arms") == "low"
    arm = seat if low else seat + 1
    # A back no higher than the arms would make a tub of it.
    back = max(int(plan.size.exact[2] + 0.65), seat + 1, arm if low else arm + 1)
    for i, j in run.seat:
        plan.put("seat", i, j, range(seat))
    for i, j, _ in run.arms if plan.size.width >= WIDE else ():
        plan.put("seat", i, j, range(arm))
        if low and look.has("arm", "trapdoor"):
            plan.plate("arm", i, j, arm, "bottom")
    for i, j, _ in run.back:
        plan.put("back", i, j, range(back))
        plan.drop(i, j, range(back, back + 2))


def _halves(height: float) -> float:
    return max(0.5, int(2 * height + 0.5) / 2)


def _sofa_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    return _lay(plan, _straight(size, look.option("arms") != "none"))


ARMS = {"arms": ("full", "low", "none")}
ARMCHAIR = Family(
    build=_upholstered(0.2, 0.14),
    design=_sofa_blocks,
    roles=("seat", "back", "arm"),
    parameters={"arm_height": Span(0.54, 0.6, 0.72), "seat_height": Span(0.34, 0.42, 0.5)},
    options=ARMS,
)
SOFA = Family(
    build=_upholstered(0.22, ARM_M),
    design=_sofa_blocks,
    roles=("seat", "back", "arm"),
    parameters={"arm_height": Span(0.55, 0.62, 0.75), "seat_height": Span(0.34, 0.43, 0.52)},
    options=ARMS,
)


def _corner_sofa(depth: float, width: float, height: float, look: Look) -> list[Part]:
    seat = min(look["seat_height"], 0.7 * height)
    run, wing = min(look["run_depth"], depth), min(look["run_depth"], width)
    y = width / 2
    across, rim = (
        ((y - wing, y), (y - 0.2, y)) if look["side"] > 0 else ((-y, wing - y), (-y, 0.2 - y))
    )
    along = (-depth / 2, depth / 2)
    return [
        part("seat", (-depth / 2, run - depth / 2), (-y, y), (0.0, seat)),
        part("seat", along, across, (0.0, seat)),
        backrest(depth, width, seat, height, BACK_M),
        part("back", along, rim, (seat, height)),
    ]


def _corner_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    wide = max(1, round(look["run_depth"] * size.per_metre))
    run, wing = min(wide, size.depth), min(wide, size.width)
    left = look["side"] > 0
    last = size.width - 1
    corner = last if left else 0
    seat = [
        (i, j)
        for i in range(size.depth)
        for j in range(size.width)
        if i < run or (last - j if left else j) < wing
    ]
    sides: list[tuple[range, range, Side]] = [
        (range(1), range(size.width), "back"),
        (range(1, size.depth), range(corner, corner + 1), "left" if left else "right"),
    ]
    back: list[tuple[int, int, Side]] = [
        (i, j, side) for along, across, side in sides for i in along for j in across
    ]
    return _lay(plan, _Run(seat, back, []))


CORNER_SOFA = Family(
    build=_corner_sofa,
    design=_corner_blocks,
    roles=("seat", "back", "arm"),
    parameters={
        "run_depth": Span(0.75, 0.92, 1.1),
        "seat_height": Span(0.34, 0.43, 0.52),
        "side": Span(-1.0, 1.0, 1.0),  # Above 0 it runs on along its left (+y).
    },
    options=ARMS,
)


def _bench(depth: float, width: float, height: float, look: Look) -> list[Part]:
    return [slab("seat", depth, width, 0.0, height)]


def _bench_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    if not look.has("seat", "slab"):
        _ottoman(plan)
    elif size.height == 1:
        _low_bench(plan)
    else:
        top = _halves(size.exact[2])
        layer = int(top - 0.5)
        plan.slab("seat", plan.depth, plan.width, layer, "bottom" if top % 1 else "top")
        _feet(plan, layer + (0 if top % 1 else 1), sorted({0, size.width - 1}))
    return plan.blocks


def _ottoman(plan: Plan) -> None:
    plan.put("seat", plan.depth, plan.width, range(max(1, round(plan.size.exact[2]))))


def _low_bench(plan: Plan) -> None:
    if plan.size.exact[2] <= 0.75 or plan.size.width == 1:
        plan.slab("seat", plan.depth, plan.width, 0)
        return
    last = plan.size.width - 1
    plan.slab("seat", plan.depth, range(1, last), 0, "top")
    plan.stairs("seat", plan.depth, 0, 0, "right", "top")
    plan.stairs("seat", plan.depth, last, 0, "left", "top")


def _feet(plan: Plan, top: int, across: Iterable[int]) -> None:
    for j in across:
        plan.put("seat", plan.depth, j, range(top))


BENCH = Family(build=_bench, design=_bench_blocks, roles=("seat",))
