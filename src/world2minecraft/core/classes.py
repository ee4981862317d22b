"""The 12 classes of NYU semantic occupancy, and 255 for unknown.

The order and the ids are those of SSCNet, MonoScene and the paper's tables. The colours are those
of the legend in the paper's result tables.
"""

from enum import IntEnum

from world2minecraft.core.errors import UnknownNameError


class SemanticClass(IntEnum):
    """The semantic class of a cell."""

    EMPTY = 0
    CEILING = 1
    FLOOR = 2
    WALL = 3
    WINDOW = 4
    CHAIR = 5
    BED = 6
    SOFA = 7
    TABLE = 8
    TVS = 9
    FURN = 10
    OBJS = 11


UNKNOWN = 255
CLASS_COUNT = 12
CLASS_NAMES: tuple[str, ...] = tuple(member.name.lower() for member in SemanticClass)
# Readable names. Files and APIs use CLASS_NAMES.
CLASS_DISPLAY_NAMES: tuple[str, ...] = (
    *("empty", "ceiling", "floor", "wall", "window", "chair"),
    *("bed", "sofa", "table", "television", "furniture", "object"),
)
STRUCTURE_CLASSES: tuple[int, ...] = (1, 2, 3, 4)
OBJECT_CLASSES: tuple[int, ...] = (5, 6, 7, 8, 9, 10, 11)

CLASS_COLOURS: tuple[tuple[int, int, int], ...] = (
    (255, 255, 255),
    (214, 38, 40),
    (43, 160, 4),
    (158, 216, 229),
    (114, 158, 206),
    (204, 204, 91),
    (255, 186, 119),
    (147, 102, 188),
    (30, 119, 181),
    (160, 188, 33),
    (255, 127, 12),
    (196, 175, 214),
)


def class_id(name: str) -> int:
    """Return the id of a class by its name in files or its readable name.

    Raises:
        UnknownNameError: If the class is unknown.

    Example:
        >>> class_id("sofa"), class_id("tvs"), class_id("television")
        (7, 9, 9)
    """
    if name in CLASS_DISPLAY_NAMES:
        return CLASS_DISPLAY_NAMES.index(name)
    if name not in CLASS_NAMES:
        raise UnknownNameError("class", name, CLASS_DISPLAY_NAMES)
    return CLASS_NAMES.index(name)


def display_name(class_id: int) -> str:
    """Return the readable name of a class, such as ``"television"`` for the class ``"tvs"``.

    Example:
        >>> display_name(SemanticClass.TVS), display_name(UNKNOWN)
        ('television', 'unknown')
    """
    return "unknown" if class_id == UNKNOWN else CLASS_DISPLAY_NAMES[class_id]
