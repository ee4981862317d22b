"""Parts of photos: random numbers, the lobes of surfaces, and the filter."""

import numpy as np
import pytest

from world2minecraft.core.jit import lean
from world2minecraft.rendering.path_tracing.denoise import (
    SPREAD,
    SWEEPS,
    Guides,
    denoise_light,
    guides_of,
)
from world2minecraft.rendering.path_tracing.film import new_film
from world2minecraft.rendering.path_tracing.film_development import (
    dodging,
    irradiance,
    picture_exposure,
)
from world2minecraft.rendering.path_tracing.rng import EVEN_USES, hash_uint32, sample_pair
from world2minecraft.rendering.path_tracing.scattering import (
    evaluate_gloss,
    new_path,
    sample_gloss,
    set_lobes,
)


@lean
def pairs(key, use, out):
    for sample in range(len(out)):
        out[sample, 0], out[sample, 1] = sample_pair(key, sample, use)


@pytest.mark.parametrize("use", [0, 1, EVEN_USES - 1])
def test_sixteen_samples_lie_one_in_each_square(use):
    for key in range(20):
        out = np.empty((16, 2))
        pairs(hash_uint32(np.uint32(key)), use, out)
        assert (out >= 0).all() and (out < 1).all()
        for across, down in ((16, 1), (8, 2), (4, 4), (2, 8), (1, 16)):
            cells = np.floor(out * [across, down]).astype(int)
            assert len(np.unique(cells[:, 0] * down + cells[:, 1])) == 16


def test_uses_and_pixels_know_nothing_of_each_other():
    out = np.empty((6, 1024, 2))
    for row, (key, use) in enumerate(((1, 0), (1, 1), (1, 2), (2, 0), (1, 20), (1, 21))):
        pairs(hash_uint32(np.uint32(key)), use, out[row])
    columns = np.swapaxes(out, 1, 2).reshape(12, 1024)
    correlation = np.corrcoef(columns) - np.eye(12)
    assert np.abs(correlation).max() < 0.15  # By chance it is 0.1.
    assert np.abs(columns.mean(axis=1) - 0.5).max() < 0.03


@lean
def gloss_sum(state, steps):
    """The lobe's density, summed over all directions above the surface."""
    s = state[0]
    total = 0.0
    for a in range(steps):
        up = (a + 0.5) / steps
        flat = np.sqrt(1 - up * up)
        for b in range(steps):
            turn = 2 * np.pi * (b + 0.5) / steps
            _, density = evaluate_gloss(s, flat * np.cos(turn), flat * np.sin(turn), up)
            total += density * 2 * np.pi / (steps * steps)
    return total


@lean
def gloss_draws(state, count, view, out):
    s = state[0]
    for n in range(count):
        s.d[0], s.d[1], s.d[2] = view[0], view[1], view[2]
        first, second = sample_pair(np.uint32(7), n, 0)
        share, density = sample_gloss(s, first, second)
        out[n, 0], out[n, 1], out[n, 2] = s.d[0], s.d[1], s.d[2]
        out[n, 3], out[n, 4] = share, density


def surface(rough: float, down: float = -0.8):
    state = new_path()
    state["normal"][0] = state["out"][0] = (0, 0, 1)
    state["d"][0] = (np.sqrt(1 - down * down), 0, down)
    state["rough"], state["metal"] = rough, 1.0
    state["colour"][0] = 1.0
    return state


@pytest.mark.parametrize("rough", [0.5, 0.8, 1.0])
def test_the_gloss_sends_on_no_more_than_it_gets(rough):
    state, out = surface(rough), np.empty((4096, 5))
    assert 0.5 < gloss_sum(state, 300) < 1.005  # What points below the surface is missing.
    view = state["d"][0].copy()
    gloss_draws(state, len(out), view, out)
    np.testing.assert_allclose(np.linalg.norm(out[:, :3], axis=1), 1, rtol=1e-9)
    assert (out[:, 3] >= 0).all() and (out[:, 3] <= 1).all()
    # Draws fall where their density says: the mean of a function is its integral.
    height = np.where(out[:, 2] > 0, out[:, 2], 0).mean()
    state["d"][0] = view
    assert abs(height - mean_height(state, 400)) < 0.01


@lean
def mean_height(state, steps):
    s = state[0]
    total = 0.0
    for a in range(steps):
        up = (a + 0.5) / steps
        flat = np.sqrt(1 - up * up)
        for b in range(steps):
            turn = 2 * np.pi * (b + 0.5) / steps
            _, density = evaluate_gloss(s, flat * np.cos(turn), flat * np.sin(turn), up)
            total += up * density * 2 * np.pi / (steps * steps)
    return total


@lean
def lobes(state):
    set_lobes(state[0])


@pytest.mark.parametrize("metal", [0.0, 0.4, 1.0])
@pytest.mark.parametrize("rough", [0.0, 0.65, 1.0])
def test_both_lobes_together_never_send_on_more_than_all(metal, rough):
    state = surface(rough, -0.3)
    state["metal"] = metal
    lobes(state)
    whole = state["matt"][0] + state["shine"][0]
    assert (whole <= 1 + 1e-12).all() and (whole > 0.99).all()
    assert 0 <= state["gloss_odds"][0] <= 1


def once(band, rows: int) -> None:
    band((0, rows))


def guides(height: int, width: int) -> Guides:
    normal = np.zeros((height, width, 3), np.float32)
    normal[..., 1] = 1
    return Guides(np.ones((height, width), np.int32), normal, np.zeros((height, width), bool))


