"""Laws of light: furnaces, a lamp's light by hand, shadows, mirrors, the sun's way."""

import numpy as np
import pytest
from scenes import volume_of

from world2minecraft.core.coordinates import look_at
from world2minecraft.core.types import BlockVolume, Camera
from world2minecraft.rendering import LightSettings, prepare_scene
from world2minecraft.rendering.block_elements import BlockModel, Element, ElementFace, face_uv
from world2minecraft.rendering.light.sky import Background, sun_direction
from world2minecraft.rendering.path_tracing import emitters_of
from world2minecraft.rendering.path_tracing.film import Film, new_film
from world2minecraft.rendering.path_tracing.light_sampling import UNSEEN_SOFT
from world2minecraft.rendering.path_tracing.path_kernel import trace_rows
from world2minecraft.rendering.path_tracing.scattering import PathScene, new_path
from world2minecraft.rendering.path_tracing.sky_light import SUN_COSINE, SkyLight, sky_light
from world2minecraft.rendering.ray_caster.ray import GridCamera
from world2minecraft.rendering.scene import BlockScene
from world2minecraft.rendering.texture import Texture

SMALL = Camera(32, 24, 24.0, 24.0, 16.0, 12.0)


def uniform_sky(red, green, blue):
    """Return a uniform sky without a sun, for white furnace tests."""
    colour = (red, green, blue)
    background = Background._make([*colour, *colour, *colour, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0])
    return SkyLight(background, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, SUN_COSINE)


NO_SKY = uniform_sky(0.0, 0.0, 0.0)
GREY_SRGB = 188  # 0.5 of linear light.
GREY = ((GREY_SRGB / 255 + 0.055) / 1.055) ** 2.4


class OneGrey:
    """All blocks cubes of one grey; names tell what else: glowing, polished metal, a floor."""

    def __init__(self, kinds: dict[str, str] | None = None):
        self.kinds = kinds or {}

    def model(self, state: str) -> BlockModel:
        if state in ("minecraft:air", "minecraft:light[level=15]"):
            return BlockModel()
        kind = self.kinds.get(state, "grey")
        faces = tuple(ElementFace(kind, face_uv(side, (0, 0, 0), (1, 1, 1))) for side in range(6))
        return BlockModel(
            (Element((0, 0, 0), (1, 1, 1), faces, emission=15 if kind == "glow" else 0),)
        )

    def texture(self, name: str) -> Texture:
        colour = np.full((2, 2, 4), (GREY_SRGB,) * 3 + (255,), np.uint8)
        if name == "red":
            colour[..., 1:3] = 0
        if name == "mirror":
            colour[..., :3] = 255
            return Texture(
                colour, roughness=np.zeros((2, 2), np.uint8), metal=np.full((2, 2), 255, np.uint8)
            )
        return Texture(colour)


def volume(states: np.ndarray, palette=("minecraft:air", "minecraft:stone")) -> BlockVolume:
    whole = volume_of(np.zeros_like(states))
    return BlockVolume(
        states.astype(np.uint16), palette, np.zeros(states.shape, np.uint8),
        np.zeros(states.shape, np.uint16), whole.corner, whole.block_to_room,
    )  # fmt: skip


def film_of(
    scene: BlockScene, eye, target, sky: SkyLight, samples=16, depth=4, camera=SMALL, lamps=None,
    seed=1,
) -> Film:  # fmt: skip
    """Trace a scene from a cell's place towards another, in cells."""
    grid_to_room = np.linalg.inv(scene.room_to_grid)
    eye, target = (
        grid_to_room[:3, :3] @ np.array(at, float) + grid_to_room[:3, 3] for at in (eye, target)
    )
    pose = np.ascontiguousarray((scene.room_to_grid @ look_at(eye, target))[:3])
    rays = np.array([camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px])
    film = new_film(camera.height_px, camera.width_px)
    decode = LightSettings().tone.decode
    trace_rows(
        PathScene(scene.tables, scene.material, scene.side_px, decode),
        emitters_of(scene) if lamps is None else lamps, sky, GridCamera(pose, rays, 1.0),
        (0, camera.height_px), (0, samples), np.uint32(seed), depth, new_path(), film,
    )  # fmt: skip
    return film


