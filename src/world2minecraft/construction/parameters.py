"""The parameters of a build, and where each default comes from."""

from dataclasses import dataclass

from world2minecraft.core.errors import UsageError
from world2minecraft.core.parameters import names_where, parameter

EDGES = ("barrier", "none")
STYLES = ("blocks", "display", "voxels")
SHAPES = ("calm", "cubes")
CEILINGS = ("on", "off", "glass")
LIGHTS = ("hidden", "off", "lamps")
_YES, _NO = (True, "true", "yes", "1"), (False, "false", "no", "0")
MAX_TEXT = 60  # Four lines of a sign hold about as many letters.
AT_LEAST_1, NOT_BELOW_0, SHARE = "1 or more", "0 or more", "above 0, up to 1"


@dataclass(frozen=True)
class BuildParameters:
    """How a room is built. Each default is a decision; its origin stands beside it.

    palette: the palette file; see docs/building.md.
    style: what furniture is made of: ``blocks``, designs in vanilla blocks; ``display``, fine
        geometry in block_display entities over invisible colliders; ``voxels``, each object's own
        cells by the best fitting block states.
    shapes: of which shapes objects are fitted: ``calm``, full blocks, slabs, stairs, trapdoors,
        posts and carpets; or ``cubes``, full blocks alone.
    ceiling: ``on`` where it was seen, ``glass`` there or upon the walls, or ``off``, so that one
        looks in from above.
    lights: ``hidden``, invisible light blocks, so that the room is lit and safe at night;
        ``lamps``, that and lamps that hang from the ceiling; or ``off``.
    plaque: the text of a sign near the spawn; ``auto`` is the scene's name, ``off`` no sign.
    edge: what stands where the floor ends and no wall was seen: invisible ``barrier`` blocks, so
        that nobody walks into the void, or ``none``.
    expose: lift the colours of a dim room and take its colour cast away.
    structure_colours: at most so many blocks a wall, the floor or the ceiling.
    object_colours: at most so many blocks an object; a chair has one.
    saturation: how much clear colours are strengthened.
    preference: the Oklab distance by which a block of the palette's preferred groups may lie
        farther off.
    structure_lightness_weight: how much lightness counts in telling the parts of a wall or floor
        apart.
    structure_noticed, object_noticed: the Oklab distance from which a part of a surface deserves
        a block of its own.
    lightness_weight: how much lightness counts against hue and chroma (1 = Oklab as it is).
    calm: the Oklab distance that a block gives up for each neighbour it agrees with.
    face_share: the share of a block's face that structure must cover.
    object_share: the same for objects.
    most_contradicted: the share of a template's blocks that may stand in space seen free. Above
        it the object is built from its own cells.
    chair_contradicted: the same for chairs.
    close_tops: close the unseen holes in the tops of objects (glossy counters give no depth).
    plane_reach_blocks: surfaces nearer than this to a wall's plane belong to it.
    plane_area_m2: the least area of a plane that draws others to itself.
    gap_m: unseen holes in a wall up to this wide are closed.
    """

    palette: str = parameter("vanilla")
    style: str = parameter("blocks")
    shapes: str = parameter("calm")
    ceiling: str | bool = parameter("on")
    lights: str | bool = parameter("hidden")
    plaque: str = parameter("auto")
    edge: str = parameter("barrier")
    expose: bool = parameter(True)
    structure_colours: int = parameter(
        3,
        unit="kinds of block",
        origin="a wall, its skirting and one thing on it; more looked like noise",
        bounds=AT_LEAST_1,
    )
    object_colours: int = parameter(
        6,
        unit="kinds of block",
        origin="a shelf with things on it; with two, a chair's seat and back at 4 blocks a metre "
        "read as two things",
        bounds=AT_LEAST_1,
    )
    saturation: float = parameter(
        1.2,
        unit="times",
        origin="haze, glare and the mixing of neighbouring things in a cell wash colours out; the "
        "kitchen's reds came out purple",
        bounds=NOT_BELOW_0,
    )
    preference: float = parameter(
        0.02,
        unit="Oklab",
        origin="one barely visible step, so that a table is of wood",
        bounds=NOT_BELOW_0,
    )
    structure_lightness_weight: float = parameter(
        0.05,
        unit="times",
        origin="light falls unevenly on walls and floors; the kitchen's one carpet came out grey "
        "and black at 0.15, while black and white tiles stay two",
        bounds=NOT_BELOW_0,
    )
    structure_noticed: float = parameter(
        0.12,
        unit="Oklab",
        origin="keeps the shade under the kitchen's table off its carpet",
        bounds=NOT_BELOW_0,
    )
    object_noticed: float = parameter(
        0.11,
        unit="Oklab",
        origin="keeps a dark counter from its red front and two boards of one table alike",
        bounds=NOT_BELOW_0,
    )
    lightness_weight: float = parameter(
        0.4,
        unit="times",
        origin="a red cupboard in the shade stays red; at 1 it came out brown",
        bounds=NOT_BELOW_0,
    )
    calm: float = parameter(
        0.04,
        unit="Oklab",
        origin="about the noise of fused colours on one plain surface",
        bounds=NOT_BELOW_0,
    )
    face_share: float = parameter(0.3, unit="share", origin="a wall seen in part", bounds=SHARE)
    object_share: float = parameter(
        0.25,
        unit="share",
        origin="a chair leg, one cell wide, fills a third of a face at 4 blocks a metre, and less "
        "of its uppermost one",
        bounds=SHARE,
    )
    most_contradicted: float = parameter(
        0.2,
        unit="share",
        origin="a guess, over what snapping alone does",
        bounds=SHARE,
    )
    chair_contradicted: float = parameter(
        0.35,
        unit="share",
        origin="a chair that stands at 45 degrees is built at a quarter turn, and reads as a "
        "chair; the heap of its own cells does not",
        bounds=SHARE,
    )
    close_tops: bool = parameter(True)
    plane_reach_blocks: float = parameter(
        0.75,
        unit="blocks",
        origin="noise of two cells at 4 blocks a metre, under the depth of a chimney breast",
        bounds=SHARE,
    )
    plane_area_m2: float = parameter(0.3, unit="m2", origin="a guess", bounds=NOT_BELOW_0)
    gap_m: float = parameter(
        0.6, unit="m", origin="a guess: less than a doorway", bounds=NOT_BELOW_0
    )

    def __post_init__(self):
        self._choose("ceiling", CEILINGS)
        self._choose("lights", LIGHTS)
        if not (0 < len(self.plaque) <= MAX_TEXT and self.plaque.isprintable()):
            raise UsageError(
                f"build.plaque must be auto, off or a text of up to {MAX_TEXT} printable "
                f"characters, got {self.plaque!r}"
            )
        if self.edge not in EDGES:
            raise UsageError(f"build.edge must be {' or '.join(EDGES)}, got {self.edge!r}")
        if self.style not in STYLES:
            raise UsageError(f"build.style must be one of {', '.join(STYLES)}, got {self.style!r}")
        if self.shapes not in SHAPES:
            raise UsageError(f"build.shapes must be {' or '.join(SHAPES)}, got {self.shapes!r}")
        for name in names_where(self, bounds=AT_LEAST_1):
            if getattr(self, name) < 1:
                raise UsageError(f"build.{name} must be 1 or more, got {getattr(self, name)}")
        for name in names_where(self, bounds=NOT_BELOW_0):
            if not 0 <= getattr(self, name) < 1e6:
                raise UsageError(f"build.{name} must be 0 or more, got {getattr(self, name)}")
        for name in names_where(self, bounds=SHARE):
            if not 0 < getattr(self, name) <= 1:
                raise UsageError(
                    f"build.{name} must be above 0 and at most 1, got {getattr(self, name)}"
                )

    def _choose(self, name: str, known: tuple[str, ...]) -> None:
        """Check one of some words; true and false stand for the first two."""
        given = getattr(self, name)
        value = given.lower() if isinstance(given, str) else given
        value = known[0] if value in _YES else known[1] if value in _NO else value
        if value not in known:
            raise UsageError(f"build.{name} must be one of {', '.join(known)}, got {given!r}")
        object.__setattr__(self, name, value)
