"""kill -9 while a scene is edited: no acknowledged step is lost, and the scene opens."""

import os
import random

import pytest
from benchmarks.check_forge_kill import forked, killed

from world2minecraft.sceneforge.editor import Editor
from world2minecraft.sceneforge.scene_sources import demo_room

KILLS = 8


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork here; benchmarks/check_forge_kill.py")
def test_a_kill_at_any_moment_loses_nothing(tmp_path):
    moments, twin = random.Random(7), Editor(demo_room())
    for _ in range(KILLS):
        one = killed(tmp_path / "room", twin, moments.uniform(0, 0.2), forked)
        assert one.is_right, one
    assert twin.rev >= KILLS