def radiance(film: Film) -> np.ndarray:
    count = film.samples[..., 1:]
    return (film.light + film.other_light + film.gloss) / count


def closed_room(side=6) -> np.ndarray:
    states = np.ones((side, side, side), np.uint16)
    states[1:-1, 1:-1, 1:-1] = 0
    return states


def test_a_block_under_an_even_sky_shows_its_albedo():
    states = np.zeros((3, 3, 3), np.uint16)
    states[1, 1, 1] = 1
    film = film_of(prepare_scene(volume(states), OneGrey()), (4, 4, 5), (1.5, 1.5, 1.5),
                   uniform_sky(1.0, 1.0, 1.0), samples=4)  # fmt: skip
    whole = film.samples[..., 0] == film.samples[..., 1]
    np.testing.assert_allclose(radiance(film)[whole], GREY, rtol=1e-3)


def test_a_closed_room_that_shines_everywhere_is_a_furnace():
    states = closed_room()
    scene = prepare_scene(volume(states), OneGrey({"minecraft:stone": "glow"}))
    lamps = emitters_of(scene)
    shine = 0.3
    lamps = lamps._replace(light=np.full_like(lamps.light, shine))
    film = film_of(scene, (3, 3, 3), (4.7, 2.4, 3.2), NO_SKY, samples=64, depth=40, lamps=lamps)
    # The surfaces' own light is seen apart from what they send on of each other's.
    expected = shine / (1 - GREY) - shine
    assert abs(radiance(film).mean() / expected - 1) < 0.03


def test_no_light_comes_from_nothing():
    film = film_of(prepare_scene(volume(closed_room()), OneGrey()), (3, 3, 3), (5, 3, 3.2),
                   sky_light(LightSettings()), samples=4)  # fmt: skip
    assert not radiance(film).any()


def floor_with(*blocks: tuple[int, int, int, int], size=(17, 8, 17)) -> np.ndarray:
    states = np.zeros(size, np.uint16)
    states[:, 0] = 1
    for i, j, k, state in blocks:
        states[i, j, k] = state
    return states


LAMP = ("minecraft:air", "minecraft:stone", "minecraft:glowstone", "minecraft:dirt")
LAMP_LOOKS = OneGrey({"minecraft:glowstone": "glow"})


def from_box(lamps, row, at, up, steps=40) -> np.ndarray:
    """The light that a point gets of a shining box, over pi, by summing up its faces."""
    total = np.zeros(3)
    share = (np.arange(steps) + 0.5) / steps
    for pair in range(3):
        for side in range(2):
            if not lamps.shown[row] >> (2 * pair + side) & 1:
                continue
            first, second = lamps.edges[row][(pair + 1) % 3], lamps.edges[row][(pair + 2) % 3]
            start = lamps.corner[row] + side * lamps.edges[row][pair]
            places = start + share[:, None, None] * first + share[None, :, None] * second
            out = lamps.out[row][pair] * (1 if side else -1)
            way = places - at
            far = np.linalg.norm(way, axis=-1)
            lit = np.maximum(way @ up, 0) * np.maximum(-(way @ out), 0) / far**4
            total += lit.mean() * lamps.area[row, pair] * lamps.light[row] / np.pi
    return total


def test_the_light_of_a_lamp_is_the_one_worked_out_by_hand():
    scene = prepare_scene(volume(floor_with((8, 4, 8, 2)), LAMP), LAMP_LOOKS)
    lamps = emitters_of(scene)
    assert len(lamps.cell) == 1 and lamps.shown[0] == 63
    tiny = Camera(4, 4, 400.0, 400.0, 2.0, 2.0)
    for at in ((8.5, 1, 8.5), (4.5, 1, 7.0), (14.0, 1, 12.0)):
        film = film_of(scene, (at[0], 2.5, at[2] + 1e-3), at, NO_SKY, 256, 1, tiny)
        expected = GREY * from_box(lamps, 0, np.array(at), np.array([0.0, 1.0, 0.0]))
        np.testing.assert_allclose(radiance(film).mean(axis=(0, 1)), expected, rtol=0.02)


