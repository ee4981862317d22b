import numpy as np
import pytest
from build_samples import furnished

from world2minecraft.construction import build_volume, find_spawn, write_build
from world2minecraft.core.errors import DamagedFileError, InputError, UnknownNameError
from world2minecraft.formats.world_labels import read_scene
from world2minecraft.minecraft.schematics.sponge import read_schem
from world2minecraft.minecraft.worlds.world_writer import read_world


@pytest.fixture(scope="module")
def volume():
    sketch = furnished()
    return build_volume(sketch.grid(), (), (), corner_m=sketch.corner_m, blocks_per_metre=2.0)


@pytest.fixture(scope="module")
def folder(volume, tmp_path_factory):
    target = tmp_path_factory.mktemp("out") / "build"
    write_build(target, volume)
    return target


def named(volume):
    cells = np.argwhere(volume.states > 0)
    states = [volume.palette[i] for i in volume.states[tuple(cells.T)]]
    return dict(zip(map(tuple, (cells + volume.corner).tolist()), states, strict=True))


def test_the_world_and_the_schematic_hold_the_blocks(volume, folder):
    assert named(read_world(folder / "world")) == named(volume)
    schem = read_schem(folder / "room.schem")
    assert sorted(named(schem).values()) == sorted(named(volume).values())
    assert (folder / "datapack.zip").is_file()


def test_the_scene_reads_back(volume, folder):
    scene = read_scene(folder)
    assert np.array_equal(scene.semantic, volume.semantic)
    assert np.array_equal(scene.instance, volume.instance)
    assert np.array_equal(scene.block_to_room, volume.block_to_room)
    assert scene.corner == volume.corner
    assert scene.metres_per_block == pytest.approx(0.5)
    assert (scene.mc_version, scene.data_version) == ("1.20.1", 3465)
    assert scene.spawn == find_spawn(volume).position


def test_written_twice_gives_the_same_bytes(volume, folder, tmp_path):
    write_build(tmp_path / "again", volume)
    files = sorted(path.relative_to(folder) for path in folder.rglob("*") if path.is_file())
    assert len(files) >= 6
    for path in files:
        assert (folder / path).read_bytes() == (tmp_path / "again" / path).read_bytes()


def test_an_unknown_version_writes_nothing(volume, tmp_path):
    with pytest.raises(UnknownNameError, match="no Minecraft version is named '1.20.11'"):
        write_build(tmp_path / "build", volume, mc_version="1.20.11")
    assert not (tmp_path / "build").exists()


def test_a_damaged_scene_is_named(folder, tmp_path):
    with pytest.raises(InputError, match=r"scene\.json: cannot be read"):
        read_scene(tmp_path)
    for name in ("scene.json", "scene.npz"):
        (tmp_path / name).write_bytes((folder / name).read_bytes())
    (tmp_path / "scene.json").write_text('{"corner": [0, 0]}')
    with pytest.raises(DamagedFileError, match=r"scene\.json: is not a valid scene"):
        read_scene(tmp_path)


def test_an_old_game_gets_a_world_and_no_data_pack(volume, tmp_path):
    write_build(tmp_path / "build", volume)
    write_build(tmp_path / "build", volume, mc_version="1.16.5")
    assert not (tmp_path / "build" / "datapack.zip").exists()
    assert len(named(read_world(tmp_path / "build" / "world"))) == len(named(volume))
    assert read_scene(tmp_path / "build").data_version == 2586
