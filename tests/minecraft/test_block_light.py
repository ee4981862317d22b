"""How much light a block gives, by its state."""

import pytest

from world2minecraft.minecraft.rules.light import emitted_light

PUBLISHED = {  # The Minecraft Wiki's list of light sources.
    "lantern": 15,
    "torch": 14,
    "soul_lantern": 10,
    "furnace[lit=true]": 13,
    "furnace[lit=false]": 0,
    "red_candle[candles=3,lit=true]": 9,
    "red_candle[candles=3,lit=false]": 0,
    "respawn_anchor[charges=0]": 0,
    "respawn_anchor[charges=1]": 3,
    "respawn_anchor[charges=4]": 15,
    "sea_pickle[pickles=1,waterlogged=true]": 6,
    "sea_pickle[pickles=4,waterlogged=true]": 15,
    "sea_pickle[pickles=4,waterlogged=false]": 0,
    "copper_bulb[lit=true]": 15,
    "waxed_weathered_copper_bulb[lit=true]": 8,
    "oxidized_copper_bulb[lit=false]": 0,
    "waxed_exposed_copper_lantern": 15,
    "copper_wall_torch": 14,
    "light[level=7]": 7,
    "stone": 0,
}


@pytest.mark.parametrize("state", PUBLISHED)
def test_a_block_gives_the_light_of_its_state(state):
    assert emitted_light(f"minecraft:{state}") == PUBLISHED[state]
