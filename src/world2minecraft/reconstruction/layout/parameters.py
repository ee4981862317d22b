"""The numbers of the geometric labeller, each with where it comes from.

Lengths are in metres of the room frame; heights are above the floor. "Catalogue" stands for the
sizes of common European and American furniture, with room on both sides for cells of 0.08 m;
"trial" for what served best on generated rooms and on a real kitchen.
"""

from dataclasses import dataclass, field

Range = tuple[float, float]


@dataclass(frozen=True)
class StructureParameters:
    """How floor, ceiling, walls and openings are found.

    spill_m: the mean point of noise of the floor lies no higher; what lies on it is thicker. Trial.
    ceiling_min_m: nothing lower is a ceiling; doors are 2 m high.
    ceiling_area_m2: less may be the underside of a cupboard or a lamp.
    roof_bottom_m, roof_area_m2, roof_length_m, roof_rise_m: a sloped ceiling begins no lower, and
        has at least this area, length along the ridge and rise. A guess.
    storey_m: floors of two storeys are this far apart at least; a cellar is lower than a room.
    standing_m: over a floor is so much free space; over a wardrobe is not.
    floor_area_m2: the least seen part of another storey's floor; no bed or table is as large.
    plane_gate_m: a cell's mean surface point lies this near its plane: three sigma of the sensor
        model at 3 m, and less than the depth of a cupboard or of a hung screen.
    wall_area_m2: the least seen part of a wall: 0.5 m of it up to eye height, half hidden.
    wall_top_m: a wall reaches higher than tables, counters and chair backs.
    wall_gap_m: one run of a wall goes on behind a thing this wide: a door, a window.
    behind_m: noise thickens a wall by up to two cells outward.
    before_m: a cell this far before a wall's plane is still of it; a picture is 4 cm thick.
    bend_m: over this length the sensor bends a wall; its plane is followed within it.
    hidden_m: nothing free lies this far behind a wall, unless it reaches the ceiling.
    passed_cells: so many free cells in a column mean that rays passed there; fewer are noise.
    shadow_m: planes this near a larger one are its noise, its windows and its curtains.
    recess_m: a plane this far before a wider one, not up to the ceiling, is furniture.
    recess_width_m: the widest of such furniture, where no ceiling was seen.
    ceiling_gap_m: a wall ends no lower under the ceiling than this.
    full_gap_m: a wall between two rooms is seen so near to the ceiling; a wardrobe ends lower, or
        rays pass over it.
    full_share: a wall with free space behind it, between two rooms, is seen over this share.
    opening_depth_m: how far windows and door leaves lie behind the face of their wall: from the
        sensor's noise up to the depth that a wall's cells may have.
    opening_area_m2: a small window.
    leaf_depth_m, leaf_width_m, leaf_height_m: a closed door whose leaf lies hardly behind the
        wall: deeper than the noise of a wall's relief, as wide and as high as doors are.
    noise_m: cells of a plane have their mean point this near it: the noise of a wall's relief is
        3 to 5 mm, that of a single cell three times as much.
    hung_m, hung_area_m2: how far before a wall, as negative depth, flat things hang, and the
        least of them; the noise of a wall's relief is 3 to 5 mm.
    window_sill_m, window_size_m, door_width_m, door_height_m: catalogue; a window begins above
        its sill, a door below.
    frame_share: of the ring around an opening this share is wall; curtains hide the rest. Trial.
    """

    spill_m: float = 0.03
    ceiling_min_m: float = 1.9
    ceiling_area_m2: float = 1.0
    roof_bottom_m: float = 0.7
    roof_area_m2: float = 1.2
    roof_length_m: float = 1.2
    roof_rise_m: float = 0.4
    storey_m: float = 2.0
    standing_m: float = 1.5
    floor_area_m2: float = 2.5
    plane_gate_m: float = 0.05
    wall_area_m2: float = 0.6
    wall_top_m: float = 1.3
    wall_gap_m: float = 1.3
    behind_m: float = 0.16
    before_m: float = 0.03
    bend_m: float = 0.24
    hidden_m: float = 0.4
    passed_cells: int = 3
    shadow_m: float = 0.13
    recess_m: Range = (0.15, 0.9)
    recess_width_m: float = 3.0
    ceiling_gap_m: float = 0.25
    full_gap_m: float = 0.45
    full_share: float = 0.4
    opening_depth_m: Range = (0.035, 0.16)
    opening_area_m2: float = 0.25
    leaf_depth_m: float = 0.008
    leaf_width_m: Range = (0.6, 1.15)
    leaf_height_m: Range = (1.75, 2.3)
    noise_m: float = 0.035
    hung_m: Range = (-0.07, -0.015)
    hung_area_m2: float = 0.05
    window_sill_m: float = 0.3
    window_size_m: Range = (0.35, 4.0)
    door_width_m: Range = (0.55, 1.9)
    door_height_m: float = 1.5
    frame_share: float = 0.35


