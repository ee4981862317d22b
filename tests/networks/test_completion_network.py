"""The completion network: shapes, learning, export, and a run that goes on where it ended."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.networks.completion.export import (
    average_exports,
    export_completion,
    restore_export,
    to_half_precision,
)
from world2minecraft.networks.completion.network import TINY, CompletionNet
from world2minecraft.networks.completion.sample_pool import SamplePool
from world2minecraft.networks.completion.samples import Sample, write_samples
from world2minecraft.networks.completion.training import CompletionRun, Trainer, completion_loss
from world2minecraft.reconstruction.semantics.completion_channels import CHANNELS, Sight
from world2minecraft.reconstruction.semantics.completion_labeller import CompletionModel, spans

RUN = CompletionRun(steps=60, batch=2, warm_steps=5, crop=(16, 16, 16), size=TINY)


def floor_and_box(seed):
    """A floor and a box on it, seen from above; its inside is unknown."""
    rng = np.random.default_rng(seed)
    truth = np.zeros((20, 20, 16), np.uint8)
    truth[:, :, :3] = 2
    x, y = rng.integers(3, 10, 2)
    truth[x : x + 6, y : y + 6, 3:9] = 10
    odds = np.full(truth.shape, -60, np.int8)
    odds[:, :, :2], odds[:, :, 2] = 0, 60
    odds[x : x + 6, y : y + 6, 2:8], odds[x : x + 6, y : y + 6, 8] = 0, 60
    at = np.flatnonzero(odds > 0).astype(np.int32)
    sight = Sight(odds, at, np.full(len(at), 40, np.uint8), 0.08, -0.24)
    return Sample(sight, truth, "walk", False, 0.0)


@pytest.fixture
def pool(tmp_path):
    for seed in range(3):
        write_samples(tmp_path / "samples" / f"{seed}.npz", [floor_and_box(seed)])
    return SamplePool(tmp_path / "samples", range(100))


@pytest.fixture(autouse=True)
def one_thread():
    threads = torch.get_num_threads()
    torch.set_num_threads(1)
    yield
    torch.set_num_threads(threads)


def test_logits_have_the_cells_of_what_went_in():
    logits = CompletionNet(TINY)(torch.zeros(2, CHANNELS, 16, 24, 8))
    assert logits.shape == (2, 12, 16, 24, 8)
    logits.sum().backward()


def test_every_weight_learns():
    network = CompletionNet(TINY)
    truth = torch.randint(0, 12, (1, 16, 16, 16))
    cells = torch.rand(1, CHANNELS, 16, 16, 16)
    torch.stack(list(completion_loss(network(cells), truth, truth > 0).values())).sum().backward()
    assert all(p.grad is not None and p.grad.abs().sum() > 0 for p in network.parameters())


def test_the_loss_is_least_at_the_truth_and_ignores_unknown():
    truth = torch.randint(0, 12, (1, 8, 8, 8))
    right = torch.nn.functional.one_hot(truth, 12).permute(0, 4, 1, 2, 3) * 40.0
    said = completion_loss(right, truth, truth > 0)
    assert all(float(value) < 1e-3 for value in said.values())
    wrong = completion_loss(-right, truth, truth > 0)
    assert all(float(wrong[name]) > 10 * float(said[name]) for name in said)
    assert float(wrong["jaccard"]) > 0.9
    half = truth.clone()
    half[:, :4] = 255
    spoilt = right.clone()
    spoilt[:, :, :4] = -spoilt[:, :, :4]
    assert float(completion_loss(spoilt, half, truth > 0)["entropy"]) < 1e-3


def test_a_tiny_network_learns_boxes_on_floors(pool):
    told = []
    Trainer(RUN, pool).train(60, lambda step, losses, network: told.append(losses), every=20)
    assert sum(told[-1].values()) < 0.5 * sum(told[0].values())


def test_a_broken_run_goes_on_as_if_it_had_not(pool, tmp_path):
    whole = Trainer(RUN, pool)
    whole.train(6)
    broken = Trainer(RUN, pool)
    broken.train(4)
    broken.save(tmp_path / "run")
    again = Trainer(RUN, pool)
    assert again.resume(tmp_path / "run")
    again.train(6)
    assert again.step == whole.step == 6
    for one, other in zip(whole.mean.parameters(), again.mean.parameters(), strict=True):
        assert torch.allclose(one, other, atol=1e-5)
    assert not Trainer(RUN, pool).resume(tmp_path / "nothing")


def test_the_same_run_twice_gives_the_same_weights(pool):
    runs = [Trainer(RUN, pool) for _ in range(2)]
    for run in runs:
        run.train(3)
    for one, other in zip(*(run.network.parameters() for run in runs), strict=True):
        assert torch.equal(one, other)


def test_the_rate_warms_up_stays_and_falls(pool):
    trainer = Trainer(replace(RUN, steps=1000), pool)
    first, warm, middle, last = (trainer.learning_rate_at(step) for step in (0, 4, 500, 999))
    assert first < warm == middle == RUN.rate
    assert last < 0.02 * RUN.rate


def test_a_folder_without_samples_is_refused(tmp_path):
    with pytest.raises(InputError, match="make_completion_samples"):
        SamplePool(tmp_path, range(100))


def test_onnx_predicts_what_torch_predicts(pool, tmp_path):
    trainer = Trainer(RUN, pool)
    trainer.train(10)
    path = tmp_path / "net.onnx"
    assert export_completion(trainer.mean, path, {"data": "boxes"}) < 1e-3
    sample = floor_and_box(7)
    chances = CompletionModel(path).chances(sample.sight)
    assert chances.shape == (12, 20, 20, 16)
    assert chances.sum(axis=0) == pytest.approx(1, abs=1e-4)


def test_folded_norms_change_nothing_but_rounding(pool):
    trainer = Trainer(RUN, pool)
    trainer.train(10)
    cells = torch.rand(1, CHANNELS, 16, 16, 16)
    with torch.no_grad():
        one, other = trainer.mean.eval()(cells), to_half_precision(trainer.mean)(cells)
    assert torch.allclose(one, other, atol=0.05)


@pytest.mark.parametrize("length", [1, 60, 112, 113, 200, 433])
def test_tiles_cover_a_side_once(length):
    kept = [n for low, first, last, high in spans(length) for n in range(first, last)]
    assert kept == list(range(length))
    assert all(high - low <= 128 for low, _, _, high in spans(length))


def test_training_goes_on_from_an_exported_network(pool, tmp_path):
    trainer = Trainer(RUN, pool)
    trainer.train(20)
    export_completion(trainer.mean, tmp_path / "old.onnx", {})
    cells, _, _ = pool.batch(np.random.default_rng(1), 2, RUN.crop)
    restored = CompletionNet(TINY)
    restore_export(restored, tmp_path / "old.onnx", cells)
    wanted = to_half_precision(trainer.mean)(cells)
    assert torch.allclose(restored.eval()(cells), wanted, atol=1e-3)
    assert torch.allclose(restored.train()(cells), wanted, atol=1e-2)
    other = Trainer(RUN, pool)
    other.start_from(tmp_path / "old.onnx")
    losses = []
    other.train(10, lambda step, found, _: losses.append(sum(found.values())), every=10)
    assert losses[0] < first_loss(pool)


def test_averaged_networks_have_weights_between_two(tmp_path):
    paths = [tmp_path / f"{name}.onnx" for name in ("first", "second", "between")]
    networks = []
    for path in paths[:2]:
        network = CompletionNet(TINY)
        for weights in network.parameters():
            torch.nn.init.normal_(weights)
        export_completion(network, path, {"run": path.stem})
        networks.append(to_half_precision(network))
    average_exports(*paths[:2], 0.25, paths[2])
    between = CompletionNet(TINY)
    cells = torch.rand(2, CHANNELS, 16, 16, 16)
    restore_export(between, paths[2], cells)
    states = [network.state_dict()["last.1.weight"] for network in (*networks, between)]
    assert torch.allclose(states[2], 0.75 * states[0] + 0.25 * states[1], atol=2e-3)
    export_completion(CompletionNet(replace(TINY, half=16)), paths[1], {})
    with pytest.raises(DamagedFileError, match="does not have the weights"):
        average_exports(*paths[:2], 0.5, paths[2])


def first_loss(pool):
    losses = []
    Trainer(RUN, pool).train(10, lambda step, found, _: losses.append(sum(found.values())), 10)
    return losses[0]


def test_weights_of_another_network_are_refused(pool, tmp_path):
    network = CompletionNet(TINY)
    for weights in network.parameters():
        torch.nn.init.normal_(weights)  # The file has equal weights only once.
    export_completion(network, tmp_path / "old.onnx", {})
    cells = torch.zeros(1, CHANNELS, 16, 16, 16)
    with pytest.raises(DamagedFileError, match="that the network does not have"):
        restore_export(CompletionNet(replace(TINY, half=16)), tmp_path / "old.onnx", cells)
