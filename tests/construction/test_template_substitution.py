"""At few blocks a metre a design stands for what its own cells would not show."""

from dataclasses import replace

import numpy as np
import pytest
from build_samples import placement

from world2minecraft.construction.template_substitution import is_green, substitute_template
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import Alternative
from world2minecraft.geometry.colour import srgb_to_oklab

GREEN, BROWN, RED = ((70, 110, 40), (110, 80, 50), (160, 36, 33))


def lab(rgb):
    return srgb_to_oklab(np.array(rgb, np.uint8))


def cells(class_id, size_m, **more):
    return replace(placement("cells", class_id, (2.0, 2.0, size_m[2] / 2), size_m), **more)


def test_a_sofa_of_cells_becomes_a_sofa_where_it_stands():
    own = cells(SemanticClass.SOFA, (0.8, 2.08, 1.04), quarter_turns=2)
    found = substitute_template(own, alone=True, colour=None)
    assert found.template == "sofa"
    assert found.quarter_turns == 2
    np.testing.assert_array_equal(found.size_m, own.size_m)
    np.testing.assert_array_equal(found.center_m, own.center_m)


def test_the_best_match_of_the_right_size_is_taken():
    tried = (
        Alternative("bench", 0, 0.9),
        Alternative("armchair", 0, 0.4),
        Alternative("chair", 0, 0.3),
    )
    own = cells(SemanticClass.CHAIR, (0.62, 0.6, 0.9), alternatives=tried)
    assert substitute_template(own, alone=True, colour=None).template == "armchair"


@pytest.mark.parametrize(("rgb", "name"), [(GREEN, "plant"), (BROWN, "cells"), (RED, "cells")])
def test_what_is_green_is_a_plant(rgb, name):
    own = cells(SemanticClass.OBJS, (0.64, 0.64, 1.2))
    assert substitute_template(own, alone=True, colour=lab(rgb)).template == name
    assert is_green(lab(rgb)) == (name == "plant")


@pytest.mark.parametrize(
    "own",
    [
        cells(SemanticClass.FURN, (0.6, 1.2, 0.9)),
        cells(SemanticClass.SOFA, (0.3, 0.4, 0.3)),
        replace(cells(SemanticClass.SOFA, (0.8, 2.0, 0.9)), template="bench"),
    ],
)
def test_other_placements_are_unchanged(own):
    assert substitute_template(own, alone=True, colour=lab(GREEN)) is own


def test_what_was_cut_into_runs_stays():
    own = cells(SemanticClass.SOFA, (0.8, 2.08, 1.04))
    assert substitute_template(own, alone=False, colour=None) is own
