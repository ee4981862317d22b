"""Pictures of packs: frames, sizes, alpha, and the maps of labPBR."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pack_making import PICTURE, cube_files, folder_pack, plain, png

from world2minecraft.core.errors import UsageError
from world2minecraft.rendering.resource_packs import ResourcePackModels
from world2minecraft.rendering.resource_packs.textures import (
    decode_png,
    first_frame,
    material_maps,
    normal_map,
    resampled,
    side_for,
)
from world2minecraft.rendering.texture import Texture

RED, GREEN, BLUE = plain(200, 0, 0), plain(0, 200, 0), plain(0, 0, 200)


def texture_of(tmp_path, files, name="block/a", **options) -> Texture:
    looks = ResourcePackModels([folder_pack(tmp_path / "pack", files)], **options)
    texture = looks.texture(f"minecraft:{name}")
    assert texture is not None, looks.problems
    return texture


@pytest.mark.parametrize("mode", ["RGBA", "RGB", "L", "LA", "P", "1", "I;16"])
def test_every_kind_of_png_is_read(mode, tmp_path):
    from PIL import Image

    grey = np.full((16, 16), 200, np.uint8)
    image = Image.fromarray(grey)
    if mode == "I;16":
        image = Image.fromarray(grey.astype(np.uint16) << 8)
    elif mode != "L":
        image = image.convert(mode)
    image.save(tmp_path / "a.png")
    pixels = decode_png((tmp_path / "a.png").read_bytes())
    assert pixels.shape == (16, 16, 4) and pixels.dtype == np.uint8
    assert pixels[0, 0].tolist() == [255 if mode == "1" else 200] * 3 + [255]


@pytest.mark.parametrize(
    ("animation", "colour"),
    [
        ({}, "red"),
        ({"frametime": 4, "frames": [2, 1, 0]}, "blue"),
        ({"frames": [{"index": 1, "time": 9}, 0]}, "green"),
        ({"width": 16, "height": 16, "frames": []}, "red"),
        ({"height": 32}, "red"),
    ],
)
def test_the_first_frame_of_a_strip_is_shown(tmp_path, animation, colour):
    strip = np.concatenate([RED, GREEN, BLUE])
    files = {PICTURE.format("a"): strip, PICTURE.format("a") + ".mcmeta": {"animation": animation}}
    pixel = texture_of(tmp_path, files).colour[0, 0].tolist()
    assert pixel == {"red": RED, "green": GREEN, "blue": BLUE}[colour][0, 0].tolist()


def test_frames_go_by_rows_where_there_are_several_columns():
    sheet = np.concatenate([np.concatenate([RED, GREEN], 1), np.concatenate([BLUE, RED], 1)])
    frame = first_frame(sheet, {"width": 16, "height": 16, "frames": [2]})
    np.testing.assert_array_equal(frame, BLUE)


def test_a_tall_picture_without_animation_is_squeezed_whole(tmp_path):
    texture = texture_of(tmp_path, {PICTURE.format("a"): np.concatenate([RED, GREEN])})
    assert texture.colour.shape == (32, 32, 4)
    assert texture.colour[0, 0].tolist() == RED[0, 0].tolist()
    assert texture.colour[31, 31].tolist() == GREEN[0, 0].tolist()


def test_a_broken_animation_shows_no_texture_and_says_why(tmp_path):
    files = {PICTURE.format("a"): RED}
    files[PICTURE.format("a") + ".mcmeta"] = {"animation": {"frames": [7]}}
    looks = ResourcePackModels([folder_pack(tmp_path / "pack", files)])
    assert looks.texture("minecraft:block/a") is None
    assert looks.problems == [
        "assets/minecraft/textures/block/a.png of pack: the first frame must be below 1, the "
        "number of frames, got 7"
    ]


@pytest.mark.parametrize(
    ("shape", "most_px", "side"),
    [((16, 16), 128, 16), ((17, 9), 128, 32), ((300, 300), 128, 128), ((1, 1), 16, 1)],
)
def test_textures_become_squares_of_a_power_of_two(tmp_path, shape, most_px, side):
    assert side_for(np.zeros((*shape, 4), np.uint8), most_px) == side
    picture = np.full((*shape, 4), 77, np.uint8)
    texture = texture_of(tmp_path, {PICTURE.format("a"): picture}, most_px=most_px)
    assert texture.colour.shape == (side, side, 4)
    assert (texture.colour == 77).all()


@pytest.mark.parametrize(
    ("sides", "most_px", "usual"),
    [((16, 16, 64), 128, 16), ((16, 64, 64), 32, 64), ((512, 512), 256, 128), ((), 128, 16)],
)
def test_the_usual_size_is_that_of_most_textures(tmp_path, sides, most_px, usual):
    files = {PICTURE.format(f"t{n}"): plain(1, 2, 3, side=side) for n, side in enumerate(sides)}
    files |= {PICTURE.format("broken"): b"no", "assets/minecraft/textures/item/a.png": RED}
    looks = ResourcePackModels([folder_pack(tmp_path / "pack", files)], most_px=most_px)
    assert looks.texture_px == usual
    assert looks.problems == []


def test_the_usual_size_is_that_of_the_highest_packs(tmp_path):
    jar = folder_pack(tmp_path / "jar", {PICTURE.format("a"): RED})
    fine = folder_pack(tmp_path / "fine", {PICTURE.format("a"): plain(1, 2, 3, side=32)})
    assert ResourcePackModels([jar, fine]).texture_px == 32


def test_a_size_that_is_no_power_of_two_is_refused(tmp_path):
    folder = folder_pack(tmp_path / "pack", cube_files("stone", RED))
    with pytest.raises(UsageError, match="most_px must be a power of two such as 64, got 48"):
        ResourcePackModels([folder], most_px=48)


def slow_area(pixels: np.ndarray, side: int, times: int) -> np.ndarray:
    """The mean over each new pixel's area, by repeating every pixel many times."""
    fine = pixels.repeat(times, 0).repeat(times, 1).astype(np.float64)
    cover = fine[..., 3:].copy()
    fine[..., :3] *= cover
    blocks = fine.reshape(side, fine.shape[0] // side, side, fine.shape[1] // side, 4)
    mean = blocks.mean(axis=(1, 3))
    mean[..., :3] = np.divide(mean[..., :3], mean[..., 3:])
    return np.floor(mean + 0.5)


@given(old=st.sampled_from((3, 5, 8, 12)), side=st.sampled_from((4, 8, 16)), seed=st.integers(0, 9))
def test_each_new_pixel_is_the_mean_of_its_area(old, side, seed):
    pixels = np.random.default_rng(seed).integers(1, 256, (old, old, 4)).astype(np.uint8)
    wanted = slow_area(pixels, side, side)
    assert np.abs(resampled(pixels, side).astype(float) - wanted).max() <= 1


def test_holes_leave_no_dark_rim():
    pixels = plain(200, 100, 50)
    pixels[:, 1::2] = 0  # Holes are black, as most editors leave them.
    small = resampled(pixels, 8)
    assert (small[..., :3] == (200, 100, 50)).all()
    assert (small[..., 3] == 128).all()


@pytest.mark.parametrize(
    ("name", "alpha", "translucent"),
    [
        ("red_stained_glass", 120, True),
        ("ice", 160, True),
        ("frosted_ice_0", 160, True),
        ("slime_block", 180, True),
        ("honey_block_side", 200, True),
        ("glass", 0, False),
        ("glass", 255, False),
        ("oak_leaves", 160, False),
        ("lattice", 160, False),
    ],
)
def test_half_clear_pixels_of_clear_stuff_are_translucent(tmp_path, name, alpha, translucent):
    picture = plain(90, 90, 90, alpha)
    picture[0] = 255
    texture = texture_of(tmp_path, {PICTURE.format(name): picture}, f"block/{name}")
    assert texture.translucent is translucent


def test_a_clear_block_makes_its_textures_clear(tmp_path):
    files = cube_files("tinted_glass", RED)
    files["assets/minecraft/models/block/tinted_glass.json"]["textures"] = {"all": "block/pale"}
    files[PICTURE.format("pale")] = plain(90, 90, 90, 120)
    looks = ResourcePackModels([folder_pack(tmp_path / "pack", files)])
    model = looks.model("tinted_glass")
    assert model is not None
    face = model.elements[0].faces[0]
    assert face is not None
    texture = looks.texture(face.texture)
    assert texture is not None and texture.translucent
    plainly = looks.texture("minecraft:block/pale")
    assert plainly is not None and not plainly.translucent


def test_normals_are_those_of_directx():
    pixels = np.array([[[128, 128, 0, 0], [255, 128, 9, 9], [128, 255, 9, 9], [255, 255, 9, 9]]])
    flat, right, down, corner = normal_map(pixels.astype(np.uint8))[0].tolist()
    assert flat == [128, 128, 255]
    assert right == [255, 128, 128]  # To where u grows.
    assert down == [128, 255, 128]  # To where v grows, which is down.
    assert corner == [218, 218, 128]  # Longer than one: made as long as one.


def test_materials_are_those_of_lab_pbr():
    pixels = np.array([[[255, 229, 0, 255], [0, 230, 0, 0], [100, 255, 0, 254], [128, 4, 0, 127]]])
    roughness, metal, emission = material_maps(pixels.astype(np.uint8))
    assert roughness.tolist() == [[0, 255, 155, 127]]
    assert metal.tolist() == [[0, 255, 255, 0]]
    assert emission.tolist() == [[0, 0, 255, 128]]


def test_maps_beside_a_texture_are_read_at_its_size(tmp_path):
    files = {
        PICTURE.format("a"): RED,
        PICTURE.format("a_n"): plain(128, 128, 255, side=32),
        PICTURE.format("a_s"): plain(155, 0, 0, side=8)[..., :3],
    }
    texture = texture_of(tmp_path, files)
    assert texture.normal is not None and (texture.normal == (128, 128, 255)).all()
    assert texture.roughness is not None and (texture.roughness == 100).all()
    assert texture.metal is not None and not texture.metal.any()
    assert texture.emission is not None and not texture.emission.any()
    assert texture.roughness.shape == (16, 16)


def test_maps_of_an_animation_are_cut_like_it(tmp_path):
    files = {
        PICTURE.format("a"): np.concatenate([RED, GREEN]),
        PICTURE.format("a") + ".mcmeta": {"animation": {"frames": [1]}},
        PICTURE.format("a_s"): np.concatenate([plain(0, 0, 0), plain(255, 0, 0)]),
    }
    texture = texture_of(tmp_path, files)
    assert texture.colour[0, 0].tolist() == GREEN[0, 0].tolist()
    assert texture.roughness is not None and not texture.roughness.any()


def test_a_broken_map_is_left_out_and_said(tmp_path):
    files = {PICTURE.format("a"): RED, PICTURE.format("a_n"): b"no picture"}
    looks = ResourcePackModels([folder_pack(tmp_path / "pack", files)])
    texture = looks.texture("minecraft:block/a")
    assert texture is not None and texture.normal is None
    assert looks.problems == ["assets/minecraft/textures/block/a_n.png of pack: not a PNG file"]


def test_joined_textures_keep_the_maps_of_what_is_seen(tmp_path):
    over = np.zeros((16, 16, 4), np.uint8)
    over[:8] = (0, 200, 0, 255)
    files = {
        PICTURE.format("a"): RED,
        PICTURE.format("b"): over,
        PICTURE.format("b_s"): plain(255, 0, 0),
    }
    looks = ResourcePackModels([folder_pack(tmp_path / "pack", files)])
    texture = looks.texture("minecraft:block/a+minecraft:block/b*00ff00")
    assert texture is not None and texture.roughness is not None
    assert texture.colour[0, 0].tolist() == [0, 200, 0, 255]
    assert texture.colour[9, 0].tolist() == [200, 0, 0, 255]
    assert texture.roughness[0, 0] == 0 and texture.roughness[9, 0] == 204


def test_the_size_is_read_before_the_picture():
    head = png(RED)
    huge = head[:16] + (60_000).to_bytes(4, "big") * 2 + head[24:]
    with pytest.raises(
        ValueError, match="image has 60000 x 60000 pixels, the limit is 33,554,432 pixels"
    ):
        decode_png(huge)
    with pytest.raises(ValueError, match="damaged PNG file"):
        decode_png(head[:60])
    with pytest.raises(ValueError, match="not a PNG file"):
        decode_png(b"GIF89a")
