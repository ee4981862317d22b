"""All parameters of a reconstruction in one frozen dataclass, changed by ``--set key=value``.

The parameters and defaults of each stage are defined by that stage.
"""

import json
import math
from dataclasses import asdict, dataclass, fields, is_dataclass, replace
from typing import Any

from world2minecraft.capture.sfm import SfmParameters
from world2minecraft.capture.stereo import StereoParameters
from world2minecraft.construction import BuildParameters
from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.core.parameters import parameter
from world2minecraft.formats.volume_formats import format_by_name
from world2minecraft.minecraft.versions import game_version
from world2minecraft.reconstruction.fusion import CleaningParameters, FusionParameters
from world2minecraft.reconstruction.instances import InstanceParameters
from world2minecraft.reconstruction.occupancy import (
    PREDICTORS,
    OccupancyParameters,
    PredictionParameters,
)
from world2minecraft.reconstruction.registration import RegistrationParameters
from world2minecraft.reconstruction.repair import RepairParameters
from world2minecraft.reconstruction.retrieval import RetrievalParameters
from world2minecraft.reconstruction.semantics import LABELLERS


@dataclass(frozen=True)
class Parameters:
    """All inputs, besides the capture, that determine the result of a reconstruction.

    voxel_m: Cell size of all stages.
    blocks_per_metre: Scale of the world.
    predictor: Source of the occupancy evidence: ``depth``, or ``mono:FILE.onnx`` for a monocular
        network.
    depth_model: Network that estimates depth where stereo finds none, such as ``hf:ORG/NAME``.
    plan: Path of a RoomPlan file of the same room, used as additional evidence.
    labeller: Method that assigns classes to cells. ``auto`` uses ``completion`` for measured depth
        and the cell size its network was trained with, otherwise ``votes`` if there are votes, and
        ``geometric`` if not.
    mc_version: Minecraft version of the world.
    mend: Whether to correct typical flaws of the finished build; ``w2m clean OUT --list`` lists the
        corrections.
    formats: Additional formats of the build, separated by commas, such as ``litematic,nbt,glb``.
    known: Name and length in metres of a known object, such as ``("table height", 0.72)``, which
        sets the scale.
    known_points: Two points in photos, each as ``PHOTO:x,y``, and their distance in metres, which
        sets the scale.
    """

    voxel_m: float = parameter(0.08, unit="m", origin="the paper's cell size", stage="scan")
    blocks_per_metre: float = parameter(
        4.0,
        unit="blocks per metre",
        origin="rooms are recognizable at first sight, unlike at 2",
        stage="build",
    )
    predictor: str = parameter("depth", stage="fuse")
    depth_model: str = parameter("", stage="scan")
    plan: str = parameter("", stage="fuse")
    labeller: str = parameter("auto", stage="label")
    mc_version: str = parameter("1.20.1", origin="newer versions upgrade its worlds", stage="build")
    mend: bool = parameter(True, stage="build")
    formats: str = parameter("", stage="build")
    known: tuple[str, float] | None = parameter(
        None, unit="m", stage="scan", typed='--known "table height" 0.72'
    )
    known_points: tuple[str, str, float] | None = parameter(
        None, unit="m", stage="scan", typed="--known-points A:x,y B:x,y METRES"
    )
    capture: dict[str, str] = parameter(dict, stage="scan", typed="--set capture.KEY=VALUE")
    posing: SfmParameters = parameter(SfmParameters, stage="scan")
    stereo: StereoParameters = parameter(StereoParameters, stage="scan")
    register: RegistrationParameters = parameter(RegistrationParameters, stage="register")
    occupy: OccupancyParameters = parameter(OccupancyParameters, stage="fuse")
    predictions: PredictionParameters = parameter(PredictionParameters, stage="fuse")
    fuse: FusionParameters = parameter(FusionParameters, stage="fuse")
    clean: CleaningParameters = parameter(CleaningParameters, stage="label")
    find: InstanceParameters = parameter(InstanceParameters, stage="find")
    furnish: RetrievalParameters = parameter(RetrievalParameters, stage="furnish")
    repair: RepairParameters = parameter(RepairParameters, stage="furnish")
    build: BuildParameters = parameter(BuildParameters, stage="build")

    def __post_init__(self):
        if not 0.01 <= self.voxel_m <= 0.5:
            raise UsageError(f"voxel_m must be 0.01 to 0.5 m, got {self.voxel_m}")
        if not 0.25 <= self.blocks_per_metre <= 100:
            raise UsageError(
                f"blocks_per_metre must be 0.25 to 100, got {self.blocks_per_metre}; "
                "common values are 1, 2, 4 and 12.5"
            )
        check_name("predictor", self.predictor.partition(":")[0], PREDICTORS.names())
        check_name("labeller", self.labeller, ("auto", *LABELLERS.names()))
        game_version(self.mc_version)
        for name in self.format_names:
            format_by_name(name)
        if self.fuse.voxel_m != self.voxel_m:
            object.__setattr__(self, "fuse", replace(self.fuse, voxel_m=self.voxel_m))

    @property
    def format_names(self) -> tuple[str, ...]:
        """The additional formats that are written besides the world."""
        return tuple(name.strip() for name in self.formats.split(",") if name.strip())

    def as_json(self) -> dict[str, Any]:
        """Return the parameters as JSON values, with lists instead of tuples."""
        return json.loads(json.dumps(asdict(self)))


