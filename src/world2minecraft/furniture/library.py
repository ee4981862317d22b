"""The furniture library L of the paper: names to templates.

A template is a data file in ``designs/`` (one file each), a file of the user's own, or comes from
a package outside through the entry point group ``world2minecraft.template``, which names a
``Template``. Objects are matched against those that say so; the others of a family are chosen
after the match.
"""

from functools import cache
from importlib.resources import files
from pathlib import Path

from world2minecraft.core.registry import Registry
from world2minecraft.furniture.design_files import read_design
from world2minecraft.furniture.template import Template
from world2minecraft.furniture.user_library import own_files, read_own

# Of templates that match equally well the first is taken: the plainer one.
FIRST = (
    "chair",
    "armchair",
    "office_chair",
    "stool",
    "single_bed",
    "double_bed",
    "bunk_bed",
    "sofa",
    "corner_sofa",
    "bench",
    "dining_table",
    "round_table",
    "desk",
    "coffee_table",
    "wall_tv",
    "monitor",
    "cabinet",
    "wall_cabinet",
    "counter",
    "bookcase",
    "wardrobe",
    "lamp",
    "plant",
    "box",
)


class Library(Registry):
    """Templates by name: the library's design files, then those of other packages."""

    def __init__(self):
        super().__init__("template", {})

    def names(self) -> tuple[str, ...]:
        """All names: those that are matched first in their order, then the others, sorted."""
        own = design_files()
        rest = sorted({*own, *own_files(), *super().names()} - set(FIRST))
        return (*(name for name in FIRST if name in own), *rest)

    def load(self, name: str) -> Template:
        """Return the template of this name.

        Raises:
            UnknownNameError: there is none. InputError: its file is no design.
        """
        if name in design_files():
            return read_design(design_files()[name])
        if name in own_files():
            return read_own(own_files()[name])
        return super().load(name)


@cache
def design_files() -> dict[str, Path]:
    """Return the library's design files by name, sorted."""
    folder = Path(str(files("world2minecraft.furniture"))) / "designs"
    return {path.stem: path for path in sorted(folder.glob("*.json"))}


TEMPLATES = Library()


@cache
def template(name: str) -> Template:
    """Return the template of this name.

    Raises:
        UnknownNameError: the library has none; the message suggests the nearest.
    """
    return TEMPLATES.load(name)


@cache
def templates_of(class_id: int) -> tuple[Template, ...]:
    """Return the templates of a class that objects are matched against, in the library's order."""
    every = (template(name) for name in TEMPLATES.names())
    return tuple(one for one in every if one.class_id == class_id and one.matched)


@cache
def variants_of(family: str) -> tuple[Template, ...]:
    """Return all templates of a family, in the library's order."""
    every = (template(name) for name in TEMPLATES.names())
    return tuple(one for one in every if one.family == family)
