"""Parameters: one truth for every default, and settings that teach."""

from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any

import pytest

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.reconstruction.layout.parameters import GeometricParameters
from world2minecraft.reconstruction.parameters import (
    Parameters,
    parameter_keys,
    with_method,
    with_settings,
)
from world2minecraft.reconstruction.semantics.completion_labeller import CompletionParameters


def numbers_without_origin(parameters: Any) -> Iterator[str]:
    for entry in fields(parameters):
        value = getattr(parameters, entry.name)
        if is_dataclass(value):
            yield from numbers_without_origin(value)
            continue
        several = value if isinstance(value, tuple) else (value,)
        is_number = any(isinstance(one, int | float) for one in several)
        if is_number and not isinstance(value, bool) and not entry.metadata.get("origin"):
            yield f"{type(parameters).__name__}.{entry.name}"


@pytest.mark.parametrize("of", [Parameters, GeometricParameters, CompletionParameters])
def test_every_number_is_declared_with_its_origin(of):
    assert list(numbers_without_origin(of())) == []


def test_every_key_can_be_set_to_its_own_value():
    parameters = Parameters()
    for key in parameter_keys():
        value = parameters
        for name in key.split("."):
            value = getattr(value, name)
        if value is not None:
            again = with_settings(parameters, [f"{key}={value}"])
            assert again.as_json() == parameters.as_json(), key


def test_settings_reach_their_stage():
    changed = with_settings(
        Parameters(),
        ["fuse.min_points=5", "find.cluster_radius=3.5", "build.ceiling=no", "clean.hole_m = 0.2"],
    )
    assert changed.fuse.min_points == 5 and changed.find.cluster_radius == 3.5
    assert changed.build.ceiling == "off" and changed.clean.hole_m == 0.2
    assert Parameters().fuse.min_points == 2, "the defaults stay"


def test_paper_method_presets_can_be_changed_by_settings():
    assert with_method(Parameters(), "best") == Parameters()
    paper = with_method(Parameters(), "paper")
    assert paper.find.paper_compat and paper.furnish.paper_compat and paper.build.paper_compat
    assert paper.register.passes == 0
    assert not with_settings(paper, ["furnish.paper_compat=no"]).furnish.paper_compat
    with pytest.raises(UnknownNameError, match="did you mean 'paper'"):
        with_method(Parameters(), "papers")


def test_the_voxel_is_said_once():
    assert Parameters(voxel_m=0.04).fuse.voxel_m == 0.04
    assert with_settings(Parameters(), ["voxel_m=0.1"]).fuse.voxel_m == 0.1


def test_capture_options_are_handed_on_as_they_are():
    changed = with_settings(Parameters(), ["capture.depth_unit=mm", "capture.every=2"])
    assert changed.capture == {"depth_unit": "mm", "every": "2"}


@pytest.mark.parametrize(
    ("setting", "text"),
    [
        ("fuse.nudge", "no parameter is named 'fuse.nudge'; did you mean 'fuse.nudge_m'?"),
        ("fuse", "--set must be KEY=VALUE, such as find.cluster_radius=3, got 'fuse'"),
        ("fuse=3", "no parameter is named 'fuse'; "),
        ("fuse.min_points=two", "fuse.min_points must be a whole number such as 2, got 'two'"),
        ("mend=maybe", "--set mend must be yes or no such as True, got 'maybe'"),
        ("clean.hole_m=nan", "--set clean.hole_m must be a number such as 0.32, got 'nan'"),
        ("fuse.sure_m=inf", "--set fuse.sure_m must be a number such as 0.003, got 'inf'"),
        ("clean.hole_m=-1", "clean.hole_m must be 0 to 10 m, got -1"),
        ("clean.floater_cells=-2", "clean.floater_cells must be 0 or more, got -2"),
        ("fuse.sure_m=0", "fuse.sure_m must be above 0, got 0"),
        ("fuse.sigma_m=-1", "fuse.sigma_m must be 0 or more, got -1"),
        ("fuse.free_log_odds=1", "fuse.free_log_odds must be 0 or less, got 1"),
        ("fuse.min_points=0", "fuse.min_points must be 1 or more, got 0"),
        ("fuse.min_share=2", "fuse.min_share must be between 0 and 1, got 2"),
        ("fuse.voxel_m=0.04", "--set cannot change fuse.voxel_m; use --voxel 0.08"),
        ("known=0.72", '--set cannot change known; use --known "table height" 0.72'),
        ("capture=x", "--set cannot change capture; use --set capture.KEY=VALUE"),
        ("build.ceiling=maybe", "build.ceiling must be one of on, off, glass, got 'maybe'"),
        ("voxel_m=9", "voxel_m must be 0.01 to 0.5 m, got 9.0"),
        ("mc_version=1.99", "1.99"),
        ("labeller=geometry", "no labeller is named 'geometry'; did you mean 'geometric'?"),
        ("predictor=deep", "no predictor is named 'deep'"),
        ("build.edge=lava", "build.edge must be barrier or none, got 'lava'"),
    ],
)
def test_a_wrong_setting_says_what_is_right(setting, text):
    words = [setting if "=" in setting or setting == "fuse" else f"{setting}=1"]
    with pytest.raises((UsageError, UnknownNameError)) as caught:
        with_settings(Parameters(), words)
    assert text in str(caught.value)
