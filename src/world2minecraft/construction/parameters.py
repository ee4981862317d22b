"""The parameters of a build and the reasons for their defaults."""

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
    """Parameters of the build stage.

    palette: Name of a palette, or path of a palette file; see docs/how-to/palettes.md.
    style: How furniture is built. ``blocks`` uses designs of vanilla blocks, ``display`` uses
        detailed block_display entities over invisible colliders, and ``voxels`` fits block states
        to the cells of each object.
    shapes: Block shapes that objects are fitted with. ``calm`` uses full blocks, slabs, stairs,
        trapdoors, posts and carpets; ``cubes`` uses full blocks only.
    ceiling: Whether the ceiling is built. ``on`` builds it where it was seen, ``glass`` also covers
        rooms without a seen ceiling with glass, and ``off`` leaves the room open from above.
    lights: How the room is lit. ``hidden`` adds invisible light blocks, which also keep it safe at
        night; ``lamps`` adds hanging lamps as well; ``off`` adds no light.
    plaque: Text of a sign near the spawn. ``auto`` uses the name of the scene, ``off`` places no
        sign.
    edge: Blocks at the edge of the floor where no wall was seen. ``barrier`` places invisible
        barriers, so that players cannot fall into the void; ``none`` places no blocks.
    expose: Whether to brighten the colours of a dark room.
    structure_colours: Maximum number of different blocks per wall, floor or ceiling.
    object_colours: Maximum number of different blocks per object; a chair always has one.
    saturation: Factor by which the chroma of saturated colours is increased.
    preference: Additional Oklab distance at which a preferred block of the palette still wins over
        a block that is closer in colour.
    structure_lightness_weight: Weight of lightness when a wall or floor is divided into parts of
        different colour.
    structure_noticed, object_noticed: Minimum Oklab distance at which a part of a surface gets its
        own block.
    lightness_weight: Weight of lightness compared to hue and chroma; 1 is plain CIEDE2000.
    calm: Additional Oklab distance accepted for each neighbouring block of the same kind.
    face_share: Minimum share of a block's face that structure must cover.
    object_share: Minimum share of a block's face that an object must cover.
    most_contradicted: Maximum share of a template's blocks in space seen as free. Above this share,
        the object is built from its own cells.
    chair_contradicted: Maximum share of a chair template's blocks in space seen as free.
    simple_below: Confidence below which an object built from its own cells becomes a simple volume
        of a few boxes and one material.
    close_tops: Whether to close unseen holes in the tops of objects, such as glossy counters
        without measured depth.
    plane_reach_blocks: Maximum distance, in blocks, at which a surface is snapped to a wall plane.
    plane_area_m2: Minimum area of a plane that other surfaces are snapped to.
    gap_m: Maximum width of the unseen holes in walls that the builder closes.
    paper_compat: Whether to build what was found and nothing else: door leaves are solid, and rugs
        are distinguished from their floor by hue alone.
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
        origin="a wall, its skirting board and one object on it; more blocks look like noise",
        bounds=AT_LEAST_1,
    )
    object_colours: int = parameter(
        6,
        unit="kinds of block",
        origin="a shelf with objects on it; a chair with two blocks looks like two objects at 4 "
        "blocks per metre",
        bounds=AT_LEAST_1,
    )
    saturation: float = parameter(
        1.2,
        unit="times",
        origin="haze, glare and mixed cells reduce the saturation; without the factor, the reds of "
        "the sample kitchen become purple",
        bounds=NOT_BELOW_0,
    )
    preference: float = parameter(
        0.02,
        unit="Oklab",
        origin="one barely visible step, so that tables are made of wood",
        bounds=NOT_BELOW_0,
    )
    structure_lightness_weight: float = parameter(
        0.05,
        unit="times",
        origin="walls and floors are lit unevenly; at 0.15, the carpet of the sample kitchen "
        "becomes grey and black, while black and white tiles stay different at the default",
        bounds=NOT_BELOW_0,
    )
    structure_noticed: float = parameter(
        0.12,
        unit="Oklab",
        origin="ignores the shadow under the table of the sample kitchen",
        bounds=NOT_BELOW_0,
    )
    object_noticed: float = parameter(
        0.11,
        unit="Oklab",
        origin="separates a dark counter from its red front, but not two boards of one table",
        bounds=NOT_BELOW_0,
    )
    lightness_weight: float = parameter(
        0.7,
        unit="times",
        origin="photos and worlds of 9 real and 8 generated rooms differ least",
        bounds=NOT_BELOW_0,
    )
    calm: float = parameter(
        0.04,
        unit="Oklab",
        origin="about the noise of fused colours on a uniform surface",
        bounds=NOT_BELOW_0,
    )
    face_share: float = parameter(0.3, unit="share", origin="a partly seen wall", bounds=SHARE)
    object_share: float = parameter(
        0.25,
        unit="share",
        origin="a chair leg of one cell covers a third of a block's face at 4 blocks per metre, "
        "and less of the uppermost block",
        bounds=SHARE,
    )
    most_contradicted: float = parameter(
        0.2,
        unit="share",
        origin="a guess, above the share caused by snapping to blocks",
        bounds=SHARE,
    )
    chair_contradicted: float = parameter(
        0.35,
        unit="share",
        origin="a chair rotated by 45 degrees is built at a quarter turn and is recognizable, "
        "unlike a chair built from its cells",
        bounds=SHARE,
    )
    simple_below: float = parameter(
        0.5, unit="probability", origin="equal to furnish.min_confidence", bounds=SHARE
    )
    close_tops: bool = parameter(True)
    plane_reach_blocks: float = parameter(
        0.75,
        unit="blocks",
        origin="noise of two cells at 4 blocks per metre, less than the depth of a chimney breast",
        bounds=SHARE,
    )
    plane_area_m2: float = parameter(0.3, unit="m2", origin="a guess", bounds=NOT_BELOW_0)
    gap_m: float = parameter(
        0.6, unit="m", origin="a guess: narrower than a doorway", bounds=NOT_BELOW_0
    )
    paper_compat: bool = parameter(False)

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
        """Check that a value is one of the known words; true and false mean the first two."""
        given = getattr(self, name)
        value = given.lower() if isinstance(given, str) else given
        value = known[0] if value in _YES else known[1] if value in _NO else value
        if value not in known:
            raise UsageError(f"build.{name} must be one of {', '.join(known)}, got {given!r}")
        object.__setattr__(self, name, value)
