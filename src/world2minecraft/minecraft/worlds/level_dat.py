"""Creation of ``level.dat`` for a void world in creative mode at a fixed hour."""

from pathlib import Path
from typing import Any

from world2minecraft.core.errors import InputError
from world2minecraft.minecraft.nbt import Byte, Float, Long, Short
from world2minecraft.minecraft.versions import GameVersion

MAKER = "world2minecraft"  # The game drops unknown tags when it saves: then the mark is gone.
MAKER_TAG = "MadeBy"
UNDO_FOLDER = "w2m_undo"  # In a world that was built into: the files that undo the build.
TICKS_PER_HOUR = 1000
FIRST_WITH_DIMENSIONS = 2554  # 20w22a, of 1.16.
FIRST_WITHOUT_SEEDS = 3105  # 1.19.

# Names as of 1.20.1 to 1.21.10; newer games rename them on opening. Nothing spawns, burns, grows,
# rains or drops, and no message hides the view.
GAME_RULES = {
    "announceAdvancements": "false",
    "commandBlockOutput": "false",
    "commandModificationBlockLimit": "32768",
    "disableRaids": "true",
    "doDaylightCycle": "false",
    "doEntityDrops": "false",
    "doFireTick": "false",
    "doImmediateRespawn": "true",
    "doInsomnia": "false",
    "doMobLoot": "false",
    "doMobSpawning": "false",
    "doPatrolSpawning": "false",
    "doTileDrops": "false",
    "doTraderSpawning": "false",
    "doVinesSpread": "false",
    "doWardenSpawning": "false",
    "doWeatherCycle": "false",
    "fallDamage": "false",
    "fireDamage": "false",
    "keepInventory": "true",
    "maxCommandChainLength": "65536",
    "mobGriefing": "false",
    "randomTickSpeed": "0",
    "sendCommandFeedback": "true",
    "snowAccumulationHeight": "0",
    "spawnRadius": "0",
}


def no_world(folder: Path) -> InputError:
    """Return the error for a folder without ``level.dat``, suggesting a world inside it."""
    reason = "is not a world folder: level.dat not found"
    try:
        inner = sorted(path.parent for path in folder.glob("*/level.dat"))
    except OSError:
        inner = []
    return InputError(folder, f"{reason}; use {inner[0]} instead" if inner else reason)


