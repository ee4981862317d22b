"""The segmentation network: shapes, learning, resumed runs, calibration and export."""

from dataclasses import replace

import numpy as np
import pytest
import torch
from labelled_rooms import room_frame

from world2minecraft.networks.segmentation import training
from world2minecraft.networks.segmentation.augmentation import Example
from world2minecraft.networks.segmentation.calibration import (
    Calibration,
    fit_calibration,
    fit_temperature,
    undo_class_weights,
)
from world2minecraft.networks.segmentation.export import CalibratedNet, export_segmentation
from world2minecraft.networks.segmentation.frames import IGNORED
from world2minecraft.networks.segmentation.network import TINY, InvertedResidual, SegmentationNet
from world2minecraft.networks.segmentation.scores import (
    SegmentationScores,
    calibration_error,
    confusion_matrix,
    frame_logits,
    mirror_geometry,
    score_network,
)
from world2minecraft.networks.segmentation.training import (
    ExampleBatches,
    SegmentationRun,
    Trainer,
    class_weights,
    segmentation_loss,
)
from world2minecraft.reconstruction.recognition.segmentation import SegmentationModel

RUN = SegmentationRun(steps=40, batch=2, warm_steps=5, crop=(64, 48), size=TINY, fall=0.25)


@pytest.fixture(scope="module")
def frames():
    return [room_frame(seed) for seed in range(3)]


