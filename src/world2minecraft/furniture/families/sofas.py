"""Upholstered seats: easy chairs, sofas, corner sofas and benches."""

from world2minecraft.furniture.family import Family
from world2minecraft.furniture.look import Look
from world2minecraft.furniture.plan import Plan
from world2minecraft.furniture.shapes import arms, backrest, part, slab
from world2minecraft.furniture.template import BlockSize, LocalBlock, Part, Span


def _upholstered(back_m: float, arm_m: float):
    def build(depth: float, width: float, height: float, look: Look) -> list[Part]:
        seat = min(look["seat_height"], 0.7 * height)
        return [
            slab("seat", depth, width, 0.0, seat),
            backrest(depth, width, seat, height, back_m),
            *arms(depth, width, seat, min(look["arm_height"], height), arm_m),
        ]

    return build


def _sofa_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    plan.stairs("seat", 0, plan.width, 0, "back")
    plan.put("seat", range(1, size.depth), plan.width, 0, "slab", type="bottom")
    return plan.blocks


ARMCHAIR = Family(
    build=_upholstered(0.2, 0.14),
    design=_sofa_blocks,
    roles=("seat", "back", "arm"),
    parameters={"arm_height": Span(0.54, 0.6, 0.72), "seat_height": Span(0.34, 0.42, 0.5)},
)
SOFA = Family(
    build=_upholstered(0.22, 0.18),
    design=_sofa_blocks,
    roles=("seat", "back", "arm"),
    parameters={"arm_height": Span(0.55, 0.62, 0.75), "seat_height": Span(0.34, 0.43, 0.52)},
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
        backrest(depth, width, seat, height, 0.2),
        part("back", along, rim, (seat, height)),
    ]


CORNER_SOFA = Family(
    build=_corner_sofa,
    design=_sofa_blocks,
    roles=("seat", "back", "arm"),
    parameters={
        "run_depth": Span(0.75, 0.92, 1.1),
        "seat_height": Span(0.34, 0.43, 0.52),
        "side": Span(-1.0, 1.0, 1.0),  # Above 0 it runs on along its left (+y).
    },
)


def _bench(depth: float, width: float, height: float, look: Look) -> list[Part]:
    return [slab("seat", depth, width, 0.0, height)]


def _bench_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    plan.put("seat", plan.depth, plan.width, 0, "slab", type="bottom")
    return plan.blocks


BENCH = Family(build=_bench, design=_bench_blocks, roles=("seat",))
