"""The numbers of the geometric labeller, each with where it comes from.

Lengths are in metres of the room frame; heights are above the floor.
"""

from dataclasses import dataclass

from world2minecraft.core.parameters import parameter

Range = tuple[float, float]

CATALOGUE = "catalogue: common European and American furniture, with room for cells of 0.08 m"
TRIAL = "a trial: it served best on generated rooms and on a real kitchen"
ROOMS = "chosen on generated rooms; docs/labels.md"


@dataclass(frozen=True)
class StructureParameters:
    """How floor, ceiling, walls and openings are found.

    spill_m: the mean point of noise of the floor lies no higher.
    ceiling_min_m, ceiling_area_m2: the least height and area of a ceiling.
    roof_bottom_m, roof_area_m2, roof_length_m, roof_rise_m: a sloped ceiling begins no lower, and
        has at least this area, length along the ridge and rise.
    storey_m: floors of two storeys are this far apart at least.
    standing_m: over a floor is so much free space.
    floor_area_m2: the least seen part of another storey's floor.
    plane_gate_m: a cell's mean surface point lies this near its plane.
    wall_area_m2: the least seen part of a wall.
    wall_top_m: a wall reaches at least this high.
    wall_gap_m: one run of a wall goes on behind a thing this wide.
    behind_m, before_m: a cell this far behind or before a wall's plane is still of it.
    bend_m: over this length the sensor bends a wall; its plane is followed within it.
    hidden_m: nothing free lies this far behind a wall, unless it reaches the ceiling.
    passed_cells: so many free cells in a column mean that rays passed there.
    shadow_m: planes this near a larger one are its noise, its windows and its curtains.
    recess_m: a plane this far before a wider one, not up to the ceiling, is furniture.
    recess_width_m: the widest of such furniture, where no ceiling was seen.
    ceiling_gap_m: a wall ends no lower under the ceiling than this.
    full_gap_m: a wall between two rooms is seen so near to the ceiling.
    full_share: a wall with free space behind it, between two rooms, is seen over this share.
    opening_depth_m: how far windows and door leaves lie behind the face of their wall.
    opening_area_m2: the least area of an opening.
    leaf_depth_m, leaf_width_m, leaf_height_m: of a closed door whose leaf lies hardly behind the
        wall: the least depth, the width and the height.
    noise_m: cells of a plane have their mean point this near it.
    hung_m, hung_area_m2: how far before a wall, as negative depth, flat things hang, and the
        least of them.
    window_sill_m, window_size_m, door_width_m, door_height_m: a window begins above its sill, a
        door below.
    frame_share: of the ring around an opening this share is wall.
    """

    spill_m: float = parameter(0.03, unit="m", origin=f"{TRIAL}; what lies on a floor is thicker")
    ceiling_min_m: float = parameter(1.9, unit="m", origin="doors are 2 m high")
    ceiling_area_m2: float = parameter(
        1.0, unit="m2", origin="less may be the underside of a cupboard or a lamp"
    )
    roof_bottom_m: float = parameter(0.7, unit="m", origin="a guess")
    roof_area_m2: float = parameter(1.2, unit="m2", origin="a guess")
    roof_length_m: float = parameter(1.2, unit="m", origin="a guess")
    roof_rise_m: float = parameter(0.4, unit="m", origin="a guess")
    storey_m: float = parameter(2.0, unit="m", origin="a cellar is lower than a room")
    standing_m: float = parameter(1.5, unit="m", origin="over a wardrobe there is less")
    floor_area_m2: float = parameter(2.5, unit="m2", origin="no bed or table is as large")
    plane_gate_m: float = parameter(
        0.05,
        unit="m",
        origin="three sigma of the sensor model at 3 m, and less than the depth of a cupboard or "
        "of a hung screen",
    )
    wall_area_m2: float = parameter(
        0.6, unit="m2", origin="0.5 m of a wall up to eye height, half hidden"
    )
    wall_top_m: float = parameter(
        1.3, unit="m", origin="higher than tables, counters and chair backs"
    )
    wall_gap_m: float = parameter(1.3, unit="m", origin="a door, a window")
    behind_m: float = parameter(
        0.16, unit="m", origin="noise thickens a wall by up to two cells outward"
    )
    before_m: float = parameter(0.03, unit="m", origin="a picture is 4 cm thick")
    bend_m: float = parameter(0.24, unit="m", origin=ROOMS)
    hidden_m: float = parameter(0.4, unit="m", origin=ROOMS)
    passed_cells: int = parameter(3, unit="cells", origin="fewer are noise")
    shadow_m: float = parameter(0.13, unit="m", origin=ROOMS)
    recess_m: Range = parameter((0.15, 0.9), unit="m", origin=ROOMS)
    recess_width_m: float = parameter(3.0, unit="m", origin=ROOMS)
    ceiling_gap_m: float = parameter(0.25, unit="m", origin=ROOMS)
    full_gap_m: float = parameter(
        0.45, unit="m", origin="a wardrobe ends lower, or rays pass over it"
    )
    full_share: float = parameter(0.4, unit="share", origin=ROOMS)
    opening_depth_m: Range = parameter(
        (0.035, 0.16),
        unit="m",
        origin="from the sensor's noise up to the depth that a wall's cells may have",
    )
    opening_area_m2: float = parameter(0.25, unit="m2", origin="a small window")
    leaf_depth_m: float = parameter(
        0.008, unit="m", origin="deeper than the noise of a wall's relief"
    )
    leaf_width_m: Range = parameter((0.6, 1.15), unit="m", origin="as wide as doors are")
    leaf_height_m: Range = parameter((1.75, 2.3), unit="m", origin="as high as doors are")
    noise_m: float = parameter(
        0.035,
        unit="m",
        origin="the noise of a wall's relief is 3 to 5 mm, that of a single cell three times as "
        "much",
    )
    hung_m: Range = parameter(
        (-0.07, -0.015), unit="m", origin="the noise of a wall's relief is 3 to 5 mm"
    )
    hung_area_m2: float = parameter(0.05, unit="m2", origin=ROOMS)
    window_sill_m: float = parameter(0.3, unit="m", origin=CATALOGUE)
    window_size_m: Range = parameter((0.35, 4.0), unit="m", origin=CATALOGUE)
    door_width_m: Range = parameter((0.55, 1.9), unit="m", origin=CATALOGUE)
    door_height_m: float = parameter(1.5, unit="m", origin=CATALOGUE)
    frame_share: float = parameter(0.35, unit="share", origin=f"{TRIAL}; curtains hide the rest")


