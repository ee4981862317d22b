"""The exposure of scenes: darker ones are opened further, the same for all pictures of one."""

import numpy as np
import pytest
from tests.rendering.light_worlds import PALETTE

from world2minecraft.rendering.light import LightSettings, light_field, scene_exposure

LAMP = PALETTE.index("minecraft:lantern")


def room(window: bool = False, lamp: bool = False) -> np.ndarray:
    states = np.ones((12, 8, 12), np.uint16)
    states[1:-1, 1:-1, 1:-1] = 0
    if window:
        states[4:8, 2:6, 0] = PALETTE.index("minecraft:glass")
    if lamp:
        states[6, 6, 6] = LAMP
    return states


def exposure_of(states, eyes=None, **look) -> float:
    return scene_exposure(light_field(states, PALETTE), LightSettings(**look), eyes)


def test_open_air_by_day_is_as_it_is():
    states = np.zeros((8, 4, 8), np.uint16)
    states[:, 0] = 1
    assert exposure_of(states) == pytest.approx(1.1, abs=0.1)


def test_sun_shadow_keeps_the_exposure_outdoors():
    states = np.zeros((8, 4, 8), np.uint16)
    states[:, 0] = 1
    assert exposure_of(states, sun_shadow=True) == pytest.approx(exposure_of(states))


def test_darker_rooms_are_opened_further():
    dark, window, both = exposure_of(room()), exposure_of(room(True)), exposure_of(room(True, True))
    assert dark > window > both
    assert dark <= 5.0


def test_a_night_stays_darker_than_a_day():
    field = light_field(room(True), PALETTE)
    looks = [LightSettings(hour=hour) for hour in (0.0, 12.0)]
    sky = [look.parameters(scene_exposure(field, look)).sky_g for look in looks]
    assert sky[0] < sky[1] / 3


def test_only_what_is_around_the_eyes_counts():
    states = np.concatenate([room(True, True), room()], axis=0)
    bright, dark = exposure_of(states, [(6, 3, 6)]), exposure_of(states, [(18, 3, 6)])
    assert bright < exposure_of(states) <= dark
    assert exposure_of(states, [(18, 3, 6), (6, 3, 6)]) == exposure_of(
        states, [(6, 3, 6), (18, 3, 6)]
    )


@pytest.mark.parametrize("eye", [(-5, 0, 0), (0.5, 0.5, 0.5), (1e9, 0, 0)])
def test_an_eye_that_sees_nothing_leaves_the_whole_scene(eye):
    assert exposure_of(room(True), [eye]) == exposure_of(room(True))


def test_a_named_exposure_counts_and_a_neutral_picture_has_none():
    assert exposure_of(room(), exposure=2.5) == 2.5
    assert exposure_of(room(), preset="neutral") == 1.0
    assert exposure_of(np.zeros((0, 2, 2), np.uint16)) == 1.0
