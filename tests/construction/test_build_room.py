"""The room itself: shut, one block thick, lit to its corners, with a plaque; and it stays."""

import json
from dataclasses import replace

import numpy as np
import pytest
from build_samples import VOXEL_M, Sketch, furnished, l_room
from generated_rooms import corner_of, furnished_room, true_grid
from house_samples import house

from world2minecraft.construction import BuildParameters, build_volume, find_spawn
from world2minecraft.construction.block_updates import apply_block_updates
from world2minecraft.construction.lighting import MIN_CORNER_LIGHT, WALK_BLOCKS
from world2minecraft.construction.plaque import FAR
from world2minecraft.core.classes import OBJECT_CLASSES
from world2minecraft.core.coordinates import apply, invert
from world2minecraft.core.errors import UsageError
from world2minecraft.geometry.connected_components import label_face_components
from world2minecraft.geometry.morphology import dilate, dilate_faces
from world2minecraft.minecraft.collision_shapes import is_full_cube
from world2minecraft.minecraft.rules.light import block_light
from world2minecraft.minecraft.rules.stability import find_unstable
from world2minecraft.procgen import generate_house, generate_room

SCALES = (1.0, 2.0, 4.0)
CEILING, FLOOR, WALL = 1, 2, 3
AIRY = ("minecraft:air", "minecraft:light[level=15,waterlogged=false]")


def build(sketch, scale=4.0, name="", **chosen):
    return build_volume(
        sketch.grid(),
        (),
        (),
        corner_m=sketch.corner_m,
        blocks_per_metre=scale,
        parameters=BuildParameters(**chosen),
        name=name,
    )


def free_of(volume):
    return np.isin(volume.states, [i for i, s in enumerate(volume.palette) if s in AIRY])


def inside_of(volume):
    """The air that the spawn's place is joined to by faces."""
    parts, _ = label_face_components(free_of(volume))
    cell = np.floor(np.array(find_spawn(volume).position)).astype(int) - volume.corner
    return parts == parts[tuple(cell)]


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("sketch", [Sketch(), Sketch(notch=(30, 14)), l_room()])
def test_a_room_without_an_opening_is_shut(sketch, scale):
    inside = inside_of(build(sketch, scale))
    assert inside.any()
    rim = np.ones_like(inside)
    rim[1:-1, 1:-1, 1:-1] = False
    assert not (inside & rim).any()