@pytest.mark.parametrize("turn_deg", [0.0, 22.5, 71.0])
def test_planes_are_told_apart_by_turn_and_offset(turn_deg):
    film = new_film(24, 32)
    angle = np.deg2rad(turn_deg)
    film.out[:] = [np.cos(angle), 0, np.sin(angle)]
    film.normal[:] = film.out
    along = np.random.default_rng(0).uniform(0, 200, (24, 32, 1))
    offset = np.repeat(np.arange(32) // 8, 24).reshape(32, 24).T[..., None] * 0.0625 + 90
    film.place[:] = film.out * offset + along * [-np.sin(angle), 0, np.cos(angle)]
    film.far[:] = 5
    film.far[:2] = 0  # Sky.
    film.normal[5, 6] = [0, 1, 0]
    found = guides_of(film)
    assert (found.surface[:2] == 0).all() and (found.surface[2:] > 0).all()
    assert len(np.unique(found.surface)) == 5
    assert (np.diff(found.surface[2:], axis=0) == 0).all()
    assert np.flatnonzero(found.uneven).tolist() == [5 * 32 + 6]


def test_the_filter_keeps_an_even_light_to_the_bit():
    light = np.full((24, 32, 3), 0.7, np.float32)
    count = np.full((24, 32), 16, np.float32)
    squares = (light @ np.array([0.2126, 0.7152, 0.0722])) ** 2
    result = denoise_light(light, squares.astype(np.float32), count, guides(24, 32), SWEEPS, once)
    np.testing.assert_allclose(result, 0.7, rtol=1e-6)


def grainy(rng, mean: np.ndarray, samples=16, grain=0.5):
    """Light with the grain of some samples a pixel."""
    drawn = mean[None] * (1 + grain * rng.standard_normal((samples, *mean.shape)))
    light = np.repeat(drawn.mean(axis=0)[..., None], 3, axis=-1).astype(np.float32)
    return light, (drawn**2).mean(axis=0).astype(np.float32)


def test_the_filter_takes_the_grain_and_leaves_the_shadow_s_edge():
    mean = np.where(np.arange(64)[None] < 32, 0.2, 2.0) * np.ones((48, 1))
    light, squares = grainy(np.random.default_rng(0), mean)
    count = np.full(mean.shape, 16, np.float32)
    result = denoise_light(light, squares, count, guides(*mean.shape), SWEEPS, once)[..., 0]
    assert np.abs(result / mean - 1).mean() < 0.2 * np.abs(light[..., 0] / mean - 1).mean()
    np.testing.assert_allclose(result[:, 31].mean(), 0.2, rtol=0.15)
    np.testing.assert_allclose(result[:, 32].mean(), 2.0, rtol=0.10)


def test_the_filter_never_crosses_from_one_surface_to_another():
    mean = np.where(np.arange(64)[None] < 32, 1.0, 1.1) * np.ones((48, 1))
    light, squares = grainy(np.random.default_rng(1), mean)
    two = guides(*mean.shape)
    two.surface[:, 32:] = 2
    count = np.full(mean.shape, 16, np.float32)
    result = denoise_light(light, squares, count, two, SWEEPS, once)[..., 0]
    assert abs(result[:, 31].mean() - 1.0) < 0.03 and abs(result[:, 32].mean() - 1.1) < 0.03


def test_rare_bright_samples_leave_no_stain_and_lose_nothing():
    rng = np.random.default_rng(3)
    drawn = np.where(rng.random((16, 96, 96)) < 0.003, 40.0, 0.2)
    light = np.repeat(drawn.mean(axis=0)[..., None], 3, axis=-1).astype(np.float32)
    count = np.full((96, 96), 16, np.float32)
    squares = (drawn**2).mean(axis=0).astype(np.float32)
    result = denoise_light(light, squares, count, guides(96, 96), SWEEPS, once)
    assert abs(result.mean() / light.mean() - 1) < 0.05
    inner = result[SPREAD:-SPREAD, SPREAD:-SPREAD, 0]
    assert inner.std() < 0.25 * light.std()


def test_bands_of_rows_give_what_the_whole_gives():
    light, squares = grainy(np.random.default_rng(2), np.ones((24, 32)))
    count = np.full((24, 32), 16, np.float32)
    count[4, 5] = 0

    def bands(band, rows: int) -> None:
        for row in range(0, rows, 5):
            band((row, min(row + 5, rows)))

    one = denoise_light(light, squares, count, guides(24, 32), SWEEPS, once)
    other = denoise_light(light, squares, count, guides(24, 32), SWEEPS, bands)
    assert np.array_equal(one, other)
    assert np.array_equal(one[4, 5], light[4, 5])


def film_of_light(light: float, share: float):
    """A film of one surface of a reflectance in an even light, and what it sends."""
    film = new_film(6, 8)
    film.far[:], film.samples[:], film.share[:] = 5, 4, 4 * share
    return film, np.full((6, 8, 3), light * share, np.float32)


@pytest.mark.parametrize("light", [0.05, 0.2, 0.8])
def test_exposure_follows_light_and_not_the_colour_of_things(light):
    found = []
    for share in (0.05, 0.3, 0.9):
        film, sent = film_of_light(light, share)
        bright = irradiance(sent, film)
        np.testing.assert_allclose(bright, light, rtol=1e-4)
        found.append([picture_exposure(bright, film, daylight) for daylight in (1.0, 0.4, 0.05)])
    np.testing.assert_allclose(found, [found[0]] * 3, rtol=1e-4)
    assert found[0] == sorted(found[0], reverse=True) and found[0][2] < 0.5 * found[0][0]


def test_what_is_lit_too_brightly_is_held_back_in_order():
    bright = np.geomspace(0.01, 100, 60, dtype=np.float32)[None]
    shown = bright * dodging(bright, 1.0)[..., 0]
    assert (np.diff(shown) > 0).all()
    np.testing.assert_allclose(shown[bright < 0.2], bright[bright < 0.2], rtol=0.01)
    assert shown.max() < 12
