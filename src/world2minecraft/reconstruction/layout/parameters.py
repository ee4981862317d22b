"""The parameters of the geometric labeller and the reasons for their defaults.

Lengths are in metres in the room frame; heights are above the floor.
"""

from dataclasses import dataclass

from world2minecraft.core.parameters import parameter

Range = tuple[float, float]

CATALOGUE = "catalogue: common European and American furniture, with room for cells of 0.08 m"
TRIAL = "tuned on generated rooms and a real kitchen"
ROOMS = "chosen on generated rooms; docs/explanation/labels.md"


@dataclass(frozen=True)
class StructureParameters:
    """Parameters of the detection of floors, ceilings, walls and openings.

    spill_m: Maximum height of the mean point of a cell that counts as noise of the floor.
    ceiling_min_m, ceiling_area_m2: Minimum height and area of a ceiling.
    roof_bottom_m, roof_area_m2, roof_length_m, roof_rise_m: Minimum height of the lower edge, area,
        length along the ridge and rise of a sloped ceiling.
    storey_m: Minimum distance of the floors of two storeys.
    standing_m: Minimum height of free space above a floor.
    floor_area_m2: Minimum observed area of the floor of another storey.
    plane_gate_m: Maximum distance of a cell's mean surface point from its plane.
    wall_area_m2: Minimum observed area of a wall.
    wall_top_m: Minimum height of the upper edge of a wall.
    wall_gap_m: Maximum width of an object behind which a wall is assumed to continue.
    behind_m, before_m: Maximum distance behind and in front of a wall plane at which a cell belongs
        to the wall.
    bend_m: Length over which the bend of a wall, which sensors cause, is smoothed.
    hidden_m: Distance behind a wall plane within which no ray may have passed, unless the wall
        reaches the ceiling.
    passed_cells: Minimum number of free cells in a column through which rays passed.
    shadow_m: Distance from a larger plane within which a plane counts as its noise, window or
        curtain.
    recess_m: Distance in front of a wider plane beyond which a plane below the ceiling is
        furniture.
    recess_width_m: Maximum width of such furniture if no ceiling was seen.
    ceiling_gap_m: Maximum distance of the upper edge of a wall from the ceiling.
    full_gap_m: Maximum distance from the ceiling of the seen part of a wall between two rooms.
    full_share: Minimum observed share of a wall between two rooms with free space behind it.
    opening_depth_m: Range of distances of windows and door leaves behind the face of their wall.
    opening_area_m2: Minimum area of an opening.
    leaf_depth_m, leaf_width_m, leaf_height_m: Minimum depth, width and height of a closed door
        whose leaf is almost flush with the wall.
    noise_m: Maximum distance of a cell's mean point from a plane it belongs to.
    hung_m, hung_area_m2: Range of distances behind the wall's face, negative in front of it, and
        minimum area of flat objects on the wall.
    window_sill_m, window_size_m, door_width_m, door_height_m: Minimum height of the sill and size
        of a window, and minimum width and height of a door.
    frame_share: Minimum share of wall in the ring around an opening.
    """

    spill_m: float = parameter(0.03, unit="m", origin=f"{TRIAL}; objects on a floor are thicker")
    ceiling_min_m: float = parameter(1.9, unit="m", origin="doors are 2 m high")
    ceiling_area_m2: float = parameter(
        1.0, unit="m2", origin="less may be the underside of a cupboard or a lamp"
    )
    roof_bottom_m: float = parameter(0.7, unit="m", origin="a guess")
    roof_area_m2: float = parameter(1.2, unit="m2", origin="a guess")
    roof_length_m: float = parameter(1.2, unit="m", origin="a guess")
    roof_rise_m: float = parameter(0.4, unit="m", origin="a guess")
    storey_m: float = parameter(2.0, unit="m", origin="a cellar is lower than a room")
    standing_m: float = parameter(1.5, unit="m", origin="there is less space above a wardrobe")
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
        0.9, unit="m", origin="higher than tables, counters and chair backs"
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
    """Parameters of the detection of horizontal plates and of the furniture they belong to.

    height_m, area_m2: Height range and minimum area of plates.
    gate_m: Maximum difference in height within a plate.
    box_share: Minimum share of surface among the seen cells under the rim of a closed box; a table
        has only legs there.
    desk_height_m, desk_share: Height range of desks, and the higher share required of a box there.
    seat_height_m, chair_length_m, chair_width_m, sofa_length_m, sofa_width_m: Height and size of
        the visible seat of a chair or sofa.
    back_rise_m: Height range above a seat in which a back is searched for.
    back_share: Minimum share of one side of the seat that a back covers.
    closed_seat_m: Maximum height of an upholstered seat.
    same_cloth: Maximum Oklab difference of the seat and back of one upholstered object.
    shelf_m, shelf_share: Height range above a plate, and minimum share of the plate, in which
        objects make it the board of a shelf.
    bed_height_m, bed_size_m, bed_area_m2: Height range, minimum length and width, and minimum area
        of a bed.
    table_height_m, table_width_m, table_area_m2: Height range, minimum width and minimum area of a
        table top.
    low_table_height_m, low_table_area_m2: Height range and minimum area of the top of a low table.
    box_height_m, box_width_m, box_area_m2: Minimum height, width and area of the top of a closed
        box.
    open_box_height_m: Height from which a box need not be closed.
    worktop_height_m, worktop_size_m: Height range of a worktop, and minimum width and length of its
        visible pieces.
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
    """Parameters of the classification of pieces that belong to no plate.

    near_wall_m: Maximum distance from a wall of a piece that stands or hangs there.
    flat_share: Minimum share of a closed piece's cells on one upright plane.
    box_length_m, box_height_m, box_cells: Minimum length, height and number of cells of a cupboard.
    chair_bottom_m, chair_top_m, chair_length_m: Height and size of a chair with a hidden seat.
    back_height_m, back_length_m, back_thick_m, back_over_m, back_gap_m: Size of a chair back at a
        table, its height above the table and its distance from the table's rim.
    under_table_m: Maximum distance of a leg or apron below the top of its table.
    foot_bottom_m, foot_off_m, foot_reach_m: Height of the star base of an office chair, its offset
        from the centre of the visible seat, and its reach beyond the seat's edge.
    hanging_m: Maximum depth of a curtain or picture; deeper pieces are cupboards.
    leaf: Maximum Oklab a and minimum Oklab b of leaves.
    joining_bottom_m, joining_share: Height and contact share at which a low piece is the side of an
        object.
    screen_lightness: Maximum Oklab lightness of a dark screen.
    screen_before_m: Range of distances of a screen from its wall.
    screen_bottom_m: Minimum height of the lower edge of a screen.
    screen_width_m, screen_height_m, screen_shape: Width, height and aspect ratio of a screen.
    monitor_m, monitor_flat: Maximum width of a lit screen on a table, and minimum share of its
        cells in its face.
    screen_filled: Minimum observed share of a screen's outline.
    screen_thick_m: Maximum thickness of a screen.
    """

    near_wall_m: float = parameter(
        0.45,
        unit="m",
        origin="cupboards that hang on a wall are 0.35 m deep, and only their fronts are seen",
    )
    flat_share: float = parameter(
        0.22, unit="share", origin="a closed piece shows a third, a plant a tenth"
    )
    box_length_m: float = parameter(0.4, unit="m", origin="smaller boxes are objects")
    box_height_m: float = parameter(0.45, unit="m", origin="smaller boxes are objects")
    box_cells: int = parameter(20, unit="cells", origin="smaller boxes are objects")
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
        0.35, unit="share", origin="a depth sensor sees only the frame of a lit screen"
    )
    screen_thick_m: float = parameter(0.22, unit="m", origin="with its foot")


@dataclass(frozen=True)
class GeometricParameters:
    """All parameters of the geometric labeller."""

    structure: StructureParameters = parameter(StructureParameters)
    plates: PlateParameters = parameter(PlateParameters)
    pieces: PieceParameters = parameter(PieceParameters)


def within(value: float, bounds: Range) -> bool:
    """Return whether a number is within bounds, inclusive."""
    return bounds[0] <= value <= bounds[1]
