"""The library as a whole, and what a template refuses."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.classes import OBJECT_CLASSES, SemanticClass
from world2minecraft.core.errors import UnknownNameError, World2MinecraftError
from world2minecraft.furniture import TEMPLATES, Span, Template, check_template, template
from world2minecraft.furniture.box_primitives import part, slab
from world2minecraft.furniture.library import templates_of_class
from world2minecraft.furniture.template import BlockSize, LocalBlock

NAMES = TEMPLATES.names()


def test_the_library_covers_every_object_class():
    assert len(set(NAMES)) == len(NAMES) >= 24
    held = [one.name for class_id in OBJECT_CLASSES for one in templates_of_class(class_id)]
    assert sorted(held) == sorted(name for name in NAMES if template(name).matched)
    assert all(templates_of_class(class_id) for class_id in OBJECT_CLASSES)


@pytest.mark.parametrize("name", NAMES)
def test_a_template_is_sound_and_bears_its_registered_name(name):
    assert template(name).name == name
    assert check_template(template(name)) == ()


@given(st.sampled_from(NAMES), st.tuples(*[st.floats(0, 1)] * 3), st.floats(0, 1))
def test_parts_of_any_size_in_the_spans_are_boxes_in_that_size(name, shares, share):
    one = template(name)
    size = np.array([a + (b - a) * x for (a, _, b), x in zip(one.size_m, shares, strict=True)])
    given_values = {key: a + (b - a) * share for key, (a, _, b) in one.parameters.items()}
    boxes = np.array([piece.box_m for piece in one.parts(size, given_values)])
    low = np.array([-size[0] / 2, -size[1] / 2, 0.0])
    assert (boxes[:, 3:] > boxes[:, :3]).all()
    assert (boxes[:, :3] >= low - 1e-9).all()
    assert (boxes[:, 3:] <= low + size + 1e-9).all()
    if one.mount == "floor":
        assert boxes[:, 2].min() == 0.0


def test_parameters_are_completed_with_the_usual_ones():
    found = template("armchair").complete({"seat_height": 0.4})
    assert found == {"arm_height": 0.6, "seat_height": 0.4}


def test_what_a_template_refuses():
    chair = template("chair")
    stale = "; recreate an outdated placements.json with --from furnish"
    with pytest.raises(ValueError) as unknown:
        chair.parts((0.5, 0.5, 0.9), {"legs": 3.0})
    assert (
        str(unknown.value)
        == "template chair has no parameter 'legs'; parameters: seat_height" + stale
    )
    assert isinstance(unknown.value, World2MinecraftError)
    with pytest.raises(ValueError) as outside:
        chair.parts((0.5, 0.5, 0.9), {"seat_height": 2.0})
    assert str(outside.value) == (
        "seat_height of template chair must be between 0.36 and 0.56, got 2" + stale
    )
    assert isinstance(outside.value, World2MinecraftError)
    with pytest.raises(ValueError, match="size_m must be above 0, got 0"):
        chair.parts((0.0, 0.5, 0.9))
    with pytest.raises(UnknownNameError) as name:
        template("armchiar")
    assert str(name.value) == "no template is named 'armchiar'; did you mean 'armchair'?"


def _template(build, design=None, **changed):
    span = Span(0.5, 0.5, 0.5)
    given = {"name": "thing", "class_id": SemanticClass.OBJS, "size_m": (span, span, span)}
    block = [LocalBlock((0, 0, 0), "minecraft:stone", "body")]
    return Template(**given, build=build, design=design or (lambda size, p: block), **changed)


def _lifted(depth, width, height, p):
    foot = slab("foot", depth, width, 0.0, 0.1)
    return [foot, slab("shade", depth, width, 0.3, height)]


def _wide(depth, width, height, p):
    return [slab("top", 2 * depth, width, 0.0, height)]


def _lopsided(depth, width, height, p):
    half = part("side", (0.0, depth / 2), (-width / 2, width / 2), (0.0, height))
    return [slab("foot", depth, width, 0.0, 0.2), half]


def _solid(depth, width, height, p):
    return [slab("body", depth, width, 0.0, height)]


def _outside(size: BlockSize, p):
    return [LocalBlock((0, -1, 0), "minecraft:stone", "body")]


@pytest.mark.parametrize(
    ("made", "problem"),
    [
        (
            _template(_lifted),
            "thing at 0.50 x 0.50 x 0.50: the shade is not connected to the other parts",
        ),
        (
            _template(_wide),
            "thing at 0.50 x 0.50 x 0.50: the top extends beyond the bounding box: "
            "-0.50 x -0.25 x 0.00 x 0.50 x 0.25 x 0.50",
        ),
        (
            _template(_lopsided, turns=2),
            "thing: turns is 2, but the shape is not symmetric under a half turn",
        ),
        (
            _template(_solid, _outside, turns=1),
            "thing: the design at 1 blocks per metre extends beyond its bounding box",
        ),
    ],
)
def test_the_check_says_what_is_wrong(made, problem):
    assert problem in check_template(made)
