"""``w2m render``: what is written, what is told, and one line for whatever is wrong."""

import json
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

import world2minecraft as w2m
from world2minecraft import cli
from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import AIR, BlockVolume
from world2minecraft.formats.world_labels import scene_from_volume, write_scene
from world2minecraft.minecraft.file_format import WriteOptions
from world2minecraft.minecraft.formats import write_blocks

PALETTE = (AIR, "minecraft:stone", "minecraft:red_concrete")


def room(scale=1.0):
    """A closed room of stone, 6 x 3 x 5 blocks inside, with a red chair in a corner."""
    states = np.ones((8, 5, 7), np.uint16)
    states[1:7, 1:4, 1:6] = 0
    semantic = np.where(states > 0, 3, 0).astype(np.uint8)
    semantic[:, 0], semantic[:, 4] = 2, 1
    states[1, 1, 1], semantic[1, 1, 1] = 2, 5
    instance = np.where(semantic == 5, 4, 0).astype(np.uint16)
    corner = block_to_room(np.array([0.0, 0.0]), scale)
    return BlockVolume(states, PALETTE, semantic, instance, (-1, 63, -1), corner)


@pytest.fixture
def schem(tmp_path):
    write_blocks(room(), tmp_path / "room.schem")
    return tmp_path / "room.schem"


@pytest.fixture
def build(tmp_path):
    """A build as the program writes it: a world, and what its blocks are."""
    volume, spawn = room(), (2.5, 64.0, 2.5)
    folder = tmp_path / "build"
    write_blocks(volume, folder / "world", WriteOptions(spawn=spawn, spawn_yaw_deg=90.0))
    scene = scene_from_volume(
        volume, mc_version="1.20.1", data_version=3465, spawn=spawn, spawn_yaw_deg=90.0
    )
    write_scene(folder, scene)
    return folder


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def render(*words, size="48x36"):
    return cli.run(["render", *map(str, words), "--size", size, "--threads", "1"])


def lines_of(path):
    return [json.loads(line) for line in path.read_text().splitlines()]


def image(path):
    with Image.open(path) as opened:
        return np.asarray(opened)


POSE = "2.5,65.62,2.5,90,0,eye"


def test_a_build_is_seen_from_where_its_player_starts(build, tmp_path, capsys):
    assert render(build) == 0
    (line,) = lines_of(tmp_path / "build.poses.jsonl")
    assert (line["x"], line["y"], line["z"], line["yaw"], line["pitch"]) == (2.5, 65.62, 2.5, 90, 0)
    assert (line["width"], line["height"], line["vertical_fov_deg"]) == (48, 36, 70)
    assert line["image"] == "build.png" and line["scene_id"] == "build"
    assert image(tmp_path / "build.png").shape == (36, 48, 3)
    told = capsys.readouterr().out
    assert "note: rendered from the player's start position; --tour and --orbit show more" in told
    assert f"  next   w2m render {build} --tour --out build_tour.gif" in told


def test_a_file_is_seen_from_outside(schem, tmp_path, capsys):
    assert render(schem) == 0
    assert (
        "the build has no player start, so it is rendered from outside" in capsys.readouterr().out
    )
    assert image(tmp_path / "room.png").shape == (36, 48, 3)


def test_feet_are_lower_than_eyes_by_the_players_size(build, tmp_path):
    assert render(build, "--pose", "2.5,64,2.5,90,0", "--out", "a.png") == 0
    assert render(build, "--pose", POSE, "--out", "b.png") == 0
    assert np.array_equal(image(tmp_path / "a.png"), image(tmp_path / "b.png"))


