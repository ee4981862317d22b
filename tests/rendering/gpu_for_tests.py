"""What the tests of the compute shader share: an adapter, a camera, and how alike is alike."""

import numpy as np
import pytest

from world2minecraft.core.types import Camera
from world2minecraft.rendering import Picture
from world2minecraft.rendering.gpu import list_adapters

CAMERA = Camera(48, 36, 30.0, 30.0, 24.0, 18.0)
EVERYTHING = ("colour", "semantic", "instance", "opaque", "normal", "free")
IDS = ("block_index", "cube_index", "face", "opaque_index", "opaque_cube_index")
MOST_OTHER = 2  # Pixels of a picture whose ray grazes an edge, so that rounding decides.


def adapter_name() -> str:
    """The adapter to test with, software where there is one: it is the same on every machine."""
    found = list_adapters()
    if not found:
        pytest.skip("no GPU adapter, not even in software: install mesa-vulkan-drivers")
    return "software" if any(one.is_software for one in found) else found[0].name


def assert_alike(ours: Picture, truth: Picture) -> None:
    """Ids are equal but for a pixel or two; where they are, so are depth, normal and colour."""
    same = np.ones(truth.face.shape, bool)
    for name in IDS:
        if getattr(truth, name) is not None:
            same &= getattr(ours, name) == getattr(truth, name)
    assert (~same).sum() <= MOST_OTHER
    for name in ("depth_m", "range_m", "opaque_depth_m"):
        if getattr(truth, name) is not None:
            near = np.isclose(getattr(ours, name), getattr(truth, name), rtol=1e-4, atol=1e-4)
            assert (~near & same).sum() <= MOST_OTHER
    for name in ("semantic", "instance"):
        if getattr(truth, name) is not None:
            assert np.array_equal(getattr(ours, name)[same], getattr(truth, name)[same])
    if truth.normal is not None:
        assert np.allclose(ours.normal[same], truth.normal[same], atol=1e-5)
    if truth.colour is not None:
        apart = np.abs(ours.colour.astype(int) - truth.colour).max(axis=2)
        assert (apart <= 2).mean() >= 0.99
    if truth.free is not None:
        assert (ours.free != truth.free).mean() < 0.01
