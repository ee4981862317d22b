"""The settings of a training run, and their YAML file.

The same file always trains the same network. Settings that are omitted have their default values.
Unknown settings are rejected, with the most similar name as a suggestion.
"""

import math
from contextlib import suppress
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from typing import Any, NamedTuple

import yaml

from world2minecraft.core.errors import DamagedFileError, UnknownNameError, UsageError
from world2minecraft.core.files import load_plain_yaml, read_bytes, write_text

MAX_BYTES = 1 << 20


class Grid(NamedTuple):
    """The grid of cells that a network labels, with x right, y forward and z up.

    All grids cover 4.8 x 4.8 x 2.88 m.
    """

    shape: tuple[int, int, int]
    voxel_m: float


GRIDS = {"0.16": Grid((30, 30, 18), 0.16), "0.08": Grid((60, 60, 36), 0.08)}
SCHEDULES = ("cosine", "step", "constant")
PRECISIONS = ("auto", "bf16", "32")
DEPTHS = ("taught", "given", "none")
DEFAULT_FRAMES = {"embodied": 3}  # An estimate; 1 for all other networks.
CLASS_WEIGHTS = ("frequency", "monoscene", "even")


@dataclass(frozen=True)
class DataSource:
    """A data set, with its relative weight among the training data.

    Attributes:
        path: Folder of the data set.
        weight: Relative probability of choosing a frame of this data set.

    Example:
        >>> DataSource.parse("sets/NYU:2.5")
        DataSource(path='sets/NYU', weight=2.5)
    """

    path: str
    weight: float = 1.0

    def __post_init__(self):
        if not self.path:
            raise UsageError("the path of a data set is empty; expected DIR or DIR:WEIGHT (--data)")
        if not 0 < self.weight < math.inf:
            raise UsageError(
                f"the weight of {self.path} must be above 0 and finite, got {self.weight:g}"
            )

    @classmethod
    def parse(cls, text: str) -> "DataSource":
        """Parse ``DIR`` or ``DIR:WEIGHT``.

        A colon that is not followed by a number belongs to the path.
        """
        path, colon, tail = text.rpartition(":")
        try:
            return cls(path, float(tail)) if colon else cls(text)
        except ValueError:
            return cls(text)