def test_layers_agree_and_have_their_names(build, tmp_path):
    assert render(build, "--pose", POSE, "--outputs", "all", "--out", "d/here.png") == 0
    folder = tmp_path / "d"
    names = json.loads((folder / "here.names.json").read_text())
    seen = image(folder / "here.state.png")
    assert {names["state"][str(n)] for n in np.unique(seen)} <= set(PALETTE)
    classes, objects = image(folder / "here.class.png"), image(folder / "here.instance.png")
    assert (classes == 5).any()
    assert np.array_equal(classes == 5, objects == 4)
    (red,) = [int(n) for n, state in names["state"].items() if state == PALETTE[2]]
    assert np.array_equal(classes == 5, seen == red)
    depth = image(folder / "here.depth.png")
    assert depth[18, 24] == 2500  # The wall at x = 0 is 2.5 blocks, of a metre each, ahead.
    (line,) = lines_of(folder / "here.poses.jsonl")
    assert line["files"]["opaque_depth"] == "here.opaque_depth.png"
    assert set(line["files"]) >= {"rgb", "depth", "block", "state", "class", "instance", "normal"}


def test_depth_alone_is_called_as_it_was_asked_for(build, tmp_path):
    assert render(build, "--pose", POSE, "--out", "z.npy") == 0
    depth = np.load(tmp_path / "z.npy")
    assert depth.dtype == np.float32 and depth[18, 24] == pytest.approx(2.5)
    assert render(build, "--pose", POSE, "--out", "z.exr") == 0
    assert (tmp_path / "z.exr").read_bytes()[:4] == b"\x76\x2f\x31\x01"


def test_a_tour_to_a_folder_comes_again_from_its_poses(build, tmp_path):
    assert render(build, "--tour", "--frames", "3", "--out", "walk", "--outputs", "rgb,id") == 0
    folder = tmp_path / "walk"
    assert sorted(path.name for path in folder.iterdir()) == sorted(
        [f"{n:06d}{end}" for n in range(3) for end in
         (".png", ".state.png", ".class.png", ".instance.png")] + ["names.json", "poses.jsonl"]
    )  # fmt: skip
    words = ("--outputs", "rgb,id", "--out", "again")
    assert render(build, "--poses", folder / "poses.jsonl", *words, size="640x480") == 0
    for path in folder.glob("*.class.png"):
        assert np.array_equal(image(path), image(tmp_path / "again" / path.name))


def test_an_orbit_and_a_turntable_move(build, tmp_path, capsys):
    assert render(build, "--orbit", "--frames", "3", "--out", "orbit.gif") == 0
    assert "ceilings and near walls are removed" in capsys.readouterr().out
    assert render(build, "--turntable", "--frames", "2", "--out", "turn.webp") == 0
    for name, count in (("orbit.gif", 3), ("turn.webp", 2)):
        with Image.open(tmp_path / name) as opened:
            assert opened.n_frames == count
    assert len(lines_of(tmp_path / "orbit.poses.jsonl")) == 3


def test_a_turntable_can_stand_still(build, tmp_path):
    assert render(build, "--turntable", "--out", "still.jpg") == 0
    assert image(tmp_path / "still.jpg").shape == (36, 48, 3)


def test_what_lies_outside_of_the_box_is_not_drawn(schem, tmp_path):
    words = ("--pose", POSE, "--out")
    assert render(schem, "--box=-9,-9,-9,99,99,99", *words, "a.npy") == 0
    assert render(schem, "--box=2,0,-9,99,99,99", *words, "b.npy") == 0
    assert np.load(tmp_path / "a.npy").any()
    assert not np.load(tmp_path / "b.npy")[18, 24]


def test_a_world_without_a_scene_is_read_around_its_spawn(tmp_path, capsys):
    write_blocks(room(), tmp_path / "plain", WriteOptions(spawn=(2.5, 64.0, 2.5)))
    assert render("plain", "--outputs", "rgb,class") == 0
    told = capsys.readouterr().out
    assert "the world has no scene.json; using the blocks around the spawn point (2 64 2)" in told
    assert not image(tmp_path / "plain.class.png").any()


