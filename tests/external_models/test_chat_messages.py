"""Pictures for models: never over the cap, their shape kept, and nothing else changed."""

import io

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from world2minecraft.cli.model_options import MAX_PIXELS
from world2minecraft.core.errors import UsageError
from world2minecraft.external_models.chat_messages import (
    MAX_PX,
    MIN_PX,
    Picture,
    check_max_px,
    downscale,
    downscale_picture,
)


def png(width, height):
    stream = io.BytesIO()
    Image.new("RGBA", (width, height), (200, 20, 30, 128)).save(stream, "PNG")
    return Picture(stream.getvalue(), "image/png")


@given(
    width=st.integers(1, 400), height=st.integers(1, 400), most=st.integers(MIN_PX, 40_000)
)  # fmt: skip
def test_no_picture_is_over_the_cap_nor_made_larger(width, height, most):
    small = downscale(np.zeros((height, width, 3), np.uint8), most)
    assert small.shape[0] * small.shape[1] <= most
    if width * height <= most:
        assert small.shape[:2] == (height, width)
    elif min(width, height) >= 40:
        assert small.shape[1] / small.shape[0] == pytest.approx(width / height, rel=0.2)
        assert small.shape[0] * small.shape[1] > 0.8 * most


def test_small_pictures_are_unchanged_and_large_ones_become_jpeg():
    own = png(30, 20)
    assert downscale_picture(own, 784) is own
    small = downscale_picture(png(300, 200), 15_000)
    image = Image.open(io.BytesIO(small.data))
    assert small.kind == "image/jpeg" and image.format == "JPEG" and image.size == (150, 100)
    assert downscale_picture(png(300, 200), 15_000) == small


def test_what_is_no_picture_is_told():
    with pytest.raises(ValueError, match="not an image that can be opened"):
        downscale_picture(Picture(b"\x89PNG no more"), 1000)


def test_a_cap_is_one_token_at_least():
    with pytest.raises(UsageError, match="max_px must be 784 or more, got 10"):
        check_max_px(10)


def test_the_command_has_the_same_cap():
    assert MAX_PIXELS == MAX_PX