@dataclass(frozen=True)
class PlateParameters:
    """How plates are found, and what they are the top, the seat or the mattress of.

    height_m, area_m2: how high plates lie, and the least of them.
    gate_m: two plates this near in height are one.
    box_share: of the seen cells under the rim of a closed box this share is surface; a table's
        rim has legs alone.
    desk_height_m, desk_share: at a desk's height more is asked of a box.
    seat_height_m, chair_length_m, chair_width_m, sofa_length_m, sofa_width_m: of the seat that is
        seen.
    back_rise_m: where over a seat its back is looked for.
    back_share: a back takes this share of one side of its seat.
    closed_seat_m: the highest seat of upholstery.
    same_cloth: Oklab difference of seat and back of one upholstered thing.
    shelf_m, shelf_share: what stands this high over this share of a plate makes it a shelf's board.
    bed_height_m, bed_size_m, bed_area_m2: of a bed: the height, and the least length and width,
        and area.
    table_height_m, table_width_m, table_area_m2: of a table's top: the height, and the least width
        and area; low_table_height_m, low_table_area_m2: the same of a low one.
    box_height_m, box_width_m, box_area_m2: the least of the top of a closed box;
        open_box_height_m: what is this high need not be closed.
    worktop_height_m, worktop_size_m: of a worktop: the height, and the least width and length of
        the pieces of one between what stands on it.
    """

    height_m: Range = parameter(
        (0.25, 1.3), unit="m", origin="catalogue: seats, beds, tables, counters, 0.35 to 1.0 m"
    )
    area_m2: float = parameter(
        0.07, unit="m2", origin="the seat of a small chair is 0.12 m2, a third of it hidden"
    )
    gate_m: float = parameter(0.04, unit="m", origin="half a default cell")
    box_share: float = parameter(0.5, unit="share", origin=TRIAL)
    desk_height_m: Range = parameter((0.66, 0.79), unit="m", origin=TRIAL)
    desk_share: float = parameter(
        0.7,
        unit="share",
        origin=f"{TRIAL}; a desk has drawers on one side and a panel at its back",
    )
    seat_height_m: Range = parameter((0.32, 0.56), unit="m", origin=CATALOGUE)
    chair_length_m: float = parameter(0.85, unit="m", origin=CATALOGUE)
    chair_width_m: float = parameter(0.2, unit="m", origin=CATALOGUE)
    sofa_length_m: float = parameter(1.1, unit="m", origin=CATALOGUE)
    sofa_width_m: Range = parameter((0.35, 1.2), unit="m", origin=CATALOGUE)
    back_rise_m: Range = parameter((0.2, 0.5), unit="m", origin=ROOMS)
    back_share: float = parameter(0.5, unit="share", origin="slats leave gaps")
    closed_seat_m: float = parameter(0.5, unit="m", origin="a night table is higher")
    same_cloth: float = parameter(
        0.12,
        unit="Oklab",
        origin="a guess: shades of one cloth are nearer, a screen on a board differs by 0.3",
    )
    shelf_m: Range = parameter((1.25, 1.9), unit="m", origin=ROOMS)
    shelf_share: float = parameter(0.3, unit="share", origin=ROOMS)
    bed_height_m: Range = parameter((0.3, 0.65), unit="m", origin=CATALOGUE)
    bed_size_m: tuple[float, float] = parameter((1.6, 0.75), unit="m", origin=CATALOGUE)
    bed_area_m2: float = parameter(1.2, unit="m2", origin=CATALOGUE)
    table_height_m: Range = parameter((0.55, 0.85), unit="m", origin=CATALOGUE)
    table_width_m: float = parameter(0.4, unit="m", origin=CATALOGUE)
    table_area_m2: float = parameter(0.35, unit="m2", origin=CATALOGUE)
    low_table_height_m: Range = parameter((0.3, 0.55), unit="m", origin=CATALOGUE)
    low_table_area_m2: float = parameter(0.25, unit="m2", origin=CATALOGUE)
    box_height_m: float = parameter(0.42, unit="m", origin=CATALOGUE)
    box_width_m: float = parameter(0.2, unit="m", origin=CATALOGUE)
    box_area_m2: float = parameter(0.15, unit="m2", origin=CATALOGUE)
    open_box_height_m: float = parameter(0.8, unit="m", origin=ROOMS)
    worktop_height_m: Range = parameter((0.85, 0.96), unit="m", origin=CATALOGUE)
    worktop_size_m: Range = parameter((0.16, 0.5), unit="m", origin=ROOMS)


