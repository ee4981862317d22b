"""Weights and checkpoints as safetensors files, which contain arrays and text but no code.

A checkpoint contains the weights, the moments of AdamW and facts such as the step. Data and
augmentation are derived from the seed and the step, so random generators need not be saved.
"""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import torch
from safetensors import SafetensorError, safe_open
from safetensors.torch import save
from torch import Tensor, nn

from world2minecraft.core.errors import MALFORMED, DamagedFileError, InputError
from world2minecraft.core.files import write_bytes
from world2minecraft.networks.config import RunConfig, config_text, parse_config

CONFIG, FACTS = "run", "facts"  # Keys of a file's texts.
MODEL, OPTIMISER = "model.", "optimiser."


def write_weights(path: Path, network: nn.Module, config: RunConfig) -> None:
    """Write the weights of a network together with the settings of its run.

    Raises:
        OutputError: If the file cannot be written.
    """
    write_bytes(path, save(_cpu_tensors(network.state_dict()), {CONFIG: config_text(config)}))


def read_weights_config(path: Path) -> RunConfig:
    """Read the run settings that are stored with weights.

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If the file was not written by ``w2m train``.
    """
    _, texts = _read(path, with_tensors=False)
    if CONFIG not in texts:
        raise DamagedFileError(
            path, "contains no run settings; expected weights written by w2m train"
        )
    return parse_config(texts[CONFIG], str(path))


def load_weights(path: Path, network: nn.Module) -> None:
    """Load weights into a network of the same kind and size.

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If the file is not valid or belongs to another network.
    """
    tensors, _ = _read(path)
    _load_state(path, network, tensors)


def write_checkpoint(
    path: Path, network: nn.Module, optimiser: torch.optim.Optimizer, facts: Mapping[str, Any]
) -> None:
    """Write a checkpoint of an unfinished run.

    Raises:
        OutputError: If the file cannot be written.
    """
    tensors = {MODEL + name: value for name, value in network.state_dict().items()}
    for number, state in optimiser.state_dict()["state"].items():
        for name, value in state.items():
            tensors[f"{OPTIMISER}{number}.{name}"] = torch.as_tensor(value)
    write_bytes(path, save(_cpu_tensors(tensors), {FACTS: json.dumps(facts)}))


def read_facts(path: Path) -> dict[str, Any]:
    """Read the facts about the run that are stored in a checkpoint.

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If the file is not a checkpoint.
    """
    _, texts = _read(path, with_tensors=False)
    try:
        return dict(json.loads(texts[FACTS]))
    except MALFORMED as error:
        raise DamagedFileError(path, "not a checkpoint of w2m train") from error


def load_checkpoint(
    path: Path, network: nn.Module, optimiser: torch.optim.Optimizer | None = None
) -> None:
    """Load a checkpoint into a network and, if given, into its optimizer.

    Raises the same exceptions as ``load_weights``.
    """
    tensors, _ = _read(path)
    model = {
        name.removeprefix(MODEL): value for name, value in tensors.items() if name.startswith(MODEL)
    }
    _load_state(path, network, model)
    if optimiser is None:
        return
    state: dict[int, dict[str, Tensor]] = {}
    for name, value in tensors.items():
        if name.startswith(OPTIMISER):
            number, _, part = name.removeprefix(OPTIMISER).partition(".")
            state.setdefault(int(number), {})[part] = value
    groups = optimiser.state_dict()["param_groups"]
    optimiser.load_state_dict({"state": state, "param_groups": groups})


def _cpu_tensors(tensors: Mapping[str, Tensor]) -> dict[str, Tensor]:
    return {name: value.detach().cpu().contiguous().clone() for name, value in tensors.items()}


def _load_state(path: Path, network: nn.Module, tensors: dict[str, Tensor]) -> None:
    own = network.state_dict()
    wrong = sorted(
        name
        for name in own.keys() | tensors.keys()
        if name not in own or name not in tensors or own[name].shape != tensors[name].shape
    )
    if wrong:
        raise DamagedFileError(
            path,
            f"belongs to another network: {wrong[0]} and {len(wrong) - 1} other tensors "
            "do not match",
        )
    network.load_state_dict(tensors)


def _read(path: Path, *, with_tensors: bool = True) -> tuple[dict[str, Tensor], dict[str, str]]:
    if not path.is_file():
        raise InputError(path, "not found; create it with w2m train NET --data DIR --out RUN")
    try:
        with safe_open(str(path), framework="pt", device="cpu") as file:
            names = file.keys() if with_tensors else ()
            return {name: file.get_tensor(name) for name in names}, dict(file.metadata() or {})
    except (SafetensorError, OSError, ValueError) as error:
        raise DamagedFileError(path, f"not a valid safetensors file ({error})") from error