@pytest.mark.parametrize("scale", SCALES)
def test_the_shell_is_one_block_thick_and_grows_outward(scale):
    sketch = Sketch((50, 25, 30))
    volume = build(sketch, scale)
    ground = 64 - volume.corner[1]
    sides = [round(cells * VOXEL_M * scale) for cells in (50, 30, 25)]
    inside = inside_of(volume)
    spans = [np.flatnonzero(inside.any(axis)) for axis in ((1, 2), (0, 2), (0, 1))]
    assert [len(span) for span in spans] == sides
    middle = [int(span[len(span) // 2]) for span in spans]
    row = volume.semantic[:, ground + 1, middle[2]]
    assert (row == WALL).sum() == 2 and (row[spans[0]] == 0).all()
    column = volume.semantic[middle[0], :, middle[2]]
    assert (column == FLOOR).sum() == 1 and (column == CEILING).sum() == 1


def test_a_ceiling_is_on_off_or_of_glass():
    shut, opened, glass = (build(furnished(), ceiling=c) for c in ("on", "off", "glass"))
    assert not (opened.semantic == CEILING).any()
    for volume, wanted in ((shut, False), (glass, True)):
        kinds = {volume.palette[i] for i in np.unique(volume.states[volume.semantic == CEILING])}
        assert (kinds == {"minecraft:glass"}) == wanted and kinds
    assert (glass.semantic == shut.semantic).all()


def test_old_words_for_ceiling_and_lights_still_count():
    old = BuildParameters(ceiling=False, lights=False)
    assert (old.ceiling, old.lights) == ("off", "off")
    assert BuildParameters(ceiling="True", lights="1") == BuildParameters()
    for key, value, message in (
        ("ceiling", "wood", "build.ceiling must be one of on, off, glass, got 'wood'"),
        ("lights", "sun", "build.lights must be one of hidden, off, lamps, got 'sun'"),
        (
            "plaque",
            "a\nb",
            "build.plaque must be auto, off or a text of up to 60 printable characters, "
            r"got 'a\nb'",
        ),
    ):
        with pytest.raises(UsageError) as caught:
            BuildParameters(**{key: value})
        assert str(caught.value) == message


@pytest.mark.parametrize("lights", ["hidden", "lamps"])
@pytest.mark.parametrize("scale", SCALES)
def test_no_corner_is_black(scale, lights):
    for sketch in (l_room(), Sketch((90, 70, 34))):
        volume = build(sketch, scale, lights=lights)
        inside = inside_of(volume)
        light = block_light(volume)
        assert light[inside].min() >= MIN_CORNER_LIGHT


@pytest.mark.parametrize("scale", [1.0, 2.0, 4.0, 7.0])
def test_lamps_hang_from_the_ceiling_over_a_player_s_head(scale):
    plain = build(furnished((40, 30, 34)), scale, lights="hidden")
    volume = build(furnished((40, 30, 34)), scale, lights="lamps")
    lamps = [
        i for i, s in enumerate(volume.palette)
        if s.partition("[")[0].endswith(("lantern", "froglight"))
    ]  # fmt: skip
    cells = np.argwhere(np.isin(volume.states, lamps))
    assert len(cells)
    ground = 64 - volume.corner[1]
    assert cells[:, 1].min() - ground >= WALK_BLOCKS
    assert not find_unstable(volume)
    shell = np.isin(plain.semantic, (FLOOR, WALL, CEILING))
    assert np.array_equal(volume.semantic[shell], plain.semantic[shell])
    assert (plain.states == 0).sum() > 0


def test_every_storey_has_its_lamps():
    volume = build_volume(
        house(), (), (), corner_m=np.array([0.0, 4.0]), parameters=BuildParameters(lights="lamps")
    )
    heights = {
        int(cell[1])
        for cell in np.argwhere(
            np.isin(
                volume.states,
                [i for i, s in enumerate(volume.palette) if "lantern" in s or "froglight" in s],
            )
        )
    }
    assert len({height > 64 - volume.corner[1] + 11 for height in heights}) == 2


def test_without_a_ceiling_nothing_hangs():
    volume = build(furnished(), ceiling="off", lights="lamps")
    assert not [s for s in volume.palette if "lantern" in s or "froglight" in s]


def test_where_one_cell_is_one_block_no_lamp_is_added():
    exact = build(furnished(), 12.5, lights="lamps")
    assert np.array_equal(exact.semantic, build(furnished(), 12.5).semantic)


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("sketch", [furnished(), l_room(), Sketch(walls=False, ceiling=False)])
def test_a_plaque_says_the_scene_s_name_where_one_sees_it(sketch, scale):
    plain, named = build(sketch, scale), build(sketch, scale, name="Grandmother's kitchen")
    (entity,) = named.block_entities
    cell = tuple(np.array(entity.block_pos) - named.corner)
    state = named.palette[named.states[cell]]
    assert entity.id == "minecraft:sign" and "_sign[" in state
    lines = [json.loads(line)["text"] for line in entity.nbt["front_text"]["messages"]]
    assert lines[:2] == ["Grandmother's", "kitchen"]
    assert not find_unstable(named)
    spawn = find_spawn(named)
    assert spawn == find_spawn(plain)
    assert np.hypot(*(np.array(entity.block_pos) + 0.5 - spawn.position)[[0, 2]]) <= FAR
    assert np.array_equal(named.semantic, plain.semantic)
    changed = named.states != plain.states
    assert np.argwhere(changed).tolist() == [list(cell)]


def test_a_plaque_can_be_left_out_or_say_something_else():
    assert build(furnished()).block_entities == ()
    assert build(furnished(), name="Room", plaque="off").block_entities == ()
    (entity,) = build(furnished(), name="Room", plaque="Number 7").block_entities
    assert "Number 7" in entity.nbt["front_text"]["messages"][0]


def test_a_click_on_the_plaque_changes_the_player_s_size():
    (large,) = build(furnished(), 4.0, name="Room").block_entities
    first = json.loads(large.nbt["front_text"]["messages"][0])
    assert first["clickEvent"] == {"action": "run_command", "value": "/function w2m:toggle_size"}
    (small,) = build(furnished(), 1.0, name="Room").block_entities
    assert "clickEvent" not in small.nbt["front_text"]["messages"][0]


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("style", ["blocks", "voxels"])
def test_nothing_of_a_furnished_room_would_fall_or_change(scale, style):
    grid, placements = furnished_room(2100, "study")
    volume = build_volume(
        grid,
        placements,
        (),
        corner_m=np.array(corner_of(2100, "study")),
        blocks_per_metre=scale,
        parameters=BuildParameters(style=style, lights="lamps"),
        name="Study",
    )
    assert find_unstable(volume) == []
    assert np.isin(volume.semantic, OBJECT_CLASSES).any()


@pytest.mark.parametrize("seed", (2101, 2103))
def test_a_room_built_from_its_cells_is_stable_in_the_game(seed):
    grid = true_grid(generate_room(seed))
    for scale in SCALES:
        assert find_unstable(build_volume(grid, (), (), blocks_per_metre=scale)) == []


@pytest.mark.parametrize(
    ("maker", "seed", "scale"),
    [(generate_house, 3, 4.0), (generate_room, 2103, 2.0)],
)
def test_every_wall_of_a_generated_home_stands(maker, seed, scale):
    """Each column of wall that one sees from a room has a block of wall in or beside its own."""
    room = maker(seed)
    full = true_grid(room)
    labels = np.where(full.labels > WALL + 1, 0, full.labels).astype(np.uint8)
    grid = replace(full, labels=labels, instance=np.zeros_like(full.instance))
    corner = np.array([0.0, np.round(room.size_m[1] / VOXEL_M) * VOXEL_M])
    volume = build_volume(grid, (), (), corner_m=corner, blocks_per_metre=scale)
    low = round(float(-grid.origin_m[2] / VOXEL_M))
    band = slice(low + 4, low + 22)
    walls = np.isin(labels[:, :, band], (WALL, WALL + 1)).mean(2) > 0.9
    cells = np.argwhere(walls & dilate_faces((labels[:, :, band] == 0).mean(2) > 0.9))
    points = np.column_stack([(cells + 0.5) * VOXEL_M + grid.origin_m[:2], np.ones(len(cells))])
    blocks = np.floor(apply(invert(volume.block_to_room), points) - volume.corner).astype(int)
    standing = dilate(np.isin(volume.semantic, (WALL, WALL + 1)), (1, 0, 1))
    assert standing[tuple(blocks.T)].all()


def test_what_would_fall_is_taken_away_with_what_it_carries():
    from world2minecraft.construction.block_lattice import lattice_over
    from world2minecraft.construction.canvas import Canvas

    canvas = Canvas(lattice_over(Sketch().grid(), np.array([0.0, 2.0]), 2.0))
    for z, state in enumerate(("sand", "oak_planks", "torch"), 3):
        canvas.put((3, 3, z), canvas.id_of(state), 11, 1)
    canvas.put((4, 4, 4), canvas.id_of("lantern"), 11, 2)
    canvas.put((4, 4, 5), canvas.id_of("red_carpet"), 11, 2)
    assert apply_block_updates(canvas) == 3
    kept = {canvas.palette[i] for i in np.unique(canvas.states)}
    assert {s.partition("[")[0] for s in kept} == {
        "minecraft:air", "minecraft:oak_planks", "minecraft:torch",
    }  # fmt: skip
    assert is_full_cube("oak_planks") and canvas.semantic[4, 4, 4] == 0


def test_a_ceiling_that_was_half_seen_is_closed_over_its_room():
    """And one of which only a corner was seen is not made up."""
    for seen, wanted in ((0.5, 1.0), (0.15, 0.3)):
        sketch = Sketch((50, 40, 30))
        hidden = int(50 * (1 - seen))
        sketch.labels[2 : 2 + hidden, :, 25:] = 255  # The scan did not look up there.
        volume = build(sketch)
        floor = (volume.semantic[:, 63 - volume.corner[1]] == FLOOR).sum()
        share = (volume.semantic == CEILING).sum() / floor
        assert (share >= wanted) if wanted == 1.0 else (share < wanted)


def test_a_ceiling_is_not_closed_where_one_saw_through():
    sketch = Sketch((50, 40, 30))
    sky = ((0, 0), (0, 0), (0, 8))
    sketch.labels = np.pad(sketch.labels, sky, constant_values=255)
    sketch.instance = np.pad(sketch.instance, sky)
    sketch.colour = np.pad(sketch.colour, (*sky, (0, 0)))
    sketch.labels[10:30, 10:30, 31:] = 0  # A skylight: seen free, far up.
    volume = build(sketch)
    level = int(np.flatnonzero((volume.semantic == CEILING).any((0, 2)))[0])
    hole = (volume.semantic[:, level] != CEILING) & (
        volume.semantic[:, 63 - volume.corner[1]] == FLOOR
    )
    assert hole.sum() >= 0.8 * (20 * VOXEL_M * 4) ** 2


@pytest.mark.parametrize("scale", SCALES)
def test_objects_before_a_hidden_wall_foot_add_no_floor_behind(scale):
    sketch = Sketch((50, 40, 30))
    sketch.put((18, 36), (-1, 0), (0, 16), 255, 0)  # Behind the sofa nothing was seen.
    sketch.put((20, 34), (-1, 0), (16, 26), WALL + 1, (180, 200, 210))
    sketch.put((18, 36), (-1, 9), (0, 10), 7, (90, 90, 90), 1)
    volume = build(sketch, scale)
    floor = volume.semantic[:, 63 - volume.corner[1]] == FLOOR
    assert np.flatnonzero(floor.any(0)).size == round(40 * VOXEL_M * scale)


@pytest.mark.parametrize("scale", SCALES)
def test_glass_shuts_a_room_whose_ceiling_nobody_saw(scale):
    sketch = Sketch(ceiling=False)
    sketch.labels[:, :, -2:] = 255
    opened, shut = build(sketch, scale), build(sketch, scale, ceiling="glass")
    rim = np.ones_like(opened.states, bool)
    rim[1:-1, 1:-1, 1:-1] = False
    assert (inside_of(opened) & rim).any() and not (inside_of(shut) & rim).any()
    assert not (opened.semantic == CEILING).any()


def test_a_palette_without_lamps_and_signs_gets_none(tmp_path):
    own = tmp_path / "plain.yaml"
    own.write_text("name: plain\nblocks: [white_concrete, oak_planks, glass, glass_pane]\n")
    volume = build(furnished(), palette=str(own), lights="lamps", name="Room")
    assert volume.block_entities == ()
    assert not [s for s in volume.palette if "lantern" in s or "froglight" in s]
