"""The box room of the scan tests once more, as triangles and points."""

import pytest
from mesh_rooms import room_quads


@pytest.fixture(scope="session")
def quads():
    return room_quads()
