"""Plans and films: the way is drawn where it was walked, and any text can be shown."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import ImageFont
from small_flat import flat_volume

from world2minecraft.navigation.running.film import (
    SIZE_PX,
    Moment,
    compose,
    eased_stances,
    look_at_goal,
    printable,
    wrap_text,
)
from world2minecraft.navigation.running.floor_map import GOAL, HERE, PlanMap, floor_plans
from world2minecraft.navigation.types import Episode, Instruction, Stance


def near(picture, colour):
    """The middle of the pixels that are nearly of a colour, as x and y in pixels."""
    off = np.abs(np.asarray(picture, int) - np.array(colour)).max(axis=2)
    rows, columns = np.nonzero(off < 25)
    return columns.mean(), rows.mean()


def test_a_place_is_drawn_where_it_is_on_the_plan():
    volume, _, _ = flat_volume()  # 19 blocks along x, 10 along z, from 0.
    plan = PlanMap(volume, 190)
    for x, z in ((3.0, 3.0), (14.0, 6.5)):
        # Ten pixels a block; the plan is square, so z begins 45 pixels down.
        picture = plan.picture([Stance(1.5, 65.0, 1.5), Stance(x, 65.0, z, -90.0)], ())
        assert np.allclose(near(picture, HERE), (10 * x, 45 + 10 * z), atol=3)
        picture = plan.picture([Stance(1.5, 65.0, 1.5)], [(x, 65.0, z)])
        assert np.allclose(near(picture, GOAL), (10 * x, 45 + 10 * z), atol=3)


def test_a_plan_is_cut_to_a_part():
    volume, _, _ = flat_volume()
    plan = PlanMap(volume, 190, (9.2, 0.5, 18.5, 9.5))  # Columns 9 to 19 and 0 to 10: a square.
    for x, z in ((11.0, 3.0), (16.0, 6.5)):
        picture = plan.picture([Stance(x, 65.0, z, -90.0)], ())
        assert np.allclose(near(picture, HERE), (19 * (x - 9), 19 * z), atol=4)
    whole = PlanMap(volume, 190).picture([Stance(3.0, 65.0, 3.0)], ())
    beyond = PlanMap(volume, 190, (40.0, 40.0, 50.0, 50.0)).picture([Stance(3.0, 65.0, 3.0)], ())
    np.testing.assert_array_equal(beyond, whole)  # Nothing lies there: all is drawn.


def test_a_plan_of_a_scene_shows_its_rooms(flat):
    x0, z0, x1, z1 = floor_plans(flat)._box
    assert x0 < 1 and z0 < 1 and x1 > 18 and z1 > 8  # Both rooms with their walls.


def test_the_arrow_points_where_one_looks():
    volume, _, _ = flat_volume()
    plan = PlanMap(volume, 760)
    rows = {}
    for yaw in (0.0, 180.0):  # South is down on the plan, north is up.
        picture = plan.picture([Stance(9.5, 65.0, 4.5, yaw)], ())
        off = np.abs(np.asarray(picture, int) - np.array(HERE)).max(axis=2) < 25
        wide = off.sum(axis=1)
        rows[yaw] = (wide * np.arange(len(wide))).sum() / wide.sum(), wide.argmax()
    assert (
        rows[0.0][1] < rows[0.0][0] and rows[180.0][1] > rows[180.0][0]
    )  # The wide end is behind.


def test_texts_of_anyone_fit():
    font = ImageFont.load_default(14)
    texts = ["a" * 5000, "word " * 900, "", "\u4e2d\u6587 \x1b[31m\n\n end", "\U0001f600"]
    for text in texts:
        lines = wrap_text(text, font, 200, 3)
        assert len(lines) <= 3 and all(font.getlength(line) <= 200 for line in lines)
    assert printable("a\u4e2d\x1bb\tc") == "a??b c"


def test_a_frame_has_one_size_whatever_the_view():
    volume, _, _ = flat_volume()
    plan = PlanMap(volume, 320).picture([Stance(3.0, 65.0, 3.0)], ())
    frames = [
        compose(np.zeros(shape, np.uint8), plan, "Go on " * 80, [("thinks", "x" * 900)] * 9)
        for shape in ((480, 640, 3), (224, 224, 3), (10, 900, 3))
    ]
    assert {frame.size for frame in frames} == {SIZE_PX}


def test_the_first_goal_is_labelled_once():
    volume, _, _ = flat_volume()
    plan, here = PlanMap(volume, 190), [Stance(1.5, 65.0, 1.5)]
    goal = (14.0, 65.0, 6.5)
    plain, named = (np.asarray(plan.picture(here, [goal], name), int) for name in ("", "lamp"))
    rows, columns = np.nonzero(np.abs(plain - named).max(axis=2) > 25)
    assert len(rows) and rows.max() < 45 + 65 and abs(columns.mean() - 140) < 25


moves = st.lists(
    st.tuples(st.floats(-0.25, 0.25), st.floats(-0.25, 0.25), st.floats(-40, 40)), max_size=12
)


@given(moves)
def test_the_camera_eases_from_stance_to_stance(steps):
    stances = [Stance(2.0, 65.0, 2.0, 170.0)]
    for x, z, yaw in steps:
        last = stances[-1]
        turned = (last.yaw_deg + yaw + 180) % 360 - 180
        stances.append(Stance(last.x + x, 65.0, last.z + z, turned))
    moments = [Moment(stance, 0.5 if n else 2.0, ()) for n, stance in enumerate(stances)]
    moments.append(Moment(stances[-1], 2.0, ()))
    shown, numbers = eased_stances(moments, 20.0)
    assert len(shown) == round(20 * (4 + 0.5 * len(steps)))
    assert shown[0].feet == pytest.approx(stances[0].feet)
    assert shown[-1].feet == pytest.approx(stances[-1].feet, abs=1e-6)
    assert (shown[-1].yaw_deg - stances[-1].yaw_deg + 180) % 360 == pytest.approx(180, abs=1e-6)
    yaws = np.array([one.yaw_deg for one in shown])
    assert np.abs(np.diff(yaws)).max() <= 40 / 10 + 1e-6  # Never the longer way round.
    assert numbers == sorted(numbers) and set(numbers) == set(range(len(moments)))


def test_the_camera_turns_to_a_near_goal_at_the_end():
    episode = Episode("e", "s", "s", Stance(2.0, 65.0, 2.0), ((3.0, 65.0, 2.0),), "lamp",
                      Instruction("Go to the lamp", "human", "goal"),
                      facing=(2.0, 65.0, 5.0))  # fmt: skip
    looked = look_at_goal(Stance(2.0, 65.0, 2.0, 90.0), episode, 0.25, 1.5)
    assert looked.yaw_deg == 0.0 and looked.pitch_deg == pytest.approx(26.57, abs=0.01)  # Down.
    assert look_at_goal(Stance(2.0, 65.0, 2.0), episode, 0.25, 6.5).pitch_deg == 40.0
    above = replace(episode, facing=(2.0, 68.0, 5.0))
    assert look_at_goal(Stance(2.0, 65.0, 2.0), above, 0.25, 1.5).pitch_deg < 0
    far = Stance(2.0, 65.0, 60.0, 90.0)
    assert look_at_goal(far, episode, 0.25, 1.5) == far
