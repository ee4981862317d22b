"""Wrong pictures: where they are taken, and that none of them is told by being near or far."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.navigation.data.free_floor import free_walker

from world2minecraft.navigation.data.distractors import (
    MAX_OF_A_KIND,
    RENDERED_KINDS,
    DistractorPicker,
    DistractorSampler,
    DistractorSlot,
    RankBalancer,
    is_valid_choice,
)
from world2minecraft.navigation.data.keyframes import find_keyframes
from world2minecraft.navigation.data.picture_store import (
    EncodedPicture,
    PictureStore,
    StoredPicture,
    picture_difference,
    show_different_views,
)
from world2minecraft.navigation.data.tasks import FOUND_OF, GRADES, MAX_FAR, view_question
from world2minecraft.navigation.types import MOVE_SETS, Move, Stance
from world2minecraft.navigation.walk_discretization import DiscreteWalk

VLNCE = MOVE_SETS["vlnce"]
F, L, R, STOP = Move.FORWARD, Move.LEFT, Move.RIGHT, Move.STOP


def way(*moves):
    """The keyframes of moves over an endless floor."""
    walk, stances = free_walker(VLNCE, 1.0), [Stance(0.0, 0.0, 0.0)]
    for move in moves:
        stances.append(walk(stances[-1], move)[0])
    return find_keyframes(DiscreteWalk((*moves, STOP), tuple(stances)), VLNCE, 0.25)


WAY = way(*[R] * 4, *[F] * 4, *[L] * 3, *[F] * 8, *[R] * 6)
SCOUT = DistractorSampler(free_walker(VLNCE, 1.0), 1.0)


def test_the_mirrored_walk_turns_to_the_other_side():
    (turn, ahead, left, *_) = WAY
    assert (turn.move, ahead.move, left.move) == (R, F, L)
    places = SCOUT.places("mirror", WAY, 2)
    mirrored = [(-one.x, one.z, -one.yaw_deg) for one in places]
    right = WAY[3].stance
    assert any(one == pytest.approx((right.x, right.z, right.yaw_deg)) for one in mirrored)


@pytest.mark.parametrize("step", range(len(WAY) - 1))
def test_no_place_is_the_right_one_and_no_move_is_the_ways(step):
    right, now = WAY[step + 1].stance, WAY[step].stance
    for kind in RENDERED_KINDS:
        assert right not in SCOUT.places(kind, WAY, step)
    turns = [one.yaw_deg - now.yaw_deg for one in SCOUT.places("other_move", WAY, step)]
    steps = [one for one in SCOUT.places("other_move", WAY, step) if one.yaw_deg == now.yaw_deg]
    assert not (WAY[step].move == F and steps)
    assert not (WAY[step].move == L and any(-90 < turn < 0 for turn in turns))
    for one in SCOUT.places("beside", WAY, step):
        from_now, from_right = (np.hypot(one.x - at.x, one.z - at.z) for at in (now, right))
        assert min(from_now, from_right) <= 0.75 + 1e-6
        assert one.yaw_deg in (now.yaw_deg, right.yaw_deg)


def test_a_wall_leads_nowhere():
    turns = free_walker(VLNCE, 1.0)
    scout = DistractorSampler(
        lambda stance, move: (stance, True) if move == F else turns(stance, move), 1.0
    )
    assert scout.places("beside", WAY, 2) == []
    assert {(one.x, one.z) for one in scout.places("other_move", WAY, 0)} == {(0.0, 0.0)}


@given(st.lists(st.integers(0, 3), max_size=60), st.integers(0, 9))
@settings(max_examples=50, deadline=None)
def test_ranks_even_out_whatever_came_before(before, seed):
    deck = RankBalancer(np.random.default_rng(seed))
    for rank in before:
        deck.came(rank)
    for _ in range(4 * len(before)):
        deck.came(deck.wanted())
    counts = deck._counts
    assert counts.max() - counts.min() <= 1 or counts.max() == max(map(before.count, range(4)))


def a_shot(value, rng):
    """A picture whose grey is about a value on one side, so that it shows something."""
    grey = np.full((18, 32), 128.0)
    grey[:, :16] = value
    noise = int(rng.integers(1 << 62))
    return EncodedPicture(b"", "0" * 64, 100.0, noise, 40.0, grey.astype(np.uint8).tobytes())


def pictured(name, stance, shot):
    return StoredPicture(name, stance, shot.sha256, shot.dhash, shot.detail, shot.small)


class FakeAlbum(PictureStore):
    """Pictures by how far a place is from the way's start."""

    def __init__(self, rng):
        self._rng, self.kept = rng, []
        super().__init__(None, self._shots, self._shots)  # type: ignore[arg-type]

    def _shots(self, stances):
        turned = [abs(one.yaw_deg) / 3 + 10 * np.hypot(one.x, one.z) for one in stances]
        return [a_shot(min(250.0, value), self._rng) for value in turned]

    def write(self, name, stance, shot):
        self.kept.append(name)
        return pictured(name, stance, shot)


@given(st.integers(0, 99), st.sampled_from(GRADES), st.integers(2, len(WAY) - 2))
@settings(max_examples=60, deadline=None)
def test_what_is_taken_is_as_near_as_its_slot_says(seed, grade, step):
    rng = np.random.default_rng(seed)
    album = FakeAlbum(rng)
    pictures = [
        pictured(f"{n}.jpg", mark.stance, album.take([mark.stance])[0])
        for n, mark in enumerate(WAY)
    ]
    deck = RankBalancer(rng)
    asked = view_question("t", WAY, pictures, step, grade, album, SCOUT, deck, rng)
    assert len(asked.slots) == 3
    now, right = pictures[step], pictures[step + 1]
    taken = [slot for slot in asked.slots if slot.picture is not None]
    assert sum(not slot.nearer for slot in taken) <= MAX_FAR[grade]
    for slot in taken:
        assert slot.picture is not None
        assert (
            picture_difference(now, slot.picture) < picture_difference(now, right)
        ) == slot.nearer
        assert show_different_views(slot.picture.stance, right.stance, 1.0)
        others = [one.picture for one in taken if one is not slot and one.picture]
        assert is_valid_choice(slot.picture, now, [right, *others])
    kinds = [slot.kind for slot in taken]
    assert all(kinds.count(kind) <= MAX_OF_A_KIND for kind in kinds)
    assert len(set(album.kept)) == len(album.kept)
    left = {slot.kind for slot in asked.slots if slot.picture is None}
    assert left <= set(FOUND_OF[grade])


def test_where_nothing_can_be_taken_slots_stay_open():
    rng = np.random.default_rng(0)
    album = FakeAlbum(rng)
    now, right = (pictured(f"{n}.jpg", Stance(0, 0, n), a_shot(n, rng)) for n in (0, 50))
    plan = [DistractorSlot("elsewhere", True), DistractorSlot("temporal", False)]
    assert DistractorPicker(album, now, right).filled(plan, [], 3) == plan
