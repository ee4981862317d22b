"""Which block states are seen at full brightness, whatever the light."""

LUMINOUS = (
    "sea_lantern",
    "glowstone",
    "shroomlight",
    "froglight",
    "lantern",
    "torch",
    "end_rod",
    "redstone_lamp[lit=true",
    "beacon",
    "candle",
)
DARK = ("torchflower", "lit=false")  # A flower, and candles and torches that do not burn.


def is_luminous(state: str) -> bool:
    """Tell whether a state is drawn at full brightness."""
    return any(part in state for part in LUMINOUS) and not any(part in state for part in DARK)
