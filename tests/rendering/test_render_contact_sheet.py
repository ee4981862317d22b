"""The contact sheet: every card has its place, every picture its thing."""

import numpy as np
import pytest
from scenes import volume_of

from world2minecraft.rendering.furniture_sheet import (
    CARD,
    TILE_PX,
    Card,
    contact_sheet,
    object_picture,
    sheet_png,
)


def cube(low, high):
    states = np.zeros((6, 6, 6), np.int64)
    states[tuple(slice(a, b) for a, b in zip(low, high, strict=True))] = 2
    return volume_of(states)


def drawn(picture):
    return (np.abs(picture.astype(int) - CARD) > 8).any(axis=-1)


def test_a_thing_stands_in_the_middle_whole():
    for low, high in (((0, 0, 0), (6, 6, 6)), ((4, 0, 1), (5, 3, 2)), ((0, 5, 0), (6, 6, 1))):
        seen = np.argwhere(drawn(object_picture(cube(low, high))))
        assert seen.min() > 0 and seen.max() < TILE_PX - 1
        middle = (seen.min(axis=0) + seen.max(axis=0)) / 2
        assert np.abs(middle - TILE_PX / 2).max() < 3


def test_the_front_is_seen():
    """What stands out to the front, which is room +x, lies low in the picture and to the left."""
    states = np.zeros((2, 1, 1), np.int64)
    states[:, 0, 0] = 2, 6
    picture = object_picture(volume_of(states)).astype(int)
    red = drawn(picture) & (picture[..., 0] > picture[..., 1] + 50)
    other = drawn(picture) & ~red
    assert np.argwhere(red)[:, 0].mean() > np.argwhere(other)[:, 0].mean()


def test_a_page_has_room_for_all_cards():
    cards = [Card(f"thing {n}", "a note", {"1": cube((0, 0, 0), (2, 2, 2))}) for n in range(5)]
    small = contact_sheet({"Things": cards[:2]}, columns=2)
    large = contact_sheet({"Things": cards[:2], "None": [], "More": cards[2:]}, columns=2)
    assert large.shape[1] == small.shape[1] and large.shape[0] > 2 * small.shape[0]
    assert sheet_png(small) == sheet_png(contact_sheet({"Things": cards[:2]}, columns=2))


def test_letters_that_the_font_lacks_become_plain_ones():
    volumes = {"1": cube((0, 0, 0), (2, 2, 2))}
    accented = contact_sheet(
        {"X": [Card("Chaise \N{LATIN SMALL LETTER E WITH ACUTE}", "", volumes)]}
    )
    assert np.array_equal(accented, contact_sheet({"X": [Card("Chaise e", "", volumes)]}))


def test_an_empty_sheet_is_refused():
    with pytest.raises(ValueError, match="a contact sheet needs at least one card"):
        contact_sheet({"Nothing": []})
