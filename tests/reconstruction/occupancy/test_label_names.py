"""What label names mean: by name alone, whatever their order and their spelling."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.classes import CLASS_COUNT, CLASS_NAMES
from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.core.vocabulary import read_vocabulary
from world2minecraft.reconstruction.occupancy.label_names import label_classes

TABLE = read_vocabulary().label_table()


def words(text: str) -> list[str]:
    return text.split()


# All names of the sets; of those with synonyms the first.
ADE20K = words(
    """
    wall building sky floor tree ceiling road bed windowpane grass cabinet sidewalk person
    earth door table mountain plant curtain chair car water painting sofa shelf house sea
    mirror rug field armchair seat fence desk rock wardrobe lamp bathtub railing cushion base
    box column signboard chest_of_drawers counter sand sink skyscraper fireplace refrigerator
    grandstand path stairs runway case pool_table pillow screen_door stairway river bridge
    bookcase blind coffee_table toilet flower book hill bench countertop stove palm
    kitchen_island computer swivel_chair boat bar arcade_machine hovel bus towel light truck
    tower chandelier awning streetlight booth television_receiver airplane dirt_track apparel
    pole land bannister escalator ottoman bottle buffet poster stage van ship fountain
    conveyer_belt canopy washer plaything swimming_pool stool barrel basket waterfall tent bag
    minibike cradle oven ball food step tank trade_name microwave pot animal bicycle lake
    dishwasher screen blanket sculpture hood sconce vase traffic_light tray ashcan fan pier
    crt_screen plate monitor bulletin_board shower radiator glass clock flag
    """
)
COCO_STUFF = words(
    """
    banner blanket bridge cardboard counter curtain door-stuff floor-wood flower fruit gravel
    house light mirror-stuff net pillow platform playingfield railroad river road roof sand
    sea shelf snow stairs tent towel wall-brick wall-stone wall-tile wall-wood water-other
    window-blind window-other tree-merged fence-merged ceiling-merged sky-other-merged
    cabinet-merged table-merged floor-other-merged pavement-merged mountain-merged
    grass-merged dirt-merged paper-merged food-other-merged building-other-merged rock-merged
    wall-other-merged rug-merged couch tv dining_table refrigerator potted_plant
    """
)
SCANNET = words(
    """
    wall floor cabinet bed chair sofa table door window bookshelf picture counter desk curtain
    refrigerator shower_curtain toilet sink bathtub otherfurniture
    """
)
NYU40 = words(
    """
    wall floor cabinet bed chair sofa table door window bookshelf picture counter blinds desk
    shelves curtain dresser pillow mirror floor_mat clothes ceiling books refrigerator
    television paper towel shower_curtain box whiteboard person night_stand toilet sink lamp
    bathtub bag otherstructure otherfurniture otherprop
    """
)


def class_of(name: str) -> str:
    row = label_classes([name], TABLE).matrix[0]
    return CLASS_NAMES[int(row.argmax())] if row.any() else "nothing"


@pytest.mark.parametrize(
    ("names", "count"), [(ADE20K, 150), (COCO_STUFF, 58), (SCANNET, 20), (NYU40, 40)]
)
def test_every_name_of_the_usual_sets_is_known(names, count):
    found = label_classes([name.replace("_", " ") for name in names], TABLE)
    assert len(names) == count and not found.unknown


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("windowpane, window", "window"),
        ("bed ", "bed"),
        ("Floor-Other-Merged", "floor"),
        ("sky-other-merged", "nothing"),
        ("rug-merged", "floor"),
        ("table-merged", "table"),
        ("blind, screen", "objs"),
        ("screen door, screen", "objs"),
        ("screen, silver screen, projection screen", "tvs"),
        ("chest of drawers, chest, bureau, dresser", "furn"),
        ("television receiver, television, television set, tv, tv set", "tvs"),
        ("sofa, couch, lounge", "sofa"),
        ("monitor, monitoring device", "tvs"),
        ("otherfurniture", "furn"),
        ("floor_mat", "floor"),
    ],
)
def test_spellings_and_synonyms(name, expected):
    assert class_of(name) == expected


@given(st.permutations(ADE20K))
def test_the_order_of_the_labels_plays_no_part(names):
    plain, mixed = (label_classes(order, TABLE) for order in (ADE20K, names))
    rows = dict(zip(ADE20K, plain.matrix, strict=True))
    assert all(np.array_equal(rows[n], row) for n, row in zip(names, mixed.matrix, strict=True))
    assert mixed.matrix.shape == (150, CLASS_COUNT) and not mixed.matrix[:, 0].any()


def test_unknown_names_are_told():
    assert label_classes(["wall", "gizmo ", "LABEL_7"], TABLE).unknown == (
        "gizmo",
        "LABEL_7",
    )


def test_a_table_of_ones_own_comes_first(tmp_path):
    own = tmp_path / "names.yaml"
    own.write_text("objs: [sink]\nfurn: [gizmo]\nnothing: [mirror]\n")
    table = read_vocabulary(own).label_table()
    rows = label_classes(["sink", "gizmo", "mirror", "chair"], table).matrix
    assert rows[0, 11] == rows[1, 10] == rows[3, 5] == 1 and not rows[2].any()


def test_a_table_of_ones_own_is_read_again_when_it_was_edited(tmp_path):
    own = tmp_path / "mine.yaml"
    for kind in ("chair", "table"):
        own.write_text(f"{kind}: [gizmo]")
        found = label_classes(["gizmo"], read_vocabulary(own).label_table())
        assert CLASS_NAMES[int(found.matrix[0].argmax())] == kind


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("chairs: [stool]", "no class is named 'chairs'; did you mean 'chair'"),
        ("chair: stool", "the entry 'chair' must be a list of label names"),
        ("[", "is not valid YAML"),
        ("chair: &a [stool]\nsofa: *a", "aliases .* are not supported"),
        ("", "must map names or classes to labels, such as chair:"),
        ("empty: [air]", "no class is named 'empty'"),
    ],
)
def test_a_wrong_table_is_refused_in_one_line(tmp_path, text, reason):
    own = tmp_path / "names.yaml"
    own.write_text(text)
    with pytest.raises(DamagedFileError, match=reason) as caught:
        read_vocabulary(own).label_table()
    assert "\n" not in str(caught.value)
    with pytest.raises(InputError, match="cannot be read"):
        read_vocabulary(tmp_path / "missing.yaml")