def test_a_scene_without_labels_keeps_its_scale(build, tmp_path, capsys):
    (build / "scene.npz").unlink()
    assert render(build, "--outputs", "rgb,class") == 0
    assert "scene.npz not found: classes and objects are empty" in capsys.readouterr().out
    assert not image(tmp_path / "build.class.png").any()


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["--pose", "1,2,3"], "--pose must be x,y,z,yaw,pitch or x,y,z,yaw,pitch,eye, got '1,2,3'"),
        (["--pose", "1,2,3,4,95"], "pitch must be -90 (up) to 90 (down) degrees, got 95"),
        (["--orbit", "--tour"], "--orbit and --tour exclude each other; use only one of them"),
        (["--orbit", "--pose", "1,2,3,4,5"],
         "--orbit and --pose exclude each other; use only one of them"),
        (["--pose", "1,2,3,4,5", "--frames", "3"],
         "frames requires the view orbit, tour or turntable (--orbit, --tour or --turntable) and "
         "cannot be used with pose"),
        (["--vfov", "70", "--hfov", "90"],
         "the vertical and the horizontal field of view (--vfov, --hfov) cannot be combined; give "
         "only one of them"),
        (["--vfov", "0"], "the field of view must be above 0 and at most 170 degrees, got 0"),
        (["--frames", "0"], "frames must be 1 to 1,000,000, got 0"),
        (["--fps", "0"], "fps must be 1 to 240, got 0"),
        (["--box", "1,2,3"], "--box must be six integers x0,y0,z0,x1,y1,z1, got '1,2,3'"),
        (["--box", "1,2,3,1,5,6"],
         "--box must have x0 < x1, y0 < y1 and z0 < z1, got '1,2,3,1,5,6'"),
        (["--box", "100,0,0,101,1,1"],
         "the box does not overlap the build, which is 8 x 5 x 7 blocks from"),
        (["--format", "bmp"], "the image format must be png, jpg or webp, got 'bmp'"),
        (["--depth-format", "tif"], "the depth format must be png, exr or npy, got 'tif'"),
        (["--quality", "0"], "quality must be 1 to 100, got 0"),
        (["--depth-scale", "0"], "the depth scale must be 1 to 65535, got 0"),
        (["--outputs", "rbg"], "no output is named 'rbg'; did you mean 'rgb'?"),
        (["--out", "a.tiff"],
         "a.tiff: the output must end in .png, .jpg, .jpeg, .webp, .exr, .npy, .gif, .apng, .mp4, "
         ".webm, or have no suffix to write a folder"),
        (["--orbit", "--frames", "3", "--out", "a.png"],
         "cannot write 3 images to a.png; choose an output folder, or a name that ends in .gif, "
         ".webp or .mp4"),
        (["--tour", "--out", "a.gif", "--outputs", "rgb,depth"],
         "a.gif: an animation can only contain rgb; use a folder for depth"),
        (["--turntable", "--out", "a", "--outputs", "depth"],
         "turntable can only output rgb; use orbit (--orbit) for depth and ids"),
        (["--turntable", "--photo"],
         "turntable cannot be combined with photo; use orbit (--orbit --photo)"),
        (["--samples", "9"], "samples must be 1 to 4, got 9"),
        (["--textures", "24"], "the texture size must be 16, 32, 64 or 128, got 24"),
        (["--light", "disco"],
         "light: preset must be one of shader, game, neutral, got 'disco'"),
        (["--exposure", "0"], "light: exposure must be 0.01 to 100, got 0.0"),
        (["--device", "tpu"], "device must be auto, cpu or gpu, got 'tpu'"),
        (["--jobs", "0"], "jobs must be 1 to 256, got 0"),
        (["--jobs", "2", "--photo"],
         "jobs cannot be combined with photo; remove one of them"),
        (["--jobs", "2", "--device", "gpu"],
         "jobs cannot be combined with the device gpu; remove one of them"),
        (["--jobs", "2", "--turntable", "--out", "t.gif"],
         "turntable cannot be combined with jobs; omit jobs (--jobs)"),
        (["--photo-samples", "0"], "photo samples must be 1 to 4,096, got 0"),
    ],
)  # fmt: skip
def test_wrong_words_are_told_in_one_line(schem, words, text, capsys):
    assert render(schem, *words) == 2
    told = capsys.readouterr().err.splitlines()[-1]
    assert told.startswith(f"error: {text}")