def test_a_lamp_that_no_list_names_is_found_by_chance_alone():
    scene = prepare_scene(volume(floor_with((8, 3, 8, 2)), LAMP), LAMP_LOOKS)
    dim = emitters_of(scene)
    dim = dim._replace(light=dim.light * 0.05)  # Else rare light would be cut.
    unlisted = dim._replace(near_start=np.zeros_like(dim.near_start), near=dim.near[:0])
    tiny = Camera(8, 8, 400.0, 400.0, 4.0, 4.0)
    means = [
        radiance(film_of(scene, (7.5, 2.5, 7.5), (7.5, 1, 7.4), NO_SKY, 512, 2, tiny, one)).mean()
        for one in (dim, unlisted)
    ]
    assert abs(means[1] / means[0] - 1) < 0.08


def test_a_block_keeps_a_lamp_s_light_off_the_floor():
    blocks = [(8, 5, 8, 2), *((i, 3, k, 3) for i in range(6, 11) for k in range(6, 11))]
    scene = prepare_scene(volume(floor_with(*blocks), LAMP), LAMP_LOOKS)
    film = film_of(scene, (8.5, 2.5, 8.0), (8.5, 1, 8.5), NO_SKY, 16, 1)
    assert radiance(film)[10:14, 14:18].max() == 0


def test_a_block_of_light_that_is_not_seen_lights_all_the_same():
    palette = ("minecraft:air", "minecraft:stone", "minecraft:light[level=15]")
    whole = volume(floor_with((8, 4, 8, 2)), palette)
    scene = prepare_scene(whole, OneGrey(), hidden_lamps=True)
    lamps = emitters_of(scene)
    assert lamps.element.tolist() == [-1]
    tiny = Camera(4, 4, 400.0, 400.0, 2.0, 2.0)
    film = film_of(scene, (8.5, 2.5, 9.0), (8.5, 1, 8.5), NO_SKY, 256, 1, tiny)
    soft = 3.25**2 / (3.25**2 + UNSEEN_SOFT**2)
    expected = GREY * soft * from_box(lamps, 0, np.array([8.5, 1, 8.5]), np.array([0, 1.0, 0]))
    np.testing.assert_allclose(radiance(film).mean(axis=(0, 1)), expected, rtol=0.05)


def test_a_lamp_that_is_turned_is_where_its_box_is():
    turn = np.eye(4)
    turn[:3, :3] = [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]
    turn[:3, 3] = [0.0, 0.0, 1.0]

    class Turned(OneGrey):
        def model(self, state: str) -> BlockModel:
            if "glow" not in state:
                return super().model(state)
            faces = tuple(ElementFace("glow", np.zeros((2, 4))) for _ in range(6))
            box = (0.0, 0.25, 0.5), (0.25, 0.75, 1.0)
            return BlockModel((Element(*box, faces, turn=turn, emission=15),))

    lamps = emitters_of(prepare_scene(volume(floor_with((8, 4, 8, 2)), LAMP), Turned()))
    np.testing.assert_allclose(lamps.centre[0], [8.75, 4.5, 8 + 1 - 0.125], atol=1e-6)
    for pair in range(3):
        np.testing.assert_allclose(
            lamps.edges[0, pair], lamps.thick[0, pair] * lamps.out[0, pair], atol=1e-6
        )