@dataclass(frozen=True)
class PlateParameters:
    """How plates are found, and what they are the top, the seat or the mattress of.

    height_m: seats, beds, tables, counters: catalogue, 0.35 to 1.0.
    area_m2: the seat of a small chair is 0.12 m2, a third of it hidden.
    gate_m: half a default cell: two plates this near in height are one.
    box_share: of the seen cells under the rim of a closed box this share is surface; a table's
        rim has legs alone. Trial.
    desk_height_m, desk_share: at a desk's height more is asked of a box: a desk has drawers on
        one side and a panel at its back. Trial.
    seat_height_m, chair_length_m, chair_width_m, sofa_length_m, sofa_width_m: catalogue, of the
        seat that is seen.
    back_rise_m: where over a seat its back is looked for.
    back_share: a back takes this share of one side of its seat; slats leave gaps.
    closed_seat_m: the highest seat of upholstery; a night table is higher.
    same_cloth: Oklab difference of seat and back of one upholstered thing; shades of one cloth
        are nearer, a screen on a board differs by 0.3. A guess.
    shelf_m, shelf_share: what stands this high over this share of a plate makes it a shelf's board.
    worktop_height_m, worktop_size_m: catalogue, and the least width and length of the pieces of
        one between what stands on it.
    bed_*, table_*, low_table_*, box_*: catalogue.
    """

    height_m: Range = (0.25, 1.3)
    area_m2: float = 0.07
    gate_m: float = 0.04
    box_share: float = 0.5
    desk_height_m: Range = (0.66, 0.79)
    desk_share: float = 0.7
    seat_height_m: Range = (0.32, 0.56)
    chair_length_m: float = 0.85
    chair_width_m: float = 0.2
    sofa_length_m: float = 1.1
    sofa_width_m: Range = (0.35, 1.2)
    back_rise_m: Range = (0.2, 0.5)
    back_share: float = 0.5
    closed_seat_m: float = 0.5
    same_cloth: float = 0.12
    shelf_m: Range = (1.25, 1.9)
    shelf_share: float = 0.3
    bed_height_m: Range = (0.3, 0.65)
    bed_size_m: tuple[float, float] = (1.6, 0.75)
    bed_area_m2: float = 1.2
    table_height_m: Range = (0.55, 0.85)
    table_width_m: float = 0.4
    table_area_m2: float = 0.35
    low_table_height_m: Range = (0.3, 0.55)
    low_table_area_m2: float = 0.25
    box_height_m: float = 0.42
    box_width_m: float = 0.2
    box_area_m2: float = 0.15
    open_box_height_m: float = 0.8
    worktop_height_m: Range = (0.85, 0.96)
    worktop_size_m: Range = (0.16, 0.5)


@dataclass(frozen=True)
class PieceParameters:
    """How pieces that no plate has claimed are told apart.

    near_wall_m: cupboards that hang on a wall are 0.35 m deep, and only their fronts are seen.
    flat_share: a closed piece shows a third of its cells on one upright plane, a plant a tenth.
    box_length_m, box_height_m, box_cells: the least of a cupboard; smaller boxes are things.
    chair_bottom_m, chair_top_m, chair_length_m: catalogue, for a chair whose seat is hidden.
    back_height_m, back_length_m, back_thick_m, back_over_m, back_gap_m: a chair back at a table:
        its size, how far it rises over the table, how far from its rim it stands.
    under_table_m: a leg or an apron ends this far under a table's top at most.
    foot_bottom_m, foot_off_m, foot_reach_m: the star of an office chair begins this low, under
        the middle of what is seen of its seat, and reaches so far beyond the edge. Trial.
    hanging_m: what reaches no further off its wall is a curtain or a picture, no cupboard.
    leaf: Oklab a at most, b at least, of leaves. A guess.
    joining_bottom_m, joining_share: a low piece that touches a thing over this share is its side.
    screen_lightness: Oklab lightness of a dark screen. A guess.
    screen_before_m: a screen on a bracket hangs 5 to 15 cm before its wall, on a board up to 0.3.
    screen_bottom_m: a screen on a low board begins here.
    screen_width_m, screen_height_m, screen_shape: from a small monitor to a large television.
    monitor_m, monitor_flat: a lit screen on a table is at most so wide, and nearly all of it is
        its face. Trial.
    screen_filled: a lit screen shows the sensor its frame alone.
    screen_thick_m: with its foot.
    """

    near_wall_m: float = 0.45
    flat_share: float = 0.22
    box_length_m: float = 0.4
    box_height_m: float = 0.45
    box_cells: int = 20
    chair_bottom_m: float = 0.6
    chair_top_m: Range = (0.65, 1.15)
    chair_length_m: Range = (0.25, 0.85)
    back_height_m: float = 0.1
    back_length_m: Range = (0.25, 0.65)
    back_thick_m: float = 0.4
    back_over_m: float = 0.05
    back_gap_m: float = 0.48
    under_table_m: float = 0.16
    foot_bottom_m: float = 0.15
    foot_off_m: float = 0.15
    foot_reach_m: float = 0.16
    hanging_m: float = 0.17
    leaf: Range = (-0.035, 0.02)
    joining_bottom_m: float = 0.5
    joining_share: float = 0.3
    screen_lightness: float = 0.38
    screen_before_m: Range = (0.045, 0.32)
    screen_bottom_m: float = 0.45
    screen_width_m: Range = (0.4, 1.9)
    screen_height_m: Range = (0.24, 1.2)
    screen_shape: Range = (1.0, 3.0)
    monitor_m: float = 0.8
    monitor_flat: float = 0.7
    screen_filled: float = 0.35
    screen_thick_m: float = 0.22


@dataclass(frozen=True)
class GeometricParameters:
    """All numbers of the geometric labeller, by what they decide."""

    structure: StructureParameters = field(default_factory=StructureParameters)
    plates: PlateParameters = field(default_factory=PlateParameters)
    pieces: PieceParameters = field(default_factory=PieceParameters)


def within(value: float, bounds: Range) -> bool:
    """Return whether a number lies within bounds, both included."""
    return bounds[0] <= value <= bounds[1]