@dataclass(frozen=True)
class PieceParameters:
    """How pieces that no plate has claimed are told apart.

    near_wall_m: a piece this near a wall stands or hangs at it.
    flat_share: a closed piece shows this share of its cells on one upright plane.
    box_length_m, box_height_m, box_cells: the least of a cupboard.
    chair_bottom_m, chair_top_m, chair_length_m: for a chair whose seat is hidden.
    back_height_m, back_length_m, back_thick_m, back_over_m, back_gap_m: a chair back at a table:
        its size, how far it rises over the table, how far from its rim it stands.
    under_table_m: a leg or an apron ends this far under a table's top at most.
    foot_bottom_m, foot_off_m, foot_reach_m: the star of an office chair begins this low, under
        the middle of what is seen of its seat, and reaches so far beyond the edge.
    hanging_m: what reaches no further off its wall is a curtain or a picture, no cupboard.
    leaf: Oklab a at most, b at least, of leaves.
    joining_bottom_m, joining_share: a low piece that touches a thing over this share is its side.
    screen_lightness: Oklab lightness of a dark screen.
    screen_before_m: how far before its wall a screen hangs.
    screen_bottom_m: a screen begins no lower.
    screen_width_m, screen_height_m, screen_shape: its width and height, and width over height.
    monitor_m, monitor_flat: a lit screen on a table is at most so wide, and nearly all of it is
        its face.
    screen_filled: this share of a screen's outline is seen.
    screen_thick_m: the thickest screen.
    """

    near_wall_m: float = parameter(
        0.45,
        unit="m",
        origin="cupboards that hang on a wall are 0.35 m deep, and only their fronts are seen",
    )
    flat_share: float = parameter(
        0.22, unit="share", origin="a closed piece shows a third, a plant a tenth"
    )
    box_length_m: float = parameter(0.4, unit="m", origin="smaller boxes are things")
    box_height_m: float = parameter(0.45, unit="m", origin="smaller boxes are things")
    box_cells: int = parameter(20, unit="cells", origin="smaller boxes are things")
    chair_bottom_m: float = parameter(0.6, unit="m", origin=CATALOGUE)
    chair_top_m: Range = parameter((0.65, 1.15), unit="m", origin=CATALOGUE)
    chair_length_m: Range = parameter((0.25, 0.85), unit="m", origin=CATALOGUE)
    back_height_m: float = parameter(0.1, unit="m", origin=ROOMS)
    back_length_m: Range = parameter((0.25, 0.65), unit="m", origin=ROOMS)
    back_thick_m: float = parameter(0.4, unit="m", origin=ROOMS)
    back_over_m: float = parameter(0.05, unit="m", origin=ROOMS)
    back_gap_m: float = parameter(0.48, unit="m", origin=ROOMS)
    under_table_m: float = parameter(0.16, unit="m", origin=ROOMS)
    foot_bottom_m: float = parameter(0.15, unit="m", origin=TRIAL)
    foot_off_m: float = parameter(0.15, unit="m", origin=TRIAL)
    foot_reach_m: float = parameter(0.16, unit="m", origin=TRIAL)
    hanging_m: float = parameter(0.17, unit="m", origin=ROOMS)
    leaf: Range = parameter((-0.035, 0.02), unit="Oklab", origin="a guess")
    joining_bottom_m: float = parameter(0.5, unit="m", origin=ROOMS)
    joining_share: float = parameter(0.3, unit="share", origin=ROOMS)
    screen_lightness: float = parameter(0.38, unit="Oklab", origin="a guess")
    screen_before_m: Range = parameter(
        (0.045, 0.32), unit="m", origin="on a bracket 5 to 15 cm, on a board up to 0.3 m"
    )
    screen_bottom_m: float = parameter(0.45, unit="m", origin="a screen on a low board")
    screen_width_m: Range = parameter(
        (0.4, 1.9), unit="m", origin="from a small monitor to a large television"
    )
    screen_height_m: Range = parameter(
        (0.24, 1.2), unit="m", origin="from a small monitor to a large television"
    )
    screen_shape: Range = parameter(
        (1.0, 3.0), unit="times", origin="from a small monitor to a large television"
    )
    monitor_m: float = parameter(0.8, unit="m", origin=TRIAL)
    monitor_flat: float = parameter(0.7, unit="share", origin=TRIAL)
    screen_filled: float = parameter(
        0.35, unit="share", origin="a lit screen shows the sensor its frame alone"
    )
    screen_thick_m: float = parameter(0.22, unit="m", origin="with its foot")


@dataclass(frozen=True)
class GeometricParameters:
    """All numbers of the geometric labeller, by what they decide."""

    structure: StructureParameters = parameter(StructureParameters)
    plates: PlateParameters = parameter(PlateParameters)
    pieces: PieceParameters = parameter(PieceParameters)


def within(value: float, bounds: Range) -> bool:
    """Return whether a number lies within bounds, both included."""
    return bounds[0] <= value <= bounds[1]
