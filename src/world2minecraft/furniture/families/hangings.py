"""Flat hanging families: curtains, blinds, pictures, mirrors and radiators; also rugs.

Only a painting needs the support of a wall: plates, panes and wool stay in place on their own in
the game. Panes side by side join to a sheet in the middle of their blocks.
"""

from world2minecraft.furniture.block_plan import Plan
from world2minecraft.furniture.box_primitives import lay_sheet, part, slab
from world2minecraft.furniture.family import Family
from world2minecraft.furniture.template import BlockSize, LocalBlock, Part, Span
from world2minecraft.furniture.template_parameters import Look
from world2minecraft.minecraft.painting_placement import painting_state

FINE = 3.0  # Blocks per metre from which a curtain has folds.
FOLD_M = 0.16


def _curtain(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y, rod = depth / 2, width / 2, min(0.04, height / 4)
    side = y * look["drawn"]
    sides = {"pair": [(-y, side - y), (y - side, y)], "whole": [(-y, y)], "one": [(-y, side - y)]}
    folds = [
        fold
        for across in sides[look.option("drawn")]
        for fold in _folds(depth, across, height, rod)
    ]
    return [part("rod", (-x, x), (-y, y), (height - rod, height)), *folds]


def _folds(depth: float, across: tuple[float, float], height: float, rod: float) -> list[Part]:
    """Return cloth in folds: upright boxes, in turn at the back and at the front."""
    count = max(1, round((across[1] - across[0]) / FOLD_M))
    wide, x = (across[1] - across[0]) / count, depth / 2
    spans = [(-x, 0.3 * x), (-0.3 * x, x)]
    return [
        part(
            "cloth",
            spans[n % 2],
            (across[0] + n * wide, across[0] + (n + 1) * wide),
            (0.0, height - rod),
        )
        for n in range(count)
    ]


def _curtain_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan, top = Plan(size, look), size.height - 1
    drawn = look.option("drawn")
    side = max(1, round(size.width * look["drawn"] / 2))
    columns = set(plan.width)
    if drawn == "pair" and size.width > 2:
        columns = {j for j in plan.width if j < side or j >= size.width - side}
    elif drawn == "one":
        columns = set(range(side))
    if size.per_metre < 1.5:
        plan.put("cloth", 0, sorted(columns), 0, "banner", rotation="12")
        return plan.blocks
    shape = "pane" if look.option("cloth") == "sheer" and size.width > 1 else "full"
    plan.put("cloth", 0, sorted(columns), plan.height, shape)
    if top > 2:
        between = sorted(set(plan.width) - columns)
        plan.put_state("rod", "minecraft:chain[axis=z]", 0, between, top)
    return plan.blocks


CURTAIN = Family(
    build=_curtain,
    design=_curtain_blocks,
    roles=("cloth", "rod"),
    parameters={"drawn": Span(0.2, 0.5, 1.0)},  # The share of each half that cloth covers.
    options={"drawn": ("pair", "whole", "one"), "cloth": ("heavy", "sheer")},
)


def _blind(depth: float, width: float, height: float, look: Look) -> list[Part]:
    rail = min(0.06, height / 4)
    low = (height - rail) * (1 - look["down"])
    found = [slab("rail", depth, width, height - rail, height)]
    if look.option("kind") == "roller":
        bar = min(0.03, (height - rail - low) / 3)
        return [
            *found,
            slab("slat", 0.3 * depth, width, low + bar, height - rail),
            slab("rail", depth, width, low, low + bar),
            *_foot(width, low),
        ]
    count = max(2, round((height - rail - low) / 0.08))
    step = (height - rail - low) / count
    slats = [
        slab("slat", depth, width, low + n * step, low + (n + 0.5) * step) for n in range(count)
    ]
    cords = [
        part("rail", (-0.01, 0.01), (side - 0.01, side + 0.01), (0.0, height - rail))
        for side in (-0.3 * width, 0.3 * width)
    ]
    return [*found, *slats, *cords]


def _foot(width: float, low: float) -> list[Part]:
    """Return the cord of a blind that is not all the way down."""
    if low <= 0.01:
        return []
    y = width / 2
    return [part("rail", (-0.01, 0.01), (y - 0.02, y), (0.0, low))]


def _blind_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    low = min(round(size.height * (1 - look["down"])), size.height - 1)
    plan.panel("slat", 0, plan.width, range(low, size.height), "back")
    return plan.blocks


BLIND = Family(
    build=_blind,
    design=_blind_blocks,
    roles=("slat", "rail"),
    parameters={"down": Span(0.3, 1.0, 1.0)},
    options={"kind": ("venetian", "roller")},
)


def _framed(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y = depth / 2, width / 2
    rim = min(look["rim"], width / 4, height / 4)
    back = max(x - 0.01, 0.0)
    return [
        part("frame", (-x, x), (-y, y), (0.0, rim)),
        part("frame", (-x, x), (-y, y), (height - rim, height)),
        part("frame", (-x, x), (-y, rim - y), (rim, height - rim)),
        part("frame", (-x, x), (y - rim, y), (rim, height - rim)),
        part("low", (-x, back), (rim - y, y - rim), (rim, 0.45 * height)),
        part("high", (-x, back), (rim - y, y - rim), (0.45 * height, height - rim)),
    ]


def _framed_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    state = painting_state("east", _MOTIFS[look.option("motif")])
    plan.put_state("high", state, 0, plan.width, plan.height)
    return plan.blocks


_MOTIFS = {"plain": "abstract", "sun": "landscape", "figure": "figure"}
FRAMED = Family(
    build=_framed,
    design=_framed_blocks,
    roles=("frame", "low", "high", "spot"),
    parameters={"rim": Span(0.02, 0.05, 0.1)},
    options={"frame": ("yes", "no"), "motif": ("plain", "sun", "figure")},
)


def _wall_mirror(depth: float, width: float, height: float, look: Look) -> list[Part]:
    return [
        part._replace(role="frame" if part.role == "frame" else "glass")
        for part in _framed(depth, width, height, look)
    ]


def _wall_mirror_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    """Join bright plates to a mirror, with a frame where there is room for one."""
    plan = Plan(size, look)
    plan.panel("glass", 0, plan.width, plan.height, "back")
    if size.width > 3 and size.height > 3:
        plan.panel("frame", 0, plan.width, [0, size.height - 1], "back")
        plan.panel("frame", 0, [0, size.width - 1], plan.height, "back")
    return plan.blocks


WALL_MIRROR = Family(
    build=_wall_mirror,
    design=_wall_mirror_blocks,
    roles=("frame", "glass"),
    parameters={"rim": Span(0.02, 0.05, 0.1)},
)


def _ribbed(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y = depth / 2, width / 2
    count = max(2, round(width / 0.1))
    wide = width / count
    ribs = [
        part("body", (-x, x), (-y + n * wide, -y + (n + 0.7) * wide), (0.0, height))
        for n in range(count - 1)
    ]
    ribs.append(part("body", (-x, x), (y - 0.7 * wide, y), (0.0, height)))
    return [*ribs, part("body", (-x, 0.2 * x), (-y, y), (0.1 * height, 0.9 * height))]


def _ribbed_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    lay_sheet(plan, "body", plan.width, plan.height)
    if look.option("towel") == "yes" and size.height > 2:
        lay_sheet(plan, "towel", plan.width, range(1, size.height, 3))
    return plan.blocks


RIBBED = Family(
    build=_ribbed,
    design=_ribbed_blocks,
    roles=("body", "towel"),
    options={"towel": ("no", "yes")},
)


def _standing_mirror(depth: float, width: float, height: float, look: Look) -> list[Part]:
    x, y, rim = depth / 2, width / 2, 0.04
    return [
        part("foot", (-x, x), (-y, rim - y), (0.0, 0.06)),
        part("foot", (-x, x), (y - rim, y), (0.0, 0.06)),
        part("frame", (-0.02, 0.02), (-y, rim - y), (0.06, height)),
        part("frame", (-0.02, 0.02), (y - rim, y), (0.06, height)),
        part("frame", (-0.02, 0.02), (rim - y, y - rim), (height - rim, height)),
        part("glass", (-0.01, 0.01), (rim - y, y - rim), (0.12, height - rim)),
    ]


def _standing_mirror_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    lay_sheet(plan, "glass", plan.width, plan.height)
    if size.height > 3:
        plan.put("foot", 0, plan.width, 0)
    return plan.blocks


STANDING_MIRROR = Family(
    build=_standing_mirror,
    design=_standing_mirror_blocks,
    roles=("frame", "glass", "foot"),
)


def _rug(depth: float, width: float, height: float, look: Look) -> list[Part]:
    if look.option("pattern") != "round":
        rim = min(0.12, depth / 4, width / 4)
        return [
            slab("border", depth, width, 0.0, height / 2),
            slab("field", depth - 2 * rim, width - 2 * rim, height / 2, height),
        ]
    x, y = depth / 2, width / 2
    cuts = [(1.0, 0.38), (0.92, 0.7), (0.7, 0.92), (0.38, 1.0)]
    return [part("field", (-x * i, x * i), (-y * j, y * j), (0.0, height)) for i, j in cuts]


def _rug_blocks(size: BlockSize, look: Look) -> list[LocalBlock]:
    plan = Plan(size, look)
    pattern = look.option("pattern")
    for i in plan.depth:
        for j in plan.width:
            role = _PATTERNS[pattern](i, j, size.depth, size.width)
            if role:
                plan.put(role, i, j, 0, "carpet")
    return plan.blocks


def _bordered(i: int, j: int, depth: int, width: int) -> str:
    edge = min(i, j, depth - 1 - i, width - 1 - j)
    return "border" if min(depth, width) > 2 and edge == (0 if depth < 6 else 1) else "field"


def _striped(i: int, j: int, depth: int, width: int) -> str:
    return "border" if j % 3 == 1 else "field"


def _checked(i: int, j: int, depth: int, width: int) -> str:
    return "border" if (i + j) % 2 else "field"


def _rounded(i: int, j: int, depth: int, width: int) -> str:
    along, across = (2 * i + 1 - depth) / depth, (2 * j + 1 - width) / width
    away, narrow = along * along + across * across, min(depth, width)
    if away > 1.02 and narrow > 3:
        return ""
    return "border" if narrow > 2 and away > (0.45 if narrow > 4 else 0.85) else "field"


_PATTERNS = {"border": _bordered, "stripes": _striped, "checks": _checked, "round": _rounded}
RUG = Family(
    build=_rug,
    design=_rug_blocks,
    roles=("field", "border"),
    options={"pattern": tuple(_PATTERNS)},
)
