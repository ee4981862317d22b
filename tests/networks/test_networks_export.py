"""A network's ONNX file says what the network says, and opens as the contract wants."""

import numpy as np
import pytest
import torch
from room_frames import SHAPE, VOXEL_M, room_batch

from world2minecraft.core.errors import OutputError
from world2minecraft.networks.models import NETWORKS, make_network
from world2minecraft.networks.onnx_export import MAX_DIFFERENCE, export_network
from world2minecraft.reconstruction.occupancy.onnx_network import NetworkFacts, OccupancyNetwork

USING_DEPTH = ("iso", "symphonies", "embodied")
CASES = [(name, name in USING_DEPTH) for name in NETWORKS.names()] + [("iso", False)]


@pytest.mark.parametrize(("name", "wants_depth"), CASES)
def test_onnx_predicts_the_same(name, wants_depth, tmp_path):
    inputs, _ = room_batch()
    network = make_network(name, "tiny", grid_shape=SHAPE, voxel_m=VOXEL_M, seed=1)
    size = inputs.image.shape[:1:-1]
    facts = NetworkFacts(name, SHAPE, VOXEL_M, tuple(size), wants_depth)
    written = export_network(network, tmp_path / "net.onnx", facts)
    assert written.difference <= MAX_DIFFERENCE
    assert written.moved == written.renamed == 0
    assert written.size == (tmp_path / "net.onnx").stat().st_size
    assert network.training
    read = OccupancyNetwork(tmp_path / "net.onnx")
    assert read.facts == facts
    # A picture that it was not traced with: nothing of the first may have become a constant.
    depth_m = inputs.depth_m if wants_depth else None
    with torch.no_grad():
        plain = type(inputs)(
            inputs.image, inputs.intrinsics, inputs.camera_to_grid, SHAPE, VOXEL_M, depth_m
        )
        said = network.eval()(plain).logits.softmax(dim=1).movedim(1, -1).numpy()
    for n in range(2):
        found = read.probabilities(
            inputs.image[n].numpy(), inputs.intrinsics[n].numpy(),
            inputs.camera_to_grid[n].numpy(), None if depth_m is None else depth_m[n].numpy(),
        )  # fmt: skip
        assert np.abs(found - said[n]).max() < MAX_DIFFERENCE


def test_a_file_that_predicts_something_else_is_not_written(tmp_path):
    class Fickle(torch.nn.Module):
        """Says something else each time, which no file can."""

        def forward(self, inputs):
            from world2minecraft.networks.batch import OccOutput

            return OccOutput(torch.randn(1, 12, *SHAPE) + inputs.image.mean())

    facts = NetworkFacts("fickle", SHAPE, VOXEL_M, (16, 12))
    with pytest.raises(OutputError, match=r"net.onnx: not written: the ONNX logits differ"):
        export_network(Fickle(), tmp_path / "net.onnx", facts)
    assert not (tmp_path / "net.onnx").exists()
