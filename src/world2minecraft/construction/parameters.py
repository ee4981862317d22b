"""The parameters of a build, and where each default comes from."""

from dataclasses import dataclass

from world2minecraft.core.errors import UsageError

EDGES = ("barrier", "none")
STYLES = ("blocks", "display", "voxels")
SHAPES = ("calm", "cubes")
CEILINGS = ("on", "off", "glass")
LIGHTS = ("hidden", "off", "lamps")
_YES, _NO = (True, "true", "yes", "1"), (False, "false", "no", "0")
MAX_TEXT = 60  # Four lines of a sign hold about as many letters.
_DISTANCES = (
    "saturation",
    "preference",
    "structure_lightness_weight",
    "structure_noticed",
    "object_noticed",
    "lightness_weight",
    "calm",
    "gap_m",
    "plane_area_m2",
)


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
    structure_colours: at most so many blocks a wall, the floor or the ceiling. 3: a wall, its
        skirting and one thing on it; more looked like noise.
    object_colours: at most so many blocks an object. 6: a shelf with things on it. A chair has
        one: with two, seat and back at 4 blocks a metre read as two things.
    saturation: how much clear colours are strengthened. 1.2: haze, glare and the mixing of
        neighbouring things in a cell wash colours out; the kitchen's reds came out purple.
    preference: the Oklab distance by which a block of the palette's preferred groups may lie
        farther off. 0.02: one barely visible step, so that a table is of wood.
    structure_lightness_weight: how much lightness counts in telling the parts of a wall or floor
        apart. 0.05: light falls unevenly on them; the kitchen's one carpet came out grey and
        black at 0.15, while black and white tiles stay two.
    structure_noticed, object_noticed: the Oklab distance from which a part of a surface deserves
        a block of its own. 0.12 and 0.11: the former keeps the shade under the kitchen's table
        off its carpet, the latter keeps a dark counter from its red front and two
        boards of one table alike.
    lightness_weight: how much lightness counts against hue and chroma (1 = Oklab as it is).
        0.4: a red cupboard in the shade stays red; at 1 it came out brown.
    calm: the Oklab distance that a block gives up for each neighbour it agrees with. 0.04: about
        the noise of fused colours on one plain surface.
    face_share: the share of a block's face that structure must cover. 0.3: a wall seen in part.
    object_share: the same for objects. 0.25: a chair leg, one cell wide, fills a third of a face
        at 4 blocks a metre, and less of its uppermost one.
    most_contradicted: the share of a template's blocks that may stand in space seen free. Above
        it the object is built from its own cells. 0.2: a guess, over what snapping alone does.
    chair_contradicted: the same for chairs. 0.35: a chair that stands at 45 degrees is built at a
        quarter turn, and reads as a chair; the heap of its own cells does not.
    close_tops: close the unseen holes in the tops of objects (glossy counters give no depth).
    plane_reach_blocks: surfaces nearer than this to a wall's plane belong to it. 0.75: noise of
        two cells at 4 blocks a metre, under the depth of a chimney breast.
    plane_area_m2: the least area of a plane that draws others to itself. A guess.
    gap_m: unseen holes in a wall up to this wide are closed. A guess: less than a doorway.
    """

    palette: str = "vanilla"
    style: str = "blocks"
    shapes: str = "calm"
    ceiling: str | bool = "on"
    lights: str | bool = "hidden"
    plaque: str = "auto"
    edge: str = "barrier"
    expose: bool = True
    structure_colours: int = 3
    object_colours: int = 6
    saturation: float = 1.2
    preference: float = 0.02
    structure_lightness_weight: float = 0.05
    structure_noticed: float = 0.12
    object_noticed: float = 0.11
    lightness_weight: float = 0.4
    calm: float = 0.04
    face_share: float = 0.3
    object_share: float = 0.25
    most_contradicted: float = 0.2
    chair_contradicted: float = 0.35
    close_tops: bool = True
    plane_reach_blocks: float = 0.75
    plane_area_m2: float = 0.3
    gap_m: float = 0.6

    def __post_init__(self):
        self._choose("ceiling", CEILINGS)
        self._choose("lights", LIGHTS)
        if not (0 < len(self.plaque) <= MAX_TEXT and self.plaque.isprintable()):
            raise UsageError(
                f"build.plaque must be auto, off, or up to {MAX_TEXT} letters, not {self.plaque!r}"
            )
        if self.edge not in EDGES:
            raise UsageError(f"build.edge must be {' or '.join(EDGES)}, not {self.edge!r}")
        if self.style not in STYLES:
            raise UsageError(f"build.style must be {', '.join(STYLES)}, not {self.style!r}")
        if self.shapes not in SHAPES:
            raise UsageError(f"build.shapes must be {' or '.join(SHAPES)}, not {self.shapes!r}")
        for name in ("structure_colours", "object_colours"):
            if getattr(self, name) < 1:
                raise UsageError(f"build.{name} must be 1 or more, not {getattr(self, name)}")
        for name in _DISTANCES:
            if not 0 <= getattr(self, name) < 1e6:
                raise UsageError(f"build.{name} must be 0 or more, not {getattr(self, name)}")
        for name in (
            "face_share",
            "object_share",
            "most_contradicted",
            "chair_contradicted",
            "plane_reach_blocks",
        ):
            if not 0 < getattr(self, name) <= 1:
                raise UsageError(
                    f"build.{name} must be above 0, up to 1, not {getattr(self, name)}"
                )

    def _choose(self, name: str, known: tuple[str, ...]) -> None:
        """Check one of some words; true and false stand for the first two."""
        given = getattr(self, name)
        value = given.lower() if isinstance(given, str) else given
        value = known[0] if value in _YES else known[1] if value in _NO else value
        if value not in known:
            raise UsageError(f"build.{name} must be {', '.join(known)}, not {given!r}")
        object.__setattr__(self, name, value)
