"""Declared parameters: their entries in docstrings, and the descriptions made of them."""

from dataclasses import dataclass

from world2minecraft.core.parameters import describe_parameters, docstring_entries, parameter


@dataclass(frozen=True)
class Inner:
    """How beds are made.

    bed_*: a side of the bed.
    height: of the frame, or of
        ``legs`` alone.
    """

    bed_width: float = parameter(0.9, unit="m", origin="a single bed")
    bed_length: float = parameter(2.0, unit="m")
    height: float = parameter(0.4, unit="m")
    legs: int = parameter(4)
    scale: float = parameter(1.0, copy_of="scale")


@dataclass(frozen=True)
class Outer:
    """How rooms are made.

    width, depth: a side of the room.
    scale: of all lengths.

    Not an entry: this paragraph.
    """

    width: float = parameter(4.0)
    depth: float = parameter(3.0)
    scale: float = parameter(1.0)
    unnamed: bool = parameter(False)
    facts: dict = parameter(dict)
    bed: Inner = parameter(Inner)


def test_each_parameter_is_described_once_in_order():
    keys = [one.key for one in describe_parameters(Outer)]
    inner = ["bed.bed_width", "bed.bed_length", "bed.height", "bed.legs"]
    assert keys == ["width", "depth", "scale", "unnamed", *inner]


def test_a_meaning_is_that_of_the_entry_of_the_parameter():
    meaning = {one.key: one.meaning for one in describe_parameters(Outer)}
    assert meaning["width"] == meaning["depth"] == "a side of the room"
    assert meaning["bed.bed_width"] == meaning["bed.bed_length"] == "a side of the bed"
    assert meaning["scale"] == "of all lengths"
    assert meaning["unnamed"] == ""


def test_an_entry_that_mentions_a_parameter_describes_it():
    meaning = {one.key: one.meaning for one in describe_parameters(Outer)}
    assert meaning["bed.legs"] == "of the frame, or of ``legs`` alone"


def test_a_description_has_default_unit_and_origin():
    bed = {one.key: one for one in describe_parameters(Outer)}["bed.bed_width"]
    assert (bed.default, bed.unit, bed.origin) == (0.9, "m", "a single bed")


def test_prose_of_a_docstring_is_no_entry():
    assert docstring_entries("How.\n\nAll of it: prose.\n    More.\n\na: one.") == {"a": "one"}
