"""Which device draws, and what is said where none can."""

import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest
from gpu_for_tests import CAMERA, adapter_name, assert_alike
from scenes import random_pose, random_volume

from world2minecraft.core.errors import MissingExtraError, UnknownNameError
from world2minecraft.rendering import prepare_scene, render_parallel, render_volume
from world2minecraft.rendering.gpu import (
    CpuRenderer,
    GpuError,
    GpuRenderer,
    choose_device,
    list_adapters,
    renderer_for,
)
from world2minecraft.rendering.gpu import backend_choice as choice
from world2minecraft.rendering.gpu import device as engines

FOUND = "world2minecraft.rendering.gpu.device._adapters"


def adapter(name: str, kind: str = "DiscreteGPU", backend: str = "Vulkan"):
    info = {"device": name, "adapter_type": kind, "backend_type": backend, "vendor": ""}
    return SimpleNamespace(info=info, limits={})


@pytest.fixture
def machine(monkeypatch):
    """Pretends that a machine has some adapters."""

    def have(*found):
        monkeypatch.delenv("W2M_GPU_ADAPTER", raising=False)
        monkeypatch.setattr(FOUND, lambda: list(found))
        monkeypatch.setattr("world2minecraft.rendering.gpu.device.find_spec", lambda name: True)
        monkeypatch.setattr(choice, "_shows_card", lambda folder: True)

    return have


@pytest.fixture
def scene():
    return prepare_scene(random_volume(np.random.default_rng(0)))


SOFTWARE = adapter("llvmpipe (LLVM 15.0.6, 256 bits)", "CPU")
CARD = adapter("Some Card 4000")


def test_auto_takes_a_card_and_never_software(machine):
    machine(CARD, SOFTWARE)
    assert choose_device("auto") == "gpu"
    machine(SOFTWARE)
    assert choose_device("auto") == "cpu"
    machine(adapter("SwiftShader Device", "Unknown"))
    assert choose_device("auto") == "cpu"
    machine()
    assert choose_device("auto") == "cpu"


def test_auto_takes_no_software_where_the_variable_names_it(machine, monkeypatch):
    machine(SOFTWARE)
    monkeypatch.setenv("W2M_GPU_ADAPTER", "software")
    assert choose_device("auto") == "cpu"
    assert choose_device("gpu") == "gpu"


def test_gpu_says_which_adapters_there_are(machine, monkeypatch):
    machine(SOFTWARE)
    with pytest.raises(GpuError) as caught:
        choose_device("gpu")
    assert str(caught.value) == (
        "no GPU found (adapters: llvmpipe (LLVM 15.0.6, 256 bits)); install its "
        "Vulkan driver or use the CPU (--device cpu); W2M_GPU_ADAPTER=software selects a software "
        "adapter for tests"
    )
    assert caught.value.exit_code == 2
    machine(CARD)
    monkeypatch.setenv("W2M_GPU_ADAPTER", "other")
    with pytest.raises(GpuError) as caught:
        choose_device("gpu")
    assert str(caught.value) == "GPU adapter 'other' not found; adapters: Some Card 4000"


def test_without_wgpu_gpu_fails_and_auto_uses_the_cpu(machine, monkeypatch, scene):
    machine(CARD)
    monkeypatch.setattr("world2minecraft.rendering.gpu.device.find_spec", lambda name: None)
    with pytest.raises(MissingExtraError) as caught:
        choose_device("gpu")
    assert str(caught.value) == (
        "the device gpu needs an extra: pip install 'world2minecraft[gpu]'"
    )
    assert choose_device("auto") == "cpu"
    assert renderer_for("auto", scene).name == "CPU"
    assert list_adapters() == []


def test_cpu_is_the_cpu_and_other_names_are_none(machine, scene):
    machine(CARD)
    assert choose_device("cpu") == "cpu"
    assert isinstance(renderer_for("cpu", scene), CpuRenderer)
    for ask in (lambda: choose_device("gpo"), lambda: renderer_for("gpo", scene)):
        with pytest.raises(UnknownNameError) as caught:
            ask()
        assert str(caught.value) == "no device is named 'gpo'; did you mean 'gpu'?"


def test_a_card_that_gives_no_device_is_named(machine, scene):
    def refuse(**_):
        raise RuntimeError("limits")

    broken = adapter("Old Card")
    broken.request_device_sync = refuse
    machine(broken)
    with pytest.raises(GpuError) as caught:
        renderer_for("gpu", scene)
    assert str(caught.value) == "Old Card cannot be used: limits; use the CPU (--device cpu)"
    assert renderer_for("auto", scene).name == "CPU"


def test_a_world_that_is_too_large_is_named_with_its_sizes(scene, monkeypatch):
    limits = {"max-storage-buffer-binding-size": 1 << 27, "max-buffer-size": 1 << 28}
    monkeypatch.setattr(
        engines, "buffer_bytes", lambda scene: {"cells": 1 << 27, "light": 1_500_000_000}
    )
    small = engines.Engine("Small Card", SimpleNamespace(limits=limits), None)
    with pytest.raises(GpuError) as caught:
        small.check_fits(scene)
    assert str(caught.value) == (
        "a world of 9 x 7 x 8 blocks is too large for Small Card: buffer light needs "
        "1,500 MB, the limit is 134 MB; use the CPU (--device cpu) or a smaller box (--box)"
    )


@pytest.mark.parametrize(
    ("files", "shows"),
    [
        ((), False),
        (("null", "shm"), False),
        (("dri/card0",), False),
        (("dri/renderD128",), True),
        (("nvidia0",), True),
        (("dxg",), True),
    ],
)
def test_a_card_shows_itself_by_its_files(files, shows, tmp_path):
    for name in files:
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).touch()
    assert choice._shows_card(tmp_path) is shows


def test_both_devices_are_asked_in_the_same_words(scene, monkeypatch):
    pose = random_pose(np.random.default_rng(1), random_volume(np.random.default_rng(0)))
    truth = render_volume(scene, CAMERA, pose, samples=2)
    flat = render_parallel(scene, 9.0, (20, 24), pose)
    renderers = [renderer_for("cpu", scene, threads=2)]
    renderers.append(renderer_for("gpu", scene, adapter=adapter_name()))
    assert isinstance(renderers[1], GpuRenderer)
    assert renderers[1].name
    for renderer in renderers:
        (picture,) = renderer.render_many(CAMERA, [pose], samples=2)
        assert_alike(picture, truth)
        assert (renderer.render_parallel(9.0, (20, 24), pose).face == flat.face).mean() > 0.99
        renderer.update(scene)
        renderer.close()


def test_wgpu_is_not_imported_before_it_is_asked_for():
    code = (
        "import sys, world2minecraft.rendering.gpu as gpu; gpu.choose_device('cpu');"
        "sys.exit('wgpu' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