@pytest.mark.parametrize(
    ("size", "text"),
    [
        ("big", "--size must be WIDTHxHEIGHT in pixels, such as 1280x720, got 'big'"),
        ("-3x4", "--size must be WIDTHxHEIGHT in pixels, such as 1280x720, got '-3x4'"),
        ("²x3", "--size must be WIDTHxHEIGHT in pixels, such as 1280x720, got '²x3'"),
        ("0x4", "invalid camera: width_px must be 1 to 20000, got 0"),
        ("99999x4", "invalid camera: width_px must be 1 to 20000, got 99999"),
        ("9000x9000", "9000x9000 with 2 x 2 samples per pixel is too large; the limits are "
                      "64,000,000 samples in total and 20,000 pixels per side"),
    ],
)  # fmt: skip
def test_a_wrong_size_is_told(schem, size, text, capsys):
    assert render(schem, size=size) == 2
    assert capsys.readouterr().err == f"error: {text}\n"


@pytest.mark.parametrize("view", ["isometric", "plan", "inside"])
@pytest.mark.parametrize("size", [(0, 0), (-5, 3), (99999, 99999)])
def test_a_wrong_size_of_one_image_is_told(build, view, size):
    with pytest.raises(UsageError, match=rf"size {size[0]}x{size[1]}: |size must be|width_px"):
        w2m.render(build, size=size, view=view)


def test_a_pose_of_three_numbers_is_told(schem):
    with pytest.raises(UsageError, match="a pose must be x, y, z, yaw and pitch, got 3 values"):
        w2m.render_files(schem, poses=[(1.0, 64.0, 2.0)])


def test_threads_are_counted(schem, capsys):
    assert cli.run(["render", str(schem), "--threads", "0"]) == 2
    assert capsys.readouterr().err == "error: threads must be 1 to 512, got 0\n"


def test_bad_input_is_told(tmp_path, schem, capsys):
    assert render("nowhere") == 3
    assert capsys.readouterr().err == "error: nowhere: not found\n"
    (tmp_path / "poses.jsonl").write_text("{}\n")
    assert render(schem, "--poses", "poses.jsonl") == 3
    assert capsys.readouterr().err == "error: poses.jsonl: line 1 does not contain x\n"
    (tmp_path / "file").write_text("")
    assert render(schem, "--poses", "poses.jsonl", "--out", "file") == 3
    assert "this is a file; choose a folder, or a name such as" in capsys.readouterr().err
    (tmp_path / "a.png").mkdir()
    assert render(schem, "--out", "a.png") == 3
    assert "error: a.png: this is a folder; choose another name" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("[]", "is not a valid scene (expected a JSON object)"),
        ("{", "is not JSON"),
        ("{}", "is not a valid scene ('corner')"),
    ],
)
def test_a_broken_scene_is_told(build, text, reason, capsys):
    (build / "scene.json").write_text(text)
    assert render(build) == 3
    assert reason in capsys.readouterr().err


def test_a_block_of_a_mod_is_drawn_and_told(tmp_path, capsys):
    volume = room()
    palette = (*PALETTE[:2], "mymod:chair")
    write_blocks(replace(volume, palette=palette), tmp_path / "mod.schem")
    assert render("mod.schem") == 0
    assert (
        "note: 1 of 3 block states (33.3%) have no model and are rendered as plain boxes: "
        "mymod:chair\n" in capsys.readouterr().out
    )