def random_inputs(height, width, seed=0):
    torch.manual_seed(seed)
    return torch.randn(1, 3, height, width), torch.randn(1, 7, (height + 1) // 2, (width + 1) // 2)


@pytest.mark.parametrize("shape", [(48, 64), (33, 47), (240, 320), (101, 64), (32, 32)])
def test_logits_have_a_quarter_of_the_sides(shape):
    logits = SegmentationNet(TINY).eval()(*random_inputs(*shape))
    assert logits.shape == (1, 40, -(-shape[0] // 4), -(-shape[1] // 4))


def test_geometry_starts_without_effect_and_gets_gradients():
    network = SegmentationNet(TINY).eval()
    colour, geometry = random_inputs(48, 64)
    before = network(colour, geometry)
    assert torch.equal(before, network(colour, torch.zeros_like(geometry)))
    before.square().mean().backward()
    assert all(join.weight.grad.abs().max() > 0 for join in network.geometry.joins)


def test_training_computes_what_evaluation_does():
    # Training takes matrix products and another order of axes; without what is random they agree.
    network = SegmentationNet(TINY).eval()
    given = random_inputs(48, 64)
    evaluated = network(*given)
    random = torch.nn.BatchNorm2d | torch.nn.Dropout2d | InvertedResidual
    for module in network.modules():
        module.training = not isinstance(module, random)
    assert torch.allclose(network(*given), evaluated, atol=1e-5)


def test_ignored_pixels_do_not_count():
    torch.manual_seed(0)
    logits, labels = torch.randn(1, 40, 4, 4), torch.randint(0, 39, (1, 4, 4), dtype=torch.uint8)
    labels[0, 0] = IGNORED
    loss = segmentation_loss(logits, labels, torch.ones(40))
    logits[0, :, 0] += torch.randn(40, 4)
    assert segmentation_loss(logits, labels, torch.ones(40)) == pytest.approx(float(loss))
    labels[:] = IGNORED
    assert float(segmentation_loss(logits, labels, torch.ones(40))) == 0


def test_class_weights_fall_with_the_root_of_the_share():
    shares = np.zeros(40)
    shares[:3] = 0.64, 0.36 - 1e-6, 1e-6
    weights = class_weights(shares)
    assert weights[1] / weights[0] == pytest.approx(0.8 / 0.6, rel=1e-4)
    assert weights[2] == 6
    assert (weights[3:] == 1).all()


def test_a_run_learns(frames):
    trainer = Trainer(replace(RUN, steps=20, rate=1e-2, encoder_rate=1.0, mean_of=0.8), frames)
    losses = []
    trainer.train(20, lambda step, loss, network: losses.append(loss), 5)
    assert losses[-1] < 0.5 * losses[0]
    assert score_network(trainer.mean, frames).pixel_accuracy > 0.5


def test_a_resumed_run_ends_with_the_same_weights(frames, tmp_path):
    run = replace(RUN, pretraining=0.1, generated_share=0.3)  # 4 steps of generated frames.
    whole = Trainer(run, frames[:2], frames[2:])
    whole.train(7)
    part = Trainer(run, frames[:2], frames[2:])
    part.train(4)
    part.save(tmp_path)
    rest = Trainer(run, frames[:2], frames[2:])
    assert not rest.resume(tmp_path / "elsewhere")
    assert rest.resume(tmp_path)
    rest.train(7)
    for name in ("network", "mean"):
        states = [getattr(one, name).state_dict() for one in (whole, rest)]
        assert all(torch.equal(states[0][key], states[1][key]) for key in states[0])


@pytest.fixture
def shown(frames, monkeypatch):
    """A function that returns the names of the frames in each of the first steps of a run."""
    names = []

    def noted(frame, rng, crop):
        names.append(frame.name)
        return Example(np.zeros((3, 2, 2)), np.zeros((7, 1, 1)), np.zeros((1, 1), np.uint8))

    def names_of(run, real, generated, steps):
        batches = ExampleBatches(run, real, generated)
        for step in range(steps):
            batches[step]
        return np.array(names).reshape(steps, run.batch)

    monkeypatch.setattr(training, "draw_example", noted)
    return names_of


def test_each_frame_is_drawn_once_a_round(frames, shown):
    seen = shown(RUN, frames, [], 6).reshape(4, 3)
    assert (np.sort(seen, axis=1) == ["0000", "0001", "0002"]).all()


@pytest.mark.parametrize("share", [0.0, 0.4, 1.0])
def test_generated_frames_have_their_share(frames, shown, share):
    run = replace(RUN, steps=100, batch=8, pretraining=0.25, generated_share=share)
    is_generated = shown(run, frames[:1], frames[1:], 100) != "0000"
    assert is_generated[:25].all()
    assert is_generated[25:].mean() == pytest.approx(share, abs=0.07 if share == 0.4 else 0)


@pytest.mark.parametrize("kind", ["real", "generated"])
def test_a_run_may_have_one_kind_of_frames(frames, shown, kind):
    run = replace(RUN, pretraining=0.5, generated_share=0.5)
    given = (frames, []) if kind == "real" else ([], frames)
    assert set(shown(run, *given, 40).flat) == {"0000", "0001", "0002"}


def test_batches_of_a_step_are_the_same(frames):
    first, second = (ExampleBatches(RUN, frames[:2], frames[2:]) for _ in range(2))
    first[3]
    for one, other in zip(first[7], second[7], strict=True):
        assert torch.equal(one, other)
    assert not torch.equal(first[7][0], first[8][0])


def test_learning_rate_is_constant_and_then_falls(frames):
    trainer = Trainer(RUN, frames)
    rates = [trainer.learning_rate_at(step) for step in range(RUN.steps)]
    assert rates[0] < rates[4] == rates[30] == RUN.rate
    assert np.all(np.diff(rates[30:]) < 0)


def test_encoder_learns_at_a_lower_rate(frames):
    trainer = Trainer(replace(RUN, encoder_rate=0.0, decay=0.0), frames)
    before = {key: value.clone() for key, value in trainer.network.named_parameters()}
    trainer.train(2)
    for key, value in trainer.network.named_parameters():
        if key.startswith("encoder."):
            assert torch.equal(value, before[key])
    after = trainer.network.decoder.classify[1].weight
    assert not torch.equal(after, before["decoder.classify.1.weight"])


def test_scores_of_a_perfect_and_a_wrong_answer():
    truth = np.array([0, 1, 3, 4, IGNORED])
    perfect = SegmentationScores(confusion_matrix(truth, np.array([0, 1, 3, 4, 7])))
    assert (perfect.pixel_accuracy, perfect.mean_iou) == (1, 1)
    assert perfect.eleven.pixel_accuracy == 1
    # A night stand for a dresser is wrong among 40, but both are furniture of the eleven.
    other = SegmentationScores(confusion_matrix(np.array([16, 0]), np.array([31, 0])))
    assert other.pixel_accuracy == 0.5
    assert other.eleven.pixel_accuracy == 1


def test_calibration_error_of_known_answers():
    rng = np.random.default_rng(0)
    confidence = rng.uniform(0.2, 1, 200_000)
    is_right = rng.random(200_000) < confidence
    assert calibration_error(confidence, is_right) < 0.01
    assert calibration_error(np.full(1000, 0.9), np.arange(1000) % 2 == 0) == pytest.approx(0.4)


def test_temperature_of_overconfident_logits_is_found():
    torch.manual_seed(0)
    logits = torch.randn(20_000, 5)
    truth = torch.distributions.Categorical(logits=logits).sample()
    assert fit_temperature(logits * 2.5, truth) == pytest.approx(2.5, rel=0.05)


def test_undone_weights_are_a_share_of_their_logarithm():
    weights = np.array([1, 4, 0.25], np.float32)
    assert undo_class_weights(weights, 0.5) == pytest.approx([0, -np.log(2), np.log(2)])


def test_calibration_has_a_temperature_for_each_input(frames):
    trainer = Trainer(RUN, frames)
    trainer.train(5)
    with torch.no_grad():
        trainer.mean.decoder.classify[1].weight.mul_(20)  # Too sure of itself.
    calibration = fit_calibration(trainer.mean, frames[:1], trainer.weights.numpy())
    assert len(set(calibration.temperatures)) == 3
    assert min(calibration.temperatures) > 1
    assert calibration.offset.shape == (40,)


@pytest.fixture(scope="module")
def exported(frames, tmp_path_factory):
    """A network, its calibration, and an exported file with the report."""
    trainer = Trainer(RUN, frames)
    trainer.train(10)
    calibration = Calibration(np.linspace(-1, 1, 40, dtype=np.float32), (1.5, 2.0, 3.0))
    path = tmp_path_factory.mktemp("exported") / "segmentation.onnx"
    report = export_segmentation(trainer.mean, calibration, path, {"steps": "10"})
    return trainer.mean, calibration, path, report


def test_export_reports_how_far_it_is_off(exported):
    _, _, path, report = exported
    assert report.difference < 1e-5
    assert 0 < report.moved < 1e-4
    assert report.size == path.stat().st_size


def test_int8_file_is_smaller_and_close(exported, tmp_path):
    network, calibration, _, half = exported
    path = tmp_path / "small.onnx"
    report = export_segmentation(network, calibration, path, {}, weights="int8")
    assert report.size < half.size
    assert half.moved < report.moved < 1e-3


@pytest.mark.parametrize("inputs", [{}, {"depth": False}, {"colour": False}])
def test_exported_file_computes_what_the_network_does(frames, exported, inputs):
    network, calibration, path, _ = exported
    frame = frames[0]
    temperature = {"depth": 2.0, "colour": 3.0}.get(next(iter(inputs), ""), 1.5)
    logits = frame_logits(network, frame, mirrored=True, **inputs)
    offset = torch.from_numpy(calibration.offset)[:, None, None]
    wanted = ((logits + offset) / temperature).softmax(dim=0)
    found = SegmentationModel(path).predict(
        frame.colour if inputs.get("colour", True) else None,
        frame.stored_m if inputs.get("depth", True) else None,
        frame.camera,
    )
    assert found.shape == (240, 320, 40)
    assert found.sum(axis=2) == pytest.approx(1, abs=1e-4)
    sampled = found[2::5, 2::5].transpose(2, 0, 1)  # The frame has 64 x 48 pixels.
    assert np.abs(sampled - wanted.numpy()).max() < 0.02


def test_mirrored_batch_is_the_mean_of_two_runs(frames):
    network = Trainer(RUN, frames).mean.eval()
    offset = torch.linspace(-1, 1, 40)
    calibrated = CalibratedNet(network, Calibration(offset.numpy(), (2.0, 1, 1)))
    colour, geometry = random_inputs(48, 64)
    turned = network(colour.flip(3), mirror_geometry(geometry)).flip(3)
    logits = ((network(colour, geometry) + turned) / 2 + offset.view(-1, 1, 1)) / 2.0
    fine = torch.nn.functional.interpolate(logits, (48, 64), mode="bilinear", align_corners=False)
    assert torch.allclose(calibrated(colour, geometry), fine.softmax(dim=1), atol=1e-6)


def test_mirrored_look_is_symmetric(frames):
    network = CalibratedNet(Trainer(RUN, frames).mean, Calibration(np.zeros(40, np.float32)))
    colour, geometry = random_inputs(48, 64)
    first = network(colour, geometry)
    second = network(colour.flip(3), mirror_geometry(geometry))
    assert torch.allclose(first, second.flip(3), atol=1e-5)