def level_data(
    name: str,
    spawn: tuple[float, float, float],
    spawn_yaw_deg: float,
    version: GameVersion,
    packs: tuple[str, ...] = (),
    hour: float = 12.0,
) -> dict[str, Any]:
    """Return the NBT tree of a ``level.dat`` file.

    Args:
        name: The name in the game's list of worlds.
        spawn: Position of the player's feet in world block coordinates.
        spawn_yaw_deg: Direction of the player's view as the game's yaw in degrees: 0 is south, 90
            is west.
        version: The target game version.
        packs: File names of data packs in the world's own folder.
        hour: The fixed hour of the day, 0 to 24. The game's day begins at 6.
    """
    x, y, z = (int(value // 1) for value in spawn)
    data_version = version.level_data_version
    place = {"SpawnX": x, "SpawnY": y, "SpawnZ": z, "SpawnAngle": Float(spawn_yaw_deg)}
    data = {
        MAKER_TAG: MAKER,
        "version": 19133,
        "DataVersion": data_version,
        "Version": {
            "Id": data_version,
            "Name": version.name,
            "Series": "main",
            "Snapshot": Byte(0),
        },
        "LevelName": name,
        "GameType": 1,
        "allowCommands": Byte(1),
        "hardcore": Byte(0),
        "Difficulty": Byte(0),
        "DifficultyLocked": Byte(0),
        "initialized": Byte(1),
        "WasModded": Byte(0),
        "LastPlayed": Long(0),
        "GameRules": dict(GAME_RULES),
        "DataPacks": {"Enabled": ["vanilla", *[f"file/{p}" for p in packs]], "Disabled": []},
        **_generation(data_version),
        "Player": _player(spawn, spawn_yaw_deg, data_version),
    }
    return {"Data": {**data, **place, **_calm(round((hour - 6) * TICKS_PER_HOUR) % 24000)}}


def _calm(day_time: int) -> dict[str, Any]:
    """Return the tags for a fixed hour and clear weather, without dragon fights and traders."""
    return {
        "Time": Long(0),
        "DayTime": Long(day_time),
        "clearWeatherTime": 1_000_000_000,
        "raining": Byte(0),
        "rainTime": 1_000_000_000,
        "thundering": Byte(0),
        "thunderTime": 1_000_000_000,
        "DragonFight": {
            "NeedsStateScanning": Byte(0),
            "DragonKilled": Byte(1),
            "PreviouslyKilled": Byte(1),
        },
        "CustomBossEvents": {},
        "ScheduledEvents": [],
        "ServerBrands": [],
        "WanderingTraderSpawnChance": 0,
        "WanderingTraderSpawnDelay": 1_000_000_000,
    }


def _generation(data_version: int) -> dict[str, Any]:
    """Return the tags that make the overworld a void, in the layout of the data version."""
    if data_version >= FIRST_WITH_DIMENSIONS:
        return {"WorldGenSettings": _dimensions(has_seeds=data_version < FIRST_WITHOUT_SEEDS)}
    void = {
        "biome": "minecraft:the_void",
        "layers": [{"block": "minecraft:air", "height": Byte(1)}],
        "structures": {},
    }
    return {
        "RandomSeed": Long(0),
        "MapFeatures": Byte(0),
        "generatorName": "flat",
        "generatorVersion": 0,
        "generatorOptions": void,
    }


def _dimensions(*, has_seeds: bool) -> dict[str, Any]:
    """Return the three dimensions that the game requires, with seeds until 1.18."""
    void = {
        "biome": "minecraft:the_void",
        "features": Byte(0),  # With features the void gets a stone platform at its middle.
        "lakes": Byte(0),
        "layers": [{"block": "minecraft:air", "height": 1}],
        "structure_overrides": [],
    }
    seed: dict[str, Any] = {"seed": Long(0)} if has_seeds else {}
    if has_seeds:
        void["structures"] = {"structures": {}}  # The name of the overrides until 1.18.1.
    nether = {"type": "minecraft:multi_noise", "preset": "minecraft:nether", **seed}
    end = {"type": "minecraft:the_end", **seed}
    dimensions = {
        "minecraft:overworld": {
            "type": "minecraft:overworld",
            "generator": {"type": "minecraft:flat", "settings": void},
        },
        "minecraft:the_nether": _noise_dimension("the_nether", "nether", nether, seed),
        "minecraft:the_end": _noise_dimension("the_end", "end", end, seed),
    }
    return {
        "seed": Long(0),
        "generate_features": Byte(0),
        "bonus_chest": Byte(0),
        "dimensions": dimensions,
    }


def _noise_dimension(
    kind: str, settings: str, biomes: dict[str, Any], seed: dict[str, Any]
) -> dict[str, Any]:
    generator = {
        "type": "minecraft:noise",
        **seed,
        "settings": f"minecraft:{settings}",
        "biome_source": biomes,
    }
    return {"type": f"minecraft:{kind}", "generator": generator}


def _player(spawn: tuple[float, float, float], yaw_deg: float, data_version: int) -> dict[str, Any]:
    """Return the player of a single-player world, in creative mode on the floor."""
    return {
        "DataVersion": data_version,
        "Dimension": 0 if data_version < FIRST_WITH_DIMENSIONS else "minecraft:overworld",
        "Pos": [float(value) for value in spawn],
        "Motion": [0.0, 0.0, 0.0],
        "Rotation": [Float(yaw_deg), Float(0)],
        "OnGround": Byte(1),
        "playerGameType": 1,
        "Health": Float(20),
        "foodLevel": 20,
        "Air": Short(300),
        "Fire": Short(-20),
        "FallDistance": Float(0),
        "Inventory": [],
        "EnderItems": [],
        "SelectedItemSlot": 0,
        "abilities": {
            "flying": Byte(0),
            "mayfly": Byte(1),
            "instabuild": Byte(1),
            "invulnerable": Byte(1),
            "mayBuild": Byte(1),
            "flySpeed": Float(0.05),
            "walkSpeed": Float(0.1),
        },
    }