@dataclass(frozen=True)
class RunConfig:
    """The settings of a training run.

    Attributes:
        network: Name of the network.
        data: Data sets with their weights.
        size: Size of the network: ``tiny``, ``small`` or ``full``.
        backbone: Image backbone from transformers as ``hf:ID``. An empty string selects the
            network's own.
        grid: Cell size, ``0.16`` or ``0.08`` metres.
        image: Image width and height in pixels.
        depth: Use of depth: ``taught`` (target of a depth branch), ``given`` (also an input) or
            ``none``.
        frames: Maximum number of frames of a scene in a sample. 0 uses the network's default.
        steps: Number of training steps.
        batch: Number of samples in a batch.
        learning_rate: Maximum learning rate.
        weight_decay: Weight decay.
        schedule: Learning rate schedule: ``cosine``, ``step`` or ``constant``.
        warmup_steps: Number of warm-up steps.
        clip_norm: Maximum norm of the gradients. 0 disables clipping.
        precision: ``auto``, ``bf16`` or ``32``.
        flip: Fraction of mirrored frames.
        jitter: Strength of random colour changes from 0 to 1.
        class_weights: Class weights of the loss: ``frequency``, ``monoscene`` or ``even``.
        val_share: Fraction of the training scenes used for validation. 0 validates on the test
            split.
        validate_every: Number of steps between two validations.
        validate_frames: Maximum number of frames for a validation, evenly spaced.
        patience: Number of validations without improvement before the run stops. 0 never stops
            early.
        checkpoint_every: Number of steps between two checkpoints.
        seed: Random seed.
        threads: Number of CPU threads. 0 uses all.
        workers: Number of processes that prepare batches.
    """

    network: str
    data: tuple[DataSource, ...]
    size: str = "small"
    backbone: str = ""
    grid: str = "0.16"
    image: tuple[int, int] = (320, 240)
    depth: str = "taught"
    frames: int = 0
    steps: int = 2000
    batch: int = 4
    learning_rate: float = 5e-4
    weight_decay: float = 1e-4
    schedule: str = "cosine"
    warmup_steps: int = 100
    clip_norm: float = 1.0
    precision: str = "auto"
    flip: float = 0.5
    jitter: float = 0.4
    class_weights: str = "frequency"
    val_share: float = 0.1
    validate_every: int = 200
    validate_frames: int = 100
    patience: int = 0
    checkpoint_every: int = 100
    seed: int = 0
    threads: int = 0
    workers: int = 0

    def __post_init__(self):
        put = object.__setattr__
        put(self, "data", tuple(self.data))
        put(self, "image", tuple(int(side) for side in self.image))
        _one_of("grid", self.grid, GRIDS)
        _one_of("depth", self.depth, DEPTHS)
        _one_of("schedule", self.schedule, SCHEDULES)
        _one_of("precision", self.precision, PRECISIONS)
        _one_of("class_weights", self.class_weights, CLASS_WEIGHTS)
        if not self.data:
            raise UsageError("no training data; add a data set from w2m dataset build (--data DIR)")
        if len(self.image) != 2:
            raise UsageError(f"image must be a width and a height, got {self.image}")
        for name, (low, high) in _RANGES.items():
            values = getattr(self, name)
            for value in values if isinstance(values, tuple) else (values,):
                if not low <= value <= high:
                    raise UsageError(f"{name} must be from {low:g} to {high:g}, got {value:g}")

    @property
    def cells(self) -> Grid:
        """Grid with the cell size ``grid``."""
        return GRIDS[self.grid]

    @property
    def fused(self) -> int:
        """Maximum number of frames of a scene in a sample."""
        return self.frames or DEFAULT_FRAMES.get(self.network, 1)

    def with_preset(self, name: str) -> "RunConfig":
        """Return the settings with those of a preset applied.

        Raises:
            UnknownNameError: If there is no such preset.
        """
        _one_of("preset", name, PRESETS)
        return replace(self, **PRESETS[name])


_RANGES: dict[str, tuple[float, float]] = {
    "image": (16, 4096),
    "frames": (0, 16),
    "steps": (1, 10**8),
    "batch": (1, 4096),
    "learning_rate": (1e-9, 10),
    "weight_decay": (0, 10),
    "warmup_steps": (0, 10**8),
    "clip_norm": (0, 1e6),
    "flip": (0, 1),
    "jitter": (0, 1),
    "val_share": (0, 0.9),
    "validate_every": (1, 10**8),
    "validate_frames": (1, 10**7),
    "patience": (0, 10**6),
    "checkpoint_every": (1, 10**8),
    "seed": (0, 2**31 - 1),
    "threads": (0, 1024),
    "workers": (0, 256),
}
PRESETS: dict[str, dict[str, Any]] = {
    "smoke": {
        "size": "tiny", "image": (96, 72), "steps": 20, "batch": 2, "warmup_steps": 2,
        "validate_every": 10, "validate_frames": 8, "checkpoint_every": 10,
    },
    "quick": {
        "size": "small", "grid": "0.16", "image": (160, 120), "steps": 800, "batch": 4,
        "warmup_steps": 40,
    },
    "1k": {"size": "small", "grid": "0.16", "image": (320, 240), "steps": 2000, "batch": 4},
    "8k": {  # MonoScene's recipe on NYUv2's grid: 30 epochs of the paper's 6,100 frames.
        "size": "full", "grid": "0.08", "image": (640, 480), "steps": 45_750, "batch": 4,
        "learning_rate": 1e-4, "schedule": "step", "warmup_steps": 0, "class_weights": "monoscene",
        "validate_every": 1525, "validate_frames": 500, "checkpoint_every": 500,
    },
}  # fmt: skip


