"""The stages and settings that ``--from STAGE`` keeps from an earlier run.

A setting read only by kept stages cannot change. If it is omitted, its earlier value is used and
written to the manifest; if a different value is given, the run is refused before any work.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, is_dataclass, replace
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import MALFORMED, DamagedFileError, InputError, UsageError
from world2minecraft.core.files import read_json
from world2minecraft.reconstruction.parameters import Parameters, first_reader

# The first stage that reads a file of which the manifest holds the hash.
FILES_READ_FIRST_BY = {
    "capture": "scan",
    "labels": "fuse",
    "plan": "fuse",
    "predictions": "fuse",
    "networks": "fuse",
}


@dataclass(frozen=True)
class Resumed:
    """The parameters and facts of an earlier run with which a run continues.

    Attributes:
        parameters: Requested parameters, with those of the kept stages unchanged.
        facts: Manifest entries of the kept stages: hashes of the files they read.
        changed: ``key=value`` of each kept parameter that is not the default.
    """

    parameters: Parameters
    facts: Mapping[str, Any] = field(default_factory=dict)
    changed: tuple[str, ...] = ()

    @property
    def notes(self) -> tuple[str, ...]:
        """A note to the user if kept parameters differ from those of a new run."""
        return (f"kept from the earlier run: {', '.join(self.changed)}",) if self.changed else ()


def resume_parameters(
    out: Path, start: str | None, stages: Sequence[str], requested: Parameters
) -> Resumed:
    """Return the parameters with which a run in ``out`` continues from a stage.

    Args:
        out: Folder of the run with its manifest; without a manifest all requested values are used.
        start: Stage to start at. None keeps no stage, a name outside ``stages`` keeps all.
        stages: All stages in order.
        requested: Parameters requested by the user.

    Raises:
        UsageError: If a requested setting differs from the one that kept stages were made with.
    """
    old = {} if start is None else _manifest(out)
    retained = stages[: stages.index(start)] if start in stages else stages
    default, chosen, changed = Parameters().as_json(), requested, []
    for key, was, now in _differing(old.get("parameters"), requested.as_json(), retained):
        if now != _at(default, key):
            raise UsageError(
                f"starting at {start} keeps results made with {key}={_shown(was)}, got "
                f"{_shown(now)}; "
                f"omit {key}, or start at {first_reader(key)} (--from)"
            )
        chosen = _with_value(chosen, key.split("."), was, out)
        changed.append(f"{key}={_shown(was)}")
    files = [name for name, by in FILES_READ_FIRST_BY.items() if by in retained and name in old]
    return Resumed(chosen, {name: old[name] for name in files}, tuple(changed))


def resume_manifest(
    out: Path, start: str | None, now: Mapping[str, Any], retained: Resumed
) -> dict:
    """Return a manifest with the file hashes of the kept stages.

    Raises:
        InputError: If the capture has changed.
        UsageError: If other labels are given.
    """
    if retained.facts.get("capture", now["capture"]) != now["capture"]:
        raise InputError(
            out,
            "was made from another capture, or the capture has changed since; omit the start "
            "stage (--from)",
        )
    if now["labels"] is not None and retained.facts.get("labels", now["labels"]) != now["labels"]:
        raise UsageError(
            f"starting at {start} keeps results made without these labels; start at fuse (--from "
            "fuse)"
        )
    return {**now, **retained.facts}


def _manifest(out: Path) -> Mapping[str, Any]:
    """Return the manifest of an earlier run, or an empty mapping if it cannot be read."""
    path = out / "manifest.json"
    try:
        stated = read_json(path) if path.is_file() else None
    except DamagedFileError:
        return {}
    return stated if isinstance(stated, dict) else {}


def _differing(
    stated: Any, requested: Mapping[str, Any], retained: Sequence[str]
) -> Iterator[tuple[str, Any, Any]]:
    """Yield the key, the earlier and the current value of settings of kept stages that differ."""
    for key, was in _flat(stated if isinstance(stated, dict) else {}):
        now = _at(requested, key)
        if first_reader(key) in retained and now is not ... and now != was:
            yield key, was, now


def _flat(stated: Mapping[str, Any], prefix: str = "") -> list[tuple[str, Any]]:
    """Return the leaves of nested parameters by dotted key; capture options are one leaf."""
    leaves: list[tuple[str, Any]] = []
    for name, value in stated.items():
        is_group = isinstance(value, dict) and name != "capture"
        leaves += _flat(value, f"{prefix}{name}.") if is_group else [(prefix + name, value)]
    return leaves


def _at(stated: Mapping[str, Any], key: str) -> Any:
    """Return the leaf at a dotted key, or ``...`` if it does not exist."""
    value: Any = stated
    for name in key.split("."):
        if not isinstance(value, Mapping) or name not in value:
            return ...
        value = value[name]
    return value


def _with_value(value: Any, path: Sequence[str], was: Any, out: Path) -> Any:
    """Return parameters with one leaf replaced by its value in a manifest."""
    inner = getattr(value, path[0])
    if is_dataclass(inner):
        return replace(value, **{path[0]: _with_value(inner, path[1:], was, out)})
    try:
        return replace(value, **{path[0]: tuple(was) if isinstance(was, list) else was})
    except (*MALFORMED, UsageError) as error:
        raise DamagedFileError(
            out / "manifest.json", f"contains an invalid value for {path[0]}: {was!r}"
        ) from error


def _shown(value: Any) -> str:
    """Format a value as a setting; empty values are shown as ``none``."""
    return str(value) if value not in (None, "", [], {}) else "none"
