"""Every parameter of a reconstruction, in one frozen value; ``--set key=value`` changes any.

Each stage owns its own parameters and their defaults; here they are only joined.
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
from world2minecraft.reconstruction.occupancy import PREDICTORS, OccupancyParameters
from world2minecraft.reconstruction.registration import RegistrationParameters
from world2minecraft.reconstruction.retrieval import RetrievalParameters
from world2minecraft.reconstruction.semantics import LABELLERS


@dataclass(frozen=True)
class Parameters:
    """What decides a result, beside the capture.

    voxel_m: the cell of all stages.
    blocks_per_metre: the scale of the world.
    predictor: ``depth``, or ``mono:FILE.onnx``.
    depth_model: a network whose depth fills what stereo leaves open, such as ``hf:ORG/NAME``.
    plan: the path of a RoomPlan of the same room, as more evidence.
    labeller: ``auto`` takes ``completion`` where depth was measured and cells are of the size that
        its network learnt; else ``votes`` where anything voted, or ``geometric``.
    mc_version: the version of Minecraft that the world is written for.
    mend: clean up what is built as a person would; ``w2m clean OUT --list`` tells what that was.
    formats: further forms of the build, such as ``litematic,nbt,glb``.
    known: a length by its name, such as ``("table height", 0.72)``.
    known_points: two places in photos, each ``PHOTO:x,y``, and the metres between
        them; both give a capture its scale.
    """

    voxel_m: float = parameter(0.08, unit="m", origin="the paper's cell", stage="scan")
    blocks_per_metre: float = parameter(
        4.0,
        unit="blocks per metre",
        origin="a room is recognised at once; at 2 it is not",
        stage="build",
    )
    predictor: str = parameter("depth", stage="fuse")
    depth_model: str = parameter("", stage="scan")
    plan: str = parameter("", stage="fuse")
    labeller: str = parameter("auto", stage="label")
    mc_version: str = parameter("1.20.1", origin="newer games upgrade its worlds", stage="build")
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
    fuse: FusionParameters = parameter(FusionParameters, stage="fuse")
    clean: CleaningParameters = parameter(CleaningParameters, stage="label")
    find: InstanceParameters = parameter(InstanceParameters, stage="find")
    furnish: RetrievalParameters = parameter(RetrievalParameters, stage="furnish")
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
        """The forms that are written beside the world."""
        return tuple(name.strip() for name in self.formats.split(",") if name.strip())

    def as_json(self) -> dict[str, Any]:
        """Return the parameters as JSON holds them: tuples are lists there."""
        return json.loads(json.dumps(asdict(self)))


def check_name(kind: str, name: str, known: tuple[str, ...]) -> None:
    """Raise UnknownNameError where ``name`` is none of ``known``."""
    if name not in known:
        raise UnknownNameError(kind, name, known)


METHODS = ("best", "paper")
TYPES_IN_WORDS = {bool: "yes or no", int: "a whole number", float: "a number"}


def with_method(parameters: Parameters, method: str) -> Parameters:
    """Return the parameters with one of ``METHODS`` chosen: where the two differ, as docs say.

    ``best`` leaves them as they are. ``paper`` stops where the paper stops: no refinement of poses
    and depth, each cluster of DBSCAN an object, templates by IoU over all cells and turns, nothing
    mended. What the paper leaves open (k, tau, eta, fusion, labels) is the same in both.

    Raises:
        UnknownNameError: there is no such method.
    """
    check_name("method", method, METHODS)
    if method == "best":
        return parameters
    return replace(
        parameters,
        register=replace(parameters.register, passes=0),
        find=replace(parameters.find, paper_compat=True),
        furnish=replace(parameters.furnish, paper_compat=True),
        mend=False,
    )


def with_settings(parameters: Parameters, settings: list[str]) -> Parameters:
    """Return the parameters with ``key=value`` settings applied, such as ``find.cluster_radius=3``.

    Keys that begin with ``capture.`` are handed to the capture's reader.

    Raises:
        UsageError: a setting is no ``key=value`` or its value has the wrong type.
        UnknownNameError: no parameter has this key; the message suggests the nearest.
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
    """Return all keys that ``--set`` knows."""
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
    """Return the first stage that reads the parameter of a dotted key, or its group.

    Nothing for one that does not exist, and for the copy of another.
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
    """Return a number. Raises ValueError where it is none, or has no end."""
    if not math.isfinite(value):
        raise ValueError
    return value
