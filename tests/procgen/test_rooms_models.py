"""The furniture: every model fills exactly the size that it states."""

import numpy as np
import pytest

from world2minecraft.procgen.houses.plan import railing_model
from world2minecraft.procgen.rooms import bathroom_fittings as washing
from world2minecraft.procgen.rooms import children_and_hall_furniture as playing
from world2minecraft.procgen.rooms import decor
from world2minecraft.procgen.rooms import household_models as household
from world2minecraft.procgen.rooms import seats_beds_tables as seating
from world2minecraft.procgen.rooms import storage_furniture as storage
from world2minecraft.procgen.rooms.clutter_models import IRREGULAR, ON_BEDS, ON_FLOORS, ON_TABLES
from world2minecraft.procgen.rooms.furniture_model import Part, round_to_step, shade

WOOD, CLOTH = (180, 140, 90), (70, 90, 130)


def rng():
    return np.random.default_rng(0)


MODELS = [
    seating.chair(WOOD, CLOTH),
    seating.office_chair(CLOTH),
    seating.armchair(CLOTH, WOOD),
    seating.sofa(2.13, CLOTH, CLOTH, WOOD),
    seating.table("table", 0.83, 1.6, 0.74, WOOD),
    seating.table("low_table", 0.6, 1.1, 0.42, WOOD),
    seating.desk(1.53, WOOD, CLOTH),
    seating.bed(1.6, WOOD, CLOTH),
    seating.bed(1.0, WOOD, CLOTH),
    storage.bookshelf(0.93, 1.9, WOOD, rng()),
    storage.cabinet("wardrobe", (0.6, 1.37, 2.06), 3, 1, WOOD, WOOD),
    storage.cabinet("dresser", (0.48, 1.1, 0.84), 2, 3, WOOD, WOOD),
    storage.counter(1.0, CLOTH, WOOD),
    storage.counter(1.31, CLOTH, WOOD, sink=True),
    storage.oven(CLOTH, WOOD),
    storage.wall_cabinet(0.9, CLOTH),
    storage.fridge(CLOTH),
    decor.tv(1.2),
    decor.monitor(),
    decor.floor_lamp(CLOTH),
    decor.table_lamp(WOOD),
    decor.pendant(0.95, CLOTH),
    decor.plant(1.23, rng()),
    decor.picture(0.73, 0.5, rng()),
    decor.curtain(0.3, 2.0, CLOTH),
    decor.crate((0.36, 0.46, 0.34), WOOD),
    decor.book_pile(rng()),
    decor.vase(CLOTH),
    decor.bowl(),
    decor.microwave(),
    decor.kettle(CLOTH),
    decor.hood(),
    decor.door(0.9, 2.04, WOOD),
    decor.waste_bin(CLOTH),
    decor.keyboard(),
    washing.toilet(),
    washing.washstand(CLOTH),
    washing.mirror(0.7),
    washing.bathtub(1.7),
    washing.shower(),
    washing.washing_machine(),
    playing.stool(CLOTH),
    playing.toy_shelf(WOOD, rng()),
    playing.shoe_cabinet(WOOD),
    playing.coats(rng(), WOOD),
    playing.bench(WOOD),
    playing.whiteboard(),
    playing.printer(),
    household.radiator(1.33),
    household.towel_radiator(CLOTH),
    household.wall_shelf(0.93, WOOD, rng()),
    household.standing_mirror(WOOD),
    household.dryer(),
    household.dishwasher(CLOTH, WOOD),
    household.blanket_chest(WOOD),
    household.display_cabinet(WOOD, rng()),
    household.piano(WOOD),
    household.piano_stool(CLOTH),
    household.fireplace(),
    household.ottoman(CLOTH),
    household.shoe_rack(WOOD, rng()),
    household.utility_shelf(rng()),
    household.single_bed(WOOD, CLOTH),
    household.bunk_bed(WOOD, CLOTH, CLOTH),
    household.shower_curtain(1.7, CLOTH),
    household.candles(),
    railing_model(1.77, WOOD),
]
ROUND = {household.laundry_basket, household.drying_rack, household.coat_stand,
         household.umbrella_stand}  # fmt: skip
MAKERS = sorted(
    {*IRREGULAR, *ON_BEDS, *ON_FLOORS, *ON_TABLES, *ROUND}, key=lambda maker: maker.__name__
)


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.name)
def test_the_parts_of_a_model_fill_its_size(model):
    boxes = np.array([part.box_m for part in model.parts])
    depth, width, height = model.size_m
    low, high = boxes[:, :3].min(axis=0), boxes[:, 3:].max(axis=0)
    assert np.allclose(low, [-depth / 2, -width / 2, 0], atol=1e-6)
    assert np.allclose(high, [depth / 2, width / 2, height], atol=1e-6)
    assert (boxes[:, 3:] > boxes[:, :3]).all()
    steps = np.array(model.size_m) / 0.02
    assert np.allclose(steps, np.round(steps))


def test_lengths_are_rounded_to_two_centimetres():
    assert round_to_step(1.013) == pytest.approx(1.02)
    assert round_to_step(0.5) == pytest.approx(0.5)


def test_shades_stay_colours():
    assert shade((100, 200, 250), 1.5) == (150, 255, 255)
    assert Part((0, 0, 0, 1, 1, 1), (1, 2, 3)).grain == "plain"


@pytest.mark.parametrize("maker", MAKERS, ids=lambda maker: maker.__name__)
@pytest.mark.parametrize("seed", [0, 1])
def test_a_model_stands_on_its_floor_and_has_a_plausible_size(maker, seed):
    model = maker(np.random.default_rng(seed))
    boxes = np.array([part.box_m for part in model.parts])
    size = np.array(model.size_m)
    assert np.allclose(size / 0.02, np.round(size / 0.02))
    assert (size > 0.03).all() and (size < 1.9).all()
    # Round ends may reach over the voxels that they fill, by less than one.
    assert (boxes[:, :3].min(axis=0) > [-size[0] / 2 - 0.021, -size[1] / 2 - 0.021, -0.021]).all()
    assert (boxes[:, 3:].max(axis=0) < [*(size[:2] / 2 + 0.021), size[2] + 0.021]).all()