@pytest.mark.parametrize(("lamp", "glows"), [(2, True), (1, False)])
def test_a_panel_on_a_lamp_glows_as_its_shade(lamp, glows):
    class Shades(OneGrey):
        def model(self, state: str) -> BlockModel:
            if state != "minecraft:oak_trapdoor":
                return super().model(state)
            low, high = (0.0, 0.0, 0.0), (0.1875, 1.0, 1.0)
            faces = tuple(ElementFace("grey", face_uv(side, low, high)) for side in range(6))
            return BlockModel((Element(low, high, faces),))

    states = floor_with((8, 2, 8, lamp), (9, 2, 8, 4))
    palette = (*LAMP, "minecraft:oak_trapdoor")
    scene = prepare_scene(volume(states, palette), Shades({LAMP[2]: "glow"}))
    film = film_of(scene, (14, 2.5, 8.5), (9, 2.5, 8.5), NO_SKY, 4, 1)
    assert (film.seen[12, 16].max() > 0) == glows
    np.testing.assert_allclose(film.place[12, 16, 0], 9.1875, atol=1e-4)


@pytest.mark.parametrize("hour", [9.0, 15.0])
def test_shadows_point_away_from_the_sun(hour):
    states = floor_with((8, 1, 8, 1), (8, 2, 8, 1))
    scene = prepare_scene(volume(states), OneGrey())
    sky = sky_light(LightSettings(hour=hour))
    black = uniform_sky(0.0, 0.0, 0.0).background
    sun = sky.background._replace(
        **{
            name: getattr(black, name)
            for name in black._fields
            if name[-2:] not in ("_x", "_y", "_z")
        }
    )
    film = film_of(scene, (8.5, 14, 8.6), (8.5, 1, 8.5), sky._replace(background=sun), 4, 1)
    x, y, z = sun_direction(hour)
    floor = (film.out[..., 1] > 0.9) & (np.abs(film.place[..., 1] - 1) < 1e-3)
    dark = floor & (radiance(film)[..., 0] == 0)
    mean = film.place[dark].mean(axis=0) - [8.5, 1, 8.5]
    assert mean[0] * x < 0 and mean[2] * z < 0
    lit = floor & (film.samples[..., 0] == 4) & (radiance(film)[..., 0] > 0)
    brightest = np.quantile(radiance(film)[lit][:, 0], 0.9)
    np.testing.assert_allclose(brightest, GREY * sky.sun_r * y, rtol=0.02)


def test_a_mirror_of_metal_shows_what_lies_before_it():
    palette = ("minecraft:air", "minecraft:stone", "minecraft:iron_block", "minecraft:red_wool")
    states = np.zeros((9, 9, 9), np.uint16)
    states[:, :, 0], states[:, :, 8] = 2, 3
    looks = OneGrey({"minecraft:iron_block": "mirror", "minecraft:red_wool": "red"})
    scene = prepare_scene(volume(states, palette), looks)
    film = film_of(scene, (4.5, 4.5, 6), (4.5, 4.5, 1), uniform_sky(1.0, 1.0, 1.0), 64, 3)
    seen = (film.gloss / film.samples[..., 1:])[8:16, 12:20].mean(axis=(0, 1))
    assert seen[0] > 0.2 and seen[1] < 0.1 * seen[0] and seen[2] < 0.1 * seen[0]


@pytest.mark.parametrize("rough", [0, 90, 150])
def test_gloss_seen_edge_on_brings_numbers(rough):
    class Glossy(OneGrey):
        def texture(self, name: str) -> Texture:
            normal = np.full((2, 2, 3), 128, np.uint8)
            normal[0, :, 0], normal[1, :, 1] = 250, 20
            return Texture(
                super().texture(name).colour,
                normal=normal,
                roughness=np.full((2, 2), rough, np.uint8),
                metal=np.full((2, 2), 128, np.uint8),
            )

    blocks = [(8, 3, 8, 2), *((i, 1, 4, 3) for i in range(17)), (2, 2, 12, 2)]
    scene = prepare_scene(volume(floor_with(*blocks), LAMP), Glossy(LAMP_LOOKS.kinds))
    film = film_of(scene, (0.3, 1.1, 8.2), (16, 1.05, 9), sky_light(LightSettings()), 64, 4)
    assert np.isfinite(film.gloss).all() and np.isfinite(film.light).all()
    assert film.gloss.max() > 0


def test_photos_need_an_hour():
    with pytest.raises(ValueError, match="photos need the light preset 'shader', got"):
        sky_light(LightSettings(preset="neutral"))