def test_a_pack_comes_before_our_own_textures(schem, tmp_path, capsys):
    texture = tmp_path / "pack/assets/minecraft/textures/block/stone.png"
    texture.parent.mkdir(parents=True)
    (tmp_path / "pack/pack.mcmeta").write_text('{"pack": {"pack_format": 15, "description": ""}}')
    Image.new("RGB", (16, 16), (0, 255, 0)).save(texture)
    words = ("--pose", POSE, "--light", "neutral")
    assert render(schem, *words, "--out", "own.png") == 0
    assert render(schem, *words, "--pack", "pack", "--out", "green.png") == 0
    own, green = (image(tmp_path / name).astype(int) for name in ("own.png", "green.png"))
    assert np.ptp(own[18, 40]) < 20 and green[18, 40, 1] > green[18, 40, 0] + 100
    capsys.readouterr()
    assert render(schem, "--pack", "nothing") == 3
    assert "nothing" in capsys.readouterr().err


def test_processes_write_the_bytes_of_one(build, tmp_path, monkeypatch):
    from world2minecraft.rendering.presentation import shot_rendering as shot_frames

    monkeypatch.setattr(shot_frames, "MIN_PICTURES_PER_JOB", 4)
    words = ("--tour", "--frames", "8", "--outputs", "rgb,depth,state")
    assert render(build, *words, "--out", "one") == 0
    assert render(build, *words, "--out", "two", "--jobs", "2") == 0
    first = {path.name: path.read_bytes() for path in (tmp_path / "one").iterdir()}
    second = {path.name: path.read_bytes() for path in (tmp_path / "two").iterdir()}
    assert len(first) == 3 * 8 + 2
    assert first == second


def test_what_cannot_be_written_ends_the_command(build, tmp_path, capsys):
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "000001.png").mkdir()
    words = ("--tour", "--frames", "3", "--out", "full")
    assert render(build, *words) == 2
    assert "full contains other files (000001.png)" in capsys.readouterr().err
    assert render(build, *words, "--force") == 3
    assert "000001.png" in capsys.readouterr().err


def test_photos_are_traced_by_passes(build, tmp_path, capsys):
    words = ("--orbit", "--frames", "2", "--photo", "--photo-samples", "5")
    assert render(build, *words, "--out", "p") == 0
    assert "Rendering views: done" in capsys.readouterr().err
    for name in ("000000.png", "000001.png"):
        photo = image(tmp_path / "p" / name)
        assert photo.shape == (36, 48, 3)
        assert np.ptp(photo) > 40


def test_a_device_draws_and_is_let_go(build, monkeypatch):
    from world2minecraft.rendering import render_volume
    from world2minecraft.rendering.presentation import shot_rendering as shot_frames

    told = []

    class Renderer:
        def __init__(self, scene):
            self.scene = scene

        def render(self, camera, pose, **words):
            told.append("render")
            return render_volume(self.scene, camera, pose, **words)

        def close(self):
            told.append("close")

    class Gpu:
        @staticmethod
        def renderer_for(device, scene, *, threads):
            told.append(device)
            return Renderer(scene)

    monkeypatch.setattr(shot_frames, "_gpu_module", lambda device: Gpu)
    assert render(build, "--pose", POSE, "--pose", POSE, "--device", "gpu", "--out", "g") == 0
    assert told == ["gpu", "render", "render", "close"]


def test_without_a_gpu_tier_auto_draws_and_gpu_is_told(build, monkeypatch, capsys):
    from world2minecraft.rendering.presentation import shot_rendering as shot_frames

    monkeypatch.setattr(shot_frames, "GPU", "world2minecraft.rendering.none")
    assert render(build, "--device", "auto") == 0
    assert render(build, "--device", "gpu") == 2
    assert (
        "error: device 'gpu' is not available in this version; use cpu\n" in capsys.readouterr().err
    )


def test_json_is_the_poses_alone(build, tmp_path, capsys):
    assert render(build, "--pose", POSE, "-o", "a.png", "--json") == 0
    assert json.loads(capsys.readouterr().out) == lines_of(tmp_path / "a.poses.jsonl")
