import pytest

from world2minecraft.core.errors import UnknownNameError
from world2minecraft.minecraft.versions import game_version, game_versions, name_in_version


def test_the_default_is_1_20_1():
    version = game_version()
    assert (version.name, version.data_version, version.pack_format) == ("1.20.1", 3465, 15)
    assert (version.min_y, version.max_y) == (-64, 319)


def test_versions_grow():
    versions = game_versions()
    assert len({version.name for version in versions}) == len(versions)
    numbers = [version.data_version for version in versions]
    assert numbers == sorted(set(numbers))
    formats = [(version.pack_format, version.pack_minor) for version in versions]
    assert formats == sorted(formats)


def test_worlds_for_newer_games_use_the_last_known_layout():
    assert game_version("1.21.4").level_data_version == 4189
    assert game_version("26.3").level_data_version == game_version("1.21.8").data_version


def test_an_unknown_version_is_told_with_the_nearest():
    with pytest.raises(UnknownNameError, match=r"no Minecraft version is named '1\.20\.11'"):
        game_version("1.20.11")


def test_blocks_are_renamed_from_the_version_on():
    assert name_in_version("minecraft:grass", 3697) == "minecraft:grass"
    assert name_in_version("minecraft:grass", 3698) == "minecraft:short_grass"
    assert name_in_version("minecraft:stone", 9999) == "minecraft:stone"
