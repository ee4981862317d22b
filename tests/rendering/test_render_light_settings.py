"""What a look comes to: the light of a place, the tone, the hours."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.jit import njit
from world2minecraft.rendering.light import (
    LightSettings,
    background_light,
    direction_shade,
    emission_light,
    light_multipliers,
    tone_map_pixel,
)
from world2minecraft.rendering.light.sky import sky_at, sun_direction
from world2minecraft.rendering.light.tone_mapping import (
    ENCODE_STEPS,
    PALING,
    SHOULDER,
    filmic_tone,
    linear_to_srgb,
    screen_tone,
    srgb_to_linear,
)


@njit
def light_of(sky, block, occluders, shade, sun, params):
    return light_multipliers(sky, block, occluders, shade, sun, params)


@njit
def shade_of(nx, ny, nz, cosine, params):
    return direction_shade(nx, ny, nz, cosine, params)


@njit
def on_screen(r, g, b, tone):
    return tone_map_pixel(r, g, b, tone)


@njit
def glow_of(emission, params):
    return emission_light(emission, params)


@njit
def sky_of(dx, dy, dz, background):
    return background_light(dx, dy, dz, background)


def tone_map(light, shoulder=SHOULDER):
    """Return linear colours compressed below 1, as the kernel should."""
    peak = light.max(axis=-1, keepdims=True)
    room = 1 - shoulder
    over = np.maximum(peak - shoulder, 0)
    pressed = np.where(over > 0, 1 - room * room / (room + over), peak)
    scaled = light * np.where(over > 0, pressed / np.maximum(peak, 1e-12), 1)
    pale = 1 - 1 / (1 + PALING * (peak - pressed))
    return scaled + (pressed - scaled) * pale


def tone_map_picture(light, tone):
    """Return the screen colours of linear light, uint8 [..., 3], as the kernel should."""
    pressed = tone_map(light, tone.shoulder) if tone.shoulder < 1 else light
    return tone.encode[(np.minimum(pressed, 1) * (ENCODE_STEPS - 1) + 0.5).astype(np.int64)]


NORMALS = np.array([(-1, 0, 0), (1, 0, 0), (0, -1, 0), (0, 1, 0), (0, 0, -1), (0, 0, 1)], float)


@pytest.mark.parametrize("normal", NORMALS)
def test_neutral_light_shows_block_colour_times_shade(normal):
    look = LightSettings(preset="neutral")
    params, tone = look.parameters(), look.tone
    for value in (8, 60, 128, 200):
        for sky in (0, 15):
            shade = shade_of(*normal, 1.0, params)
            light = light_of(sky, 15 - sky, 0, shade, 0.0, params)
            got = on_screen(*(tone.decode[value] * channel for channel in light), tone)
            assert got == pytest.approx((min(255, value * 1.1 * shade),) * 3, abs=1.6)


def test_the_game_s_light_acts_on_screen_values():
    params, tone = LightSettings(preset="game", hour=12, exposure=1).parameters(), screen_tone()
    light = light_of(15, 0, 0, 0.6, 0.0, params)
    got = on_screen(*(tone.decode[200] * channel for channel in light), tone)
    ambient = np.array([params.ambient_r, params.ambient_g, params.ambient_b])
    full = np.array([params.sky_r, params.sky_g, params.sky_b]) + ambient
    assert got == pytest.approx(200 * 0.6 * full, abs=1.6)


@pytest.mark.parametrize("brightness", [0.0, 0.5, 1.0])
def test_the_game_s_brightness_lifts_the_dark_as_in_the_game(brightness):
    params = LightSettings(preset="game", brightness=brightness, hour=12).parameters()
    for level in range(1, 16):
        moody = (level / 15) / (4 - 3 * level / 15)
        expected = moody + brightness * (1 - (1 - moody) ** 4 - moody)
        green = light_of(level, 0, 0, 1.0, 0.0, params)[1] ** (1 / 2.2) - params.ambient_g
        assert green / params.sky_g == pytest.approx(expected, abs=0.09)


def test_the_game_s_lamps_add_nothing_to_full_daylight():
    params = LightSettings(preset="game", hour=12).parameters()
    assert max(light_of(15, 15, 0, 1.0, 0.0, params)) == pytest.approx(1, abs=0.01)


def test_too_much_light_is_white_and_not_black():
    params = LightSettings(preset="game", exposure=20).parameters()
    assert min(light_of(15, 15, 0, 1.0, 0.0, params)) > 1


def test_more_light_brightens_and_corners_darken():
    for preset in ("shader", "game"):
        params = LightSettings(preset=preset).parameters()
        levels = [light_of(level, 0, 0, 1.0, 0.0, params) for level in range(16)]
        lamps = [light_of(0, level, 0, 1.0, 0.0, params) for level in range(16)]
        corners = [light_of(15, 0, count, 1.0, 0.0, params)[1] for count in range(4)]
        assert (np.diff(levels, axis=0) > 0).all()
        assert (np.diff(lamps, axis=0) > 0).all()
        assert (np.diff(corners) < 0).all()
        assert min(levels[0]) > 0
        red, _, blue = lamps[15]
        assert red > blue


def test_full_daylight_is_near_one_and_night_is_dark_and_blue():
    day = light_of(15, 0, 0, 1.0, 0.0, LightSettings(hour=12).parameters())
    night = light_of(15, 0, 0, 1.0, 0.0, LightSettings(hour=0).parameters())
    assert day == pytest.approx((1, 1, 1), abs=0.12)
    assert max(night) < 0.3
    assert night[2] > night[0]


def test_the_sun_adds_what_its_shadow_lacks():
    lit = LightSettings(hour=12).parameters()
    shadowed = LightSettings(hour=12, sun_shadow=True).parameters()
    assert lit.sun_r == 0
    in_sun = light_of(15, 0, 0, 1.0, shadowed.sun_y, shadowed)
    in_shadow = light_of(15, 0, 0, 1.0, 0.0, shadowed)
    assert in_shadow[1] < light_of(15, 0, 0, 1.0, 0.0, lit)[1] < in_sun[1]


def test_a_lamp_s_face_is_brighter_than_what_it_lights():
    params = LightSettings(hour=0).parameters()
    assert glow_of(15, params) > max(light_of(0, 14, 0, 1.0, 0.0, params))
    assert glow_of(0, params) == 0


def test_exposure_scales_light():
    once, twice = LightSettings().parameters(1.0), LightSettings().parameters(2.0)
    assert np.allclose(
        light_of(9, 4, 1, 0.7, 0, twice), 2 * np.array(light_of(9, 4, 1, 0.7, 0, once))
    )
    assert LightSettings(exposure=2.0).parameters(5.0) == twice


def test_axis_aligned_faces_have_the_game_s_shades():
    params = LightSettings(preset="game").parameters()
    got = [shade_of(*normal, 1.0, params) for normal in NORMALS]
    assert got == pytest.approx([0.6, 0.6, 0.5, 1.0, 0.8, 0.8])
    assert shade_of(np.sqrt(0.5), 0.0, np.sqrt(0.5), 1.0, params) == pytest.approx(0.7)


def test_screen_values_come_through_the_tables_unchanged():
    tone = screen_tone()
    for value in range(10, 256):
        light = float(tone.decode[value])
        assert on_screen(light, light, light, tone)[0] == pytest.approx(value, abs=1)


def test_film_keeps_texels_near_what_they_are_in_full_light():
    tone = filmic_tone()
    shown = [on_screen(*[float(tone.decode[value])] * 3, tone)[0] for value in range(256)]
    assert (np.diff(shown) >= 0).all()
    assert np.abs(np.array(shown) - np.arange(256)).max() <= 30


def test_srgb_and_back():
    values = np.linspace(0, 1, 256)
    assert np.allclose(linear_to_srgb(srgb_to_linear(values)), values)


def test_the_tone_map_keeps_order_and_never_reaches_white():
    greys = np.repeat(np.linspace(0, 30, 500)[:, None], 3, axis=1)
    mapped = tone_map(greys)
    assert (np.diff(mapped[:, 0]) > 0).all()
    assert mapped.max() < 1
    orange = np.array([3.0, 1.5, 0.5])
    red, green, blue = tone_map(orange)
    assert red > green > blue


@pytest.mark.parametrize("tone", [filmic_tone(), screen_tone()])
def test_the_kernel_s_tone_is_numpy_s(tone):
    rng = np.random.default_rng(0)
    colours = rng.random((200, 3)) * 3
    expected = tone_map_picture(colours, tone)
    for colour, shown in zip(colours, expected, strict=True):
        assert on_screen(*colour, tone) == pytest.approx(tuple(shown), abs=1)


def test_the_day_goes_round():
    assert sun_direction(6.01)[0] > 0.9
    assert sun_direction(17.99)[0] < -0.9
    for hour in np.linspace(0, 24, 49):
        sky = sky_at(float(hour))
        assert np.linalg.norm(sky.sun_direction) == pytest.approx(1)
        assert sky.sun_direction[1] > 0
    assert np.allclose(sky_at(0).light, sky_at(24).light)
    assert sky_at(17.6).horizon[0] > 2 * sky_at(17.6).horizon[2]


def test_no_sun_shines_where_it_jumps_across_the_sky():
    hours = np.linspace(0, 24, 24 * 60 + 1)
    skies = [sky_at(float(hour)) for hour in hours]
    toward = np.array([sky.sun_direction for sky in skies])
    jumps = np.flatnonzero(np.linalg.norm(np.diff(toward, axis=0), axis=1) > 0.5)
    assert len(jumps) == 2
    for n in jumps:
        assert max(*skies[n].sun, *skies[n + 1].sun) < 0.06
    light = np.array([sky.light[1] for sky in skies])
    assert (np.diff(light[hours >= 15.5]) <= 1e-12).all()


@given(st.floats(0, 15), st.floats(0.0, 1.0))
def test_lamps_reach_less_far_at_night(level, brightness):
    by_hour = {
        hour: LightSettings(hour=hour, brightness=brightness).parameters() for hour in (0, 12)
    }
    share = {
        hour: (light_of(0, level, 0, 1.0, 0.0, lit)[0] - lit.ambient_r) / lit.block_r
        for hour, lit in by_hour.items()
    }
    assert share[0] <= share[12] + 1e-9


def test_the_sky_is_lightest_at_the_horizon_and_shows_the_sun():
    look = LightSettings(hour=9)
    background = look.background()
    up, level, down = (sky_of(*d, background) for d in ((0, 1, 0), (-1, 0, 0), (0, -1, 0)))
    assert sum(level) > sum(up)
    assert sum(level) > sum(down)
    assert min(sky_of(*look.sky.sun_direction, background)) > 1
    grey = sky_of(0.0, 1.0, 0.0, LightSettings(preset="neutral").background())
    assert grey == pytest.approx((0.85,) * 3, abs=0.03)


@pytest.mark.parametrize(
    ("wrong", "reason"),
    [
        ({"preset": "nice"}, "preset must be one of shader, game, neutral, got 'nice'"),
        ({"hour": 25}, "hour must be 0 to 24, got 25"),
        ({"exposure": 0}, "exposure must be 0.01 to 100, got 0"),
        ({"brightness": 2}, "brightness must be 0 to 1, got 2"),
    ],
)
def test_a_look_out_of_range_is_refused(wrong, reason):
    with pytest.raises(ValueError) as error:
        LightSettings(**wrong)
    assert str(error.value) == reason