def check_name(kind: str, name: str, known: tuple[str, ...]) -> None:
    """Raise UnknownNameError if ``name`` is not one of ``known``."""
    if name not in known:
        raise UnknownNameError(kind, name, known)


METHODS = ("best", "paper")
TYPES_IN_WORDS = {bool: "yes or no", int: "a whole number", float: "a number"}


def with_method(parameters: Parameters, method: str) -> Parameters:
    """Return the parameters with the settings of one of ``METHODS``.

    ``best`` does not change the parameters. ``paper`` follows the paper exactly: no refinement of
    poses and depth, no votes of a segmentation network, each DBSCAN cluster is an object, templates
    are matched by IoU over all cells and rotations and not exchanged, and the build is not
    corrected. Values that the paper does not state (k, tau, eta, fusion, labels) are the same in
    both.

    Raises:
        UnknownNameError: If the method does not exist.
    """
    check_name("method", method, METHODS)
    if method == "best":
        return parameters
    return replace(
        parameters,
        register=replace(parameters.register, passes=0),
        occupy=replace(parameters.occupy, semantics="none"),
        find=replace(parameters.find, paper_compat=True),
        furnish=replace(parameters.furnish, paper_compat=True),
        repair=replace(parameters.repair, enabled=False),
        build=replace(parameters.build, paper_compat=True),
        mend=False,
    )


def with_settings(parameters: Parameters, settings: list[str]) -> Parameters:
    """Return the parameters with ``key=value`` settings applied, such as ``find.cluster_radius=3``.

    Keys that begin with ``capture.`` are passed to the reader of the capture.

    Raises:
        UsageError: If a setting is not ``key=value`` or its value has the wrong type.
        UnknownNameError: If the key is unknown; the message suggests the closest match.
    """
    for setting in settings:
        key, equals, text = setting.partition("=")
        if not equals:
            raise UsageError(
                f"--set must be KEY=VALUE, such as find.cluster_radius=3, got {setting!r}"
            )
        parameters = _with_one(parameters, key.strip().split("."), text.strip(), key.strip())
    return parameters


def parameter_keys(value: Any = None, prefix: str = "") -> list[str]:
    """Return all keys that ``--set`` accepts."""
    value = Parameters() if value is None else value
    keys = []
    for entry in fields(value):
        inner = getattr(value, entry.name)
        if is_dataclass(inner):
            keys += parameter_keys(inner, f"{prefix}{entry.name}.")
        elif not isinstance(inner, dict | tuple) and "typed" not in entry.metadata:
            keys.append(prefix + entry.name)
    return keys


def first_reader(key: str) -> str:
    """Return the first stage that reads a parameter, given its dotted key or its group.

    The result is empty for unknown keys, and for parameters that only copy another.
    """
    group, _, name = key.partition(".")
    declared = {entry.name: entry for entry in fields(Parameters)}
    if group not in declared:
        return ""
    inner = getattr(Parameters(), group)
    copied = is_dataclass(inner) and any(
        entry.name == name and "copy_of" in entry.metadata for entry in fields(inner)
    )
    return "" if copied else declared[group].metadata["stage"]


def _with_one(value: Any, path: list[str], text: str, key: str) -> Any:
    name = path[0]
    if name == "capture" and len(path) == 2:
        return replace(value, capture={**value.capture, path[1]: text})
    declared = {entry.name: entry for entry in fields(value)}
    if len(path) == 1 and name in declared and "typed" in declared[name].metadata:
        raise UsageError(f"--set cannot change {key}; use {declared[name].metadata['typed']}")
    if name not in declared:
        raise UnknownNameError("parameter", key, parameter_keys())
    inner = getattr(value, name)
    if is_dataclass(inner) != (len(path) > 1):
        raise UnknownNameError("parameter", key, parameter_keys())
    changed = _with_one(inner, path[1:], text, key) if len(path) > 1 else _parse(inner, text, key)
    try:
        return replace(value, **{name: changed})
    except ValueError as error:
        raise UsageError(f"--set {key}: {error}") from error


def _parse(example: Any, text: str, key: str) -> Any:
    """Return ``text`` as a value of the type of ``example``."""
    try:
        if isinstance(example, bool):
            return {"true": True, "yes": True, "1": True, "false": False, "no": False, "0": False}[
                text.lower()
            ]
        if isinstance(example, int | float):
            return _finite(type(example)(text))
    except (ValueError, KeyError, OverflowError):
        words = TYPES_IN_WORDS[type(example)]
        raise UsageError(f"--set {key} must be {words} such as {example}, got {text!r}") from None
    if isinstance(example, str) or example is None:
        return text
    raise UsageError(f"--set cannot change {key}, since it has several values")


def _finite(value: float) -> float:
    """Return a number. Raises ValueError if it is NaN or infinite."""
    if not math.isfinite(value):
        raise ValueError
    return value
