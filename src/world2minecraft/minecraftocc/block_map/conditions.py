"""What a rule of a block map can ask: the names of conditions, and the measures of things."""

# A condition holds or not at a block. Zones first: a block is in one of them.
CONDITIONS = {
    "floor": "the layer that one walks on, of a storey's rooms",
    "ceiling": "the first layer over a room, or a flat roof's",
    "wall": "a column that closes a room from floor to ceiling, and lintels between such",
    "inside": "between floor and ceiling of a room, and no wall",
    "outside": "none of these",
    "under_floor": "within half a metre under a floor, with no room between",
    "wall_line": "outside, and straight on from a wall, up or down, for half a metre",
    "over_ceiling": "over a ceiling, within three metres: roofs and attics",
    "open_floor": "outside, part of a flat top a metre and a half wide that one can stand on",
    "air_above": "nothing over the block",
    "air_below": "nothing under the block",
    "on_floor": "a floor under the block",
    "at_wall": "a wall beside the block",
    "under_ceiling": "a ceiling over the block, or things that hang from one",
    "turned": "the block is upside down, as a stair that carries a table's top",
    "coarse": "the scale is under two blocks a metre, where one block is a whole thing",
    "in_row": "a block of the same kind beside it, at its height",
    "climbs": "a block of the same kind one step up or down, beside it",
}
# A condition of two words asks for the kind or class of a neighbour: "over fence".
NEIGHBOURS = {"over": (0, -1, 0), "under": (0, 1, 0)}
# Of the thing that a block is part of: blocks inside that touch by faces. Metres.
MEASURES = {
    "at_m": "of the block alone: its bottom over the floor",
    "height_m": "from its lowest to its highest block",
    "bottom_m": "its lowest block over the floor",
    "top_m": "its highest block's top over the floor",
    "long_m": "the longer side of its box from above",
    "wide_m": "the shorter side",
    "area_m2": "of its columns",
    "filled": "the share of its box that is filled, 0 to 1",
    "open": "the share of its columns with nothing at the floor, 0 to 1: under a table's top",
}