def config_text(config: RunConfig) -> str:
    """Format the settings as YAML, in their declared order."""
    plain = asdict(config)
    plain["data"] = [asdict(one) for one in config.data]
    plain["image"] = list(config.image)
    return yaml.safe_dump(plain, sort_keys=False)


def write_config(path: str | Path, config: RunConfig) -> None:
    """Write the settings to a YAML file.

    Raises:
        OutputError: If the file cannot be written.
    """
    write_text(path, config_text(config))


def read_config(path: str | Path) -> RunConfig:
    """Read settings from a YAML file.

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If the file is not YAML with settings.
        UnknownNameError: If a setting is unknown.
        UsageError: If a value is out of range.
    """
    return parse_config(read_bytes(path, MAX_BYTES).decode("utf-8", "replace"), str(path))


def parse_config(text: str, source: str) -> RunConfig:
    """Parse settings from YAML text.

    Args:
        text: YAML text.
        source: Name for error messages.

    Raises:
        DamagedFileError: If the text is not YAML with settings.
        UnknownNameError: If a setting is unknown.
        UsageError: If a value is out of range.
    """
    try:
        plain = load_plain_yaml(text)
    except ValueError as error:
        raise DamagedFileError(source, f"not valid YAML ({error})") from error
    if not isinstance(plain, dict):
        raise DamagedFileError(source, "contains no settings; expected network: NAME, data: ...")
    known = {entry.name: entry for entry in fields(RunConfig)}
    for name in plain:
        if name not in known:
            raise UnknownNameError("setting", str(name), known)
    if missing := [name for name in ("network", "data") if name not in plain]:
        raise DamagedFileError(source, f"missing settings: {', '.join(missing)}")
    return RunConfig(**{name: _value(source, name, plain[name]) for name in plain})


def _value(source: str, name: str, value: Any) -> Any:
    """Convert a YAML value to the type of a setting.

    Raises:
        DamagedFileError: If the value has another type.
    """
    if name == "data":
        return tuple(
            _source(source, one) for one in (value if isinstance(value, list) else [value])
        )
    if name == "image":
        if isinstance(value, list) and all(type(side) is int for side in value):
            return tuple(value)
        raise DamagedFileError(source, f"image must be [width, height], got {value!r}")
    wanted = _TYPES[name]
    if wanted is str and type(value) in (int, float):
        value = str(value)  # YAML parses 0.16 and 32 as numbers.
    if wanted is float and type(value) is int:
        value = float(value)
    if wanted is float and isinstance(value, str):  # YAML parses 1e-4 as a string.
        with suppress(ValueError):
            value = float(value)
    if type(value) is not wanted:
        raise DamagedFileError(source, f"{name} must be {_WORDS[wanted]}, got {value!r}")
    return value


def _source(source: str, value: Any) -> DataSource:
    if isinstance(value, str):
        return DataSource.parse(value)
    if not isinstance(value, dict) or not isinstance(value.get("path"), str):
        raise DamagedFileError(
            source, f"data must be a list of paths, or of path and weight, got {value!r}"
        )
    for name in value:
        if name not in ("path", "weight"):
            raise UnknownNameError("data setting", str(name), ("path", "weight"))
    weight = value.get("weight", 1.0)
    if type(weight) not in (int, float):
        raise DamagedFileError(source, f"weight must be a number, got {weight!r}")
    return DataSource(value["path"], float(weight))


def _one_of(kind: str, name: str, known: Any) -> None:
    if name not in known:
        raise UnknownNameError(kind, str(name), known)


_WORDS = {str: "a string", int: "an integer", float: "a number"}
_TYPES: dict[str, type] = {
    entry.name: {"str": str, "int": int, "float": float}.get(str(entry.type), entry.type)
    for entry in fields(RunConfig)
    if entry.name not in ("data", "image")
}  # type: ignore[assignment]
