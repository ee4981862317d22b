"""The numbers of the geometric labeller, each with where it comes from.

Lengths are in metres of the room frame; heights are above the floor. "Catalogue" stands for the
sizes of common European and American furniture, with room on both sides for cells of 0.08 m.
"""

from dataclasses import dataclass

Range = tuple[float, float]


@dataclass(frozen=True)
class GeometricParameters:
    """How structure and objects are told apart.

    spill_m: a floor point may read this high: three sigma of the sensor model at 3 m.
    ceiling_min_m: nothing lower is a ceiling; doors are 2 m high.
    ceiling_area_m2: less may be the underside of a cupboard or a lamp.
    plane_gate_m: a cell's mean surface point lies this near its plane: three sigma of the sensor
        model at 3 m, and less than the depth of a cupboard or of a hung screen.
    wall_area_m2: the least seen part of a wall: 0.5 m of it up to eye height, half hidden.
    wall_top_m: a wall reaches higher than tables, counters and chair backs.
    wall_gap_m: one run of a wall goes on behind a thing this wide: a door, a window.
    behind_m: noise thickens a wall by up to two cells outward.
    hidden_m: nothing free lies this far behind a wall, unless it reaches the ceiling.
    recess_m: a plane this far in front of a wider one, not up to the ceiling, is furniture.
    recess_width_m: the widest of such furniture.
    plate_height_m: seats, beds, tables, counters: catalogue, 0.35 to 1.0.
    plate_area_m2: the seat of a small chair is 0.12 m2, a third of it hidden.
    plate_gate_m: half a default cell: two plates this near in height are one.
    box_share: of the seen cells under the rim of a closed box this share is surface; a table's
        rim has legs alone. Measured on generated rooms.
    screen_lightness: Oklab lightness of a dark screen; a guess.
    """

    spill_m: float = 0.05
    ceiling_min_m: float = 1.9
    ceiling_area_m2: float = 1.0
    plane_gate_m: float = 0.05
    wall_area_m2: float = 0.6
    wall_top_m: float = 1.3
    wall_gap_m: float = 1.3
    behind_m: float = 0.16
    hidden_m: float = 0.4
    recess_m: Range = (0.15, 0.9)
    recess_width_m: float = 3.0
    plate_height_m: Range = (0.25, 1.3)
    plate_area_m2: float = 0.07
    plate_gate_m: float = 0.04
    box_share: float = 0.5
    screen_lightness: float = 0.45
