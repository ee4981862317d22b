"""What lets CUDA builds of torchvision and torchaudio be imported beside a torch for the CPU.

Indexes without the CPU's own wheels give them; importing them then fails, though none of what is
trained here needs their compiled parts. Never import this from the package.
"""

import importlib.machinery
import sys
import types

import torch


def _is_broken(name):
    try:
        __import__(name)
    except (ImportError, OSError, RuntimeError):
        for module in [one for one in sys.modules if one.split(".")[0] == name]:
            del sys.modules[module]
        return True
    return False


if not torch.cuda.is_available():
    if _is_broken("torchaudio"):
        stub = types.ModuleType("torchaudio")
        stub.__spec__ = importlib.machinery.ModuleSpec("torchaudio", None)
        sys.modules["torchaudio"] = stub
    if _is_broken("torchvision"):
        library = torch.library.Library("torchvision", "DEF")
        library.define("nms(Tensor dets, Tensor scores, float iou_threshold) -> Tensor")
        library.define("qnms(Tensor dets, Tensor scores, float iou_threshold) -> Tensor")
