"""The segmentation network: shapes, start, learning, resumed runs, calibration and export."""

from dataclasses import replace

import numpy as np
import pytest
import torch
from labelled_rooms import room_frame

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.networks.segmentation import training
from world2minecraft.networks.segmentation.augmentation import draw_example
from world2minecraft.networks.segmentation.backbone import (
    encoder_convolutions,
    read_ncnn_convolutions,
    start_encoder,
)
from world2minecraft.networks.segmentation.calibration import (
    Calibration,
    fit_calibration,
    fit_temperature,
    undo_class_weights,
)
from world2minecraft.networks.segmentation.export import CalibratedNet, export_segmentation
from world2minecraft.networks.segmentation.frames import IGNORED
from world2minecraft.networks.segmentation.network import TINY, SegmentationNet
from world2minecraft.networks.segmentation.scores import (
    SegmentationScores,
    calibration_error,
    confusion_matrix,
    frame_logits,
    score_network,
)
from world2minecraft.networks.segmentation.training import (
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
    # Training takes matrix products and another order of the axes; without norms they agree.
    network = SegmentationNet(TINY)
    for module in network.modules():
        if isinstance(module, torch.nn.BatchNorm2d | torch.nn.Dropout2d):
            module.eval()
    given = random_inputs(48, 64)
    trained = network.eval()(*given)
    for module in network.modules():
        is_fixed = isinstance(module, torch.nn.BatchNorm2d | torch.nn.Dropout2d)
        module.training = not is_fixed
    assert torch.allclose(network(*given), trained, atol=1e-5)


def write_ncnn(path, weights, *, half=True):
    """A pair of files with a convolution for each (weight, bias), and layers between them."""
    lines, data = ["7767517", f"{len(weights) + 1} 2", "Input in 0 1 in"], b""
    for n, (weight, bias) in enumerate(weights):
        kind = "ConvolutionDepthWise" if n % 2 else "Convolution"
        lines.append(
            f"{kind} conv{n} 1 1 a b 0={len(weight)} 1={weight.shape[2]} 5={int(bias is not None)} "
            f"6={weight.size} 9=2 -23310=1,1.0e-01"
        )
        lines.append(f"ShuffleChannel shuffle{n} 1 1 a b 0=2")
        stored = weight.astype("<f2" if half else "<f4").tobytes()
        data += (0x01306B47 if half else 0).to_bytes(4, "little") + stored
        data += b"\0" * (-len(stored) % 4)
        data += b"" if bias is None else bias.astype("<f4").tobytes()
    path.write_text("\n".join(lines) + "\n")
    path.with_suffix(".bin").write_bytes(data)
    return path


def random_weights(shapes, seed=0):
    rng = np.random.default_rng(seed)
    return [
        (rng.standard_normal(s).astype(np.float16).astype(np.float32), rng.random(s[0], np.float32))
        for s in shapes
    ]


@pytest.mark.parametrize("half", [True, False])
def test_ncnn_weights_come_back(tmp_path, half):
    weights = random_weights([(4, 3, 3, 3), (3, 1, 3, 3), (5, 4, 1, 1)])  # 27 halves are padded.
    layers = read_ncnn_convolutions(write_ncnn(tmp_path / "net.param", weights, half=half))
    assert [layer.name for layer in layers] == ["conv0", "conv1", "conv2"]
    for layer, (weight, bias) in zip(layers, weights, strict=True):
        assert (layer.weight == weight).all()
        assert (layer.bias == bias).all()


def test_ncnn_layer_without_biases_has_zeros(tmp_path):
    ((weight, _),) = random_weights([(4, 3, 1, 1)])
    (layer,) = read_ncnn_convolutions(write_ncnn(tmp_path / "net.param", [(weight, None)]))
    assert (layer.bias == 0).all()


def test_damaged_ncnn_files_are_named(tmp_path):
    path = write_ncnn(tmp_path / "net.param", random_weights([(4, 3, 3, 3)]))
    data = path.with_suffix(".bin").read_bytes()
    path.with_suffix(".bin").write_bytes(data[:-8])
    with pytest.raises(DamagedFileError, match="ends inside layer conv0"):
        read_ncnn_convolutions(path)
    path.with_suffix(".bin").write_bytes(b"\x01\x02\x03\x04" + data[4:])
    with pytest.raises(DamagedFileError, match="unknown way"):
        read_ncnn_convolutions(path)
    with pytest.raises(DamagedFileError, match="has 0 convolutions"):
        path.write_text("7767517\n0 0\n")
        read_ncnn_convolutions(path, 1)
    path.write_text("hello\n")
    with pytest.raises(DamagedFileError, match="not an ncnn network"):
        read_ncnn_convolutions(path)


def test_encoder_starts_from_a_backbone(tmp_path):
    network = SegmentationNet(TINY)
    shapes = [tuple(one.weight.shape) for one in encoder_convolutions(network)]
    weights = random_weights(shapes)
    start_encoder(network, write_ncnn(tmp_path / "net.param", weights))
    first, *others = encoder_convolutions(network)
    assert (first.weight.detach().numpy() == weights[0][0][:, ::-1]).all()  # From BGR to RGB.
    for module, (weight, bias) in zip(others, weights[1:], strict=True):
        assert (module.weight.detach().numpy() == weight).all()
        assert (module.bias.detach().numpy() == bias).all()


def test_backbone_of_another_size_is_named(tmp_path):
    network = SegmentationNet(TINY)
    shapes = [tuple(one.weight.shape) for one in encoder_convolutions(network)]
    shapes[1] = (9, 1, 3, 3)
    with pytest.raises(DamagedFileError, match="conv1 has the shape"):
        start_encoder(network, write_ncnn(tmp_path / "net.param", random_weights(shapes)))


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
    trainer = Trainer(replace(RUN, steps=160), frames)
    losses = []
    trainer.train(160, lambda step, loss, network: losses.append(loss), 20)
    assert losses[-1] < 0.5 * losses[0]
    assert score_network(trainer.mean, frames).pixel_accuracy > 0.5


def test_a_resumed_run_ends_with_the_same_weights(frames, tmp_path):
    whole = Trainer(RUN, frames)
    whole.train(7)
    part = Trainer(RUN, frames)
    part.train(4)
    part.save(tmp_path)
    rest = Trainer(RUN, frames)
    assert not rest.resume(tmp_path / "elsewhere")
    assert rest.resume(tmp_path)
    rest.train(7)
    for name in ("network", "mean"):
        states = [getattr(one, name).state_dict() for one in (whole, rest)]
        assert all(torch.equal(states[0][key], states[1][key]) for key in states[0])


def test_each_frame_is_drawn_once_a_round(frames, monkeypatch):
    trainer, seen = Trainer(replace(RUN, batch=2), frames), []

    def noted(frame, rng, crop):
        seen.append(frame.name)
        return draw_example(frame, rng, crop)

    monkeypatch.setattr(training, "draw_example", noted)
    for step in range(6):
        trainer.batch(step)
    rounds = [sorted(seen[n : n + 3]) for n in range(0, 12, 3)]
    assert rounds == [["0000", "0001", "0002"]] * 4


def test_learning_rate_is_constant_and_then_falls(frames):
    trainer = Trainer(RUN, frames)
    rates = [trainer.learning_rate_at(step) for step in range(RUN.steps)]
    assert rates[0] < rates[4] == rates[30] == RUN.rate
    assert np.all(np.diff(rates[30:]) < 0)


def test_encoder_learns_at_a_lower_rate(frames):
    trainer = Trainer(replace(RUN, encoder_rate=0.0, decay=0.0), frames)
    before = {key: value.clone() for key, value in trainer.network.state_dict().items()}
    trainer.train(2)
    for key, value in trainer.network.state_dict().items():
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
    trainer.train(20)
    with torch.no_grad():
        trainer.mean.decoder.classify[1].weight.mul_(20)  # Too sure of itself.
    calibration = fit_calibration(trainer.mean, frames[:1], trainer.weights.numpy())
    assert len(set(calibration.temperatures)) == 3
    assert min(calibration.temperatures) > 1
    assert calibration.offset.shape == (40,)


@pytest.mark.parametrize("inputs", [{}, {"depth": False}, {"colour": False}])
def test_exported_file_computes_what_the_network_does(frames, tmp_path, inputs):
    trainer = Trainer(RUN, frames)
    trainer.train(10)
    offset = np.linspace(-1, 1, 40, dtype=np.float32)
    calibration = Calibration(offset, (1.5, 2.0, 3.0))
    path = tmp_path / "segmentation.onnx"
    report = export_segmentation(trainer.mean, calibration, path, {"steps": "10"})
    assert report.difference < 1e-5
    assert report.moved < 1e-4
    frame = frames[0]
    temperature = {"depth": 2.0, "colour": 3.0}.get(next(iter(inputs), ""), 1.5)
    logits = frame_logits(trainer.mean, frame, mirrored=True, **inputs)
    wanted = ((logits + torch.from_numpy(offset)[:, None, None]) / temperature).softmax(dim=0)
    found = SegmentationModel(path).predict(
        frame.colour if inputs.get("colour", True) else None,
        frame.stored_m if inputs.get("depth", True) else None,
        frame.camera,
    )
    assert found.shape == (240, 320, 40)
    assert found.sum(axis=2) == pytest.approx(1, abs=1e-4)
    sampled = found[2::5, 2::5].transpose(2, 0, 1)  # The frame has 64 x 48 pixels.
    assert np.abs(sampled - wanted.numpy()).max() < 0.02


def test_mirrored_look_is_symmetric(frames):
    network = CalibratedNet(
        Trainer(RUN, frames).mean, Calibration(np.zeros(40, np.float32)), mirrored=True
    )
    colour, geometry = random_inputs(48, 64)
    turned = geometry.flip(3).clone()
    turned[:, 4] *= -1
    first, second = network(colour, geometry), network(colour.flip(3), turned)
    assert torch.allclose(first, second.flip(3), atol=1e-5)
