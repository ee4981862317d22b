"""Networks of the transformers library, by the name on the hub or from a folder.

Nothing is downloaded unless a network is asked for by name and is not yet on this computer. Only
safetensors are read, and no code that comes with a model is run.
"""

import hashlib
import json
import re
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import DamagedFileError, InputError, MissingExtraError, first_line
from world2minecraft.external_models.pictures import prepared

MODEL_NAME = re.compile(r"[A-Za-z0-9][\w.-]*(/[A-Za-z0-9][\w.-]*)?", re.ASCII)
READY_FILES = ("preprocessor_config.json", "processor_config.json")
SHORT = 16  # Digits of a digest that tell two models apart.


def library(feature: str) -> Any:
    """Return the transformers library, silent.

    Raises:
        MissingExtraError: torch or transformers is not installed; ``feature`` is what needs them.
    """
    try:
        import torch  # noqa: F401, PLC0415  # pyright: ignore[reportMissingImports]
        import transformers  # noqa: PLC0415  # pyright: ignore[reportMissingImports]
    except ImportError:
        raise MissingExtraError(feature, "hf") from None
    transformers.utils.logging.disable_progress_bar()
    return transformers


def checked_name(model: str) -> str:
    """Return what reports call a model.

    Raises:
        InputError: it is neither a folder nor could be the name of a model.
    """
    folder = Path(model).is_dir()
    if not folder and not MODEL_NAME.fullmatch(model):
        raise InputError(model, "neither a folder nor the name of a model, ORG/NAME")
    return f"hf:{Path(model).resolve().name if folder else model}"


def identity(model: str, transformers: Any) -> str:
    """Return what tells this state of a model from any other: a digest or the hub's commit.

    Raises:
        InputError: there is no such model.
    """
    if Path(model).is_dir():
        digest = hashlib.sha256()
        for path in sorted(Path(model).glob("*")):
            if path.suffix in (".json", ".safetensors", ".txt"):
                digest.update(path.name.encode() + b"\0")
                with path.open("rb") as stream:
                    digest.update(hashlib.file_digest(stream, "sha256").digest())
        return digest.hexdigest()[:SHORT]
    try:
        path = Path(transformers.utils.cached_file(model, "config.json"))
    except (OSError, ValueError):
        raise InputError(model, "no such model here or on the hub") from None
    return f"{model}@{path.parent.name[:SHORT]}"


def config(model: str, transformers: Any) -> Any:
    """Return the config of a model.

    Raises:
        InputError: there is no such model, or its config cannot be read.
    """
    try:
        return transformers.AutoConfig.from_pretrained(model)
    except Exception as error:  # Whatever another library raises on what it cannot read.
        raise InputError(model, f"cannot be loaded: {first_line(error)}") from None


def has_file(model: str, names: tuple[str, ...], transformers: Any) -> bool:
    """Return whether a model comes with one of some files."""
    for name in names:
        try:
            transformers.utils.cached_file(model, name)
        except (OSError, ValueError):
            continue
        return True
    return False


def preparation(model: str, transformers: Any) -> dict[str, Any]:
    """Return what a model states of its pictures.

    Raises:
        DamagedFileError: what it states makes no sense. InputError: there is no such model.
    """
    for file in READY_FILES:
        try:
            path = transformers.utils.cached_file(model, file)
        except (OSError, ValueError):
            continue
        try:
            stated = json.loads(Path(path).read_text(encoding="utf-8"))
            ready = stated.get("image_processor", stated)
            prepared(np.zeros((30, 40, 3), np.uint8), ready)
            return ready
        except (AttributeError, KeyError, TypeError, ValueError, ArithmeticError) as error:
            raise DamagedFileError(model, f"{file} makes no sense: {first_line(error)}") from None
    raise InputError(model, "no such model here or on the hub (it needs preprocessor_config.json)")


def network(model: str, kind: Any) -> Any:
    """Return a network, ready to run, in whole single precision.

    Args:
        model: a name or a folder.
        kind: the class of the library that loads it, such as ``AutoModelForDepthEstimation``.

    Raises:
        InputError: it cannot be had or is of another kind. DamagedFileError: weights are lacking.
    """
    try:
        found, told = kind.from_pretrained(
            model, dtype="float32", use_safetensors=True, output_loading_info=True
        )
    except Exception as error:  # Whatever another library raises on what it cannot read.
        raise InputError(model, f"cannot be loaded: {first_line(error)}") from None
    if told["missing_keys"] or told["mismatched_keys"]:
        lacking = sorted(map(str, told["missing_keys"] or told["mismatched_keys"]))[0]
        raise DamagedFileError(model, f"its weights lack {lacking}, and would be drawn by chance")
    return found.eval()
