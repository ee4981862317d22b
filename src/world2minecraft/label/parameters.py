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
    before_m: a cell this far before a wall's plane is still of it; a picture is 4 cm thick.
    hidden_m: nothing free lies this far behind a wall, unless it reaches the ceiling.
    passed_cells: so many free cells in a column mean that rays passed there; fewer are noise.
    recess_m: a plane this far in front of a wider one, not up to the ceiling, is furniture.
    recess_width_m: the widest of such furniture, where no ceiling was seen.
    ceiling_gap_m: a wall ends no lower under the ceiling than this.
    full_share: a wall with free space behind it, between two rooms, is seen over this share.
    opening_depth_m: how far windows and door leaves lie behind the face of their wall: a guess
        from the sensor's noise up to the depth that a wall's cells may have.
    opening_area_m2: a small window.
    window_sill_m, window_size_m, door_width_m, door_height_m: catalogue; a window begins above
        its sill, a door below.
    frame_share: of the ring around an opening, this share is wall; curtains hide the rest.
    plate_height_m: seats, beds, tables, counters: catalogue, 0.35 to 1.0.
    plate_area_m2: the seat of a small chair is 0.12 m2, a third of it hidden.
    plate_gate_m: half a default cell: two plates this near in height are one.
    box_share: of the seen cells under the rim of a closed box this share is surface; a table's
        rim has legs alone. Measured on generated rooms.
    near_wall_m: cupboards that hang on a wall are 0.35 m deep, and only their fronts are seen.
    flat_share: a closed piece shows a third of its cells on one upright plane, a plant a tenth.
    screen_before_m: a screen on a bracket hangs 5 to 15 cm before its wall, on a board up to 0.3.
    screen_bottom_m: a screen on a low board begins here.
    screen_width_m: from a small monitor to a large television.
    leaf: Oklab a at most, b at least, of leaves; a guess.
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
    before_m: float = 0.03
    hidden_m: float = 0.4
    passed_cells: int = 3
    recess_m: Range = (0.15, 0.9)
    recess_width_m: float = 3.0
    ceiling_gap_m: float = 0.25
    full_share: float = 0.4
    opening_depth_m: Range = (0.035, 0.16)
    opening_area_m2: float = 0.25
    window_sill_m: float = 0.3
    window_size_m: Range = (0.35, 4.0)
    door_width_m: Range = (0.55, 1.9)
    door_height_m: float = 1.5
    frame_share: float = 0.35
    plate_height_m: Range = (0.25, 1.3)
    plate_area_m2: float = 0.07
    plate_gate_m: float = 0.04
    box_share: float = 0.5
    near_wall_m: float = 0.45
    flat_share: float = 0.22
    screen_before_m: Range = (0.045, 0.32)
    screen_bottom_m: float = 0.45
    screen_width_m: Range = (0.4, 1.9)
    leaf: Range = (-0.035, 0.02)
    screen_lightness: float = 0.45
