"""Export of samples to a folder, skipping samples that are already finished."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

from world2minecraft.core.errors import ConflictError, UnknownNameError, UsageError
from world2minecraft.core.files import read_json, write_json
from world2minecraft.core.output_folders import FolderKind
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.minecraftocc.exporters.options import FORMATS, Exporter, ExportRule
from world2minecraft.minecraftocc.types import OccSample

RECORD = "export.json"  # The options of the export, in the root of the folder.
EXPORT = FolderKind(
    {RECORD: "format"},
    (
        RECORD, "NYU*", "all", "base", "gathered_data", "index.json", "occscannet",
        "posed_images", "scene_occ", "test", "train", "val", "*.txt",
    ),
)  # fmt: skip
SOURCE = "sha256"  # Key of the checksum of the exported data set in this file.


@runtime_checkable
class KeyedSamples(Protocol):
    """Samples that can be read by key, so that an export need not read finished samples."""

    def keys(self, split: str | None = None) -> Iterable[str]:
        """Return the keys of a split, or of all splits by default."""
        ...

    def __getitem__(self, key: str) -> OccSample:
        """Read the sample with this key."""
        ...


@dataclass
class ExportReport:
    """The outcome of an export.

    Attributes:
        out: Output folder.
        written: Number of samples written by this run.
        passed_over: Number of samples that an earlier run had already finished.
        keys: Keys of all exported samples.
        notes: Descriptions of data that the format cannot represent unchanged.
    """

    out: Path
    written: int = 0
    passed_over: int = 0
    keys: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


def export_samples(
    samples: Iterable[OccSample] | KeyedSamples,
    format: str,
    out: str | Path,
    rule: ExportRule | None = None,
    *,
    split: str | None = None,
    limit: int | None = None,
    progress: Progress = no_progress,
) -> ExportReport:
    """Export samples to a folder in a published format.

    The folder must be new, or contain an unfinished export with the same options.

    Args:
        samples: A store, or any iterable of samples. The ``split`` of a sample determines its
            subfolder.
        format: ``nyu``, ``occscannet``, ``embodied`` or ``npz``.
        out: Output folder.
        rule: Options of the export.
        split: Export only this split (``train`` or ``test``). Defaults to all splits.
        limit: Maximum number of samples to export. Defaults to all samples.
        progress: Callback that reports progress on each sample.

    Raises:
        UnknownNameError: If the format is unknown.
        UsageError: If there are no samples to export, or if the format has no option ``axes``.
        ConflictError: If the folder contains an export with other options or of another data set.
        InputError: If the format cannot represent a sample.
    """
    root, chosen = Path(out), rule or ExportRule()
    exporter = _exporter(format, root, chosen)
    _claim(root, {"format": format, **chosen.as_data()}, str(getattr(samples, "sha256", "")))
    entries, total = _entries(samples, split)
    total = total if limit is None or not total else min(total, limit)
    report = ExportReport(root)
    try:
        for key, load in entries:
            if limit is not None and len(report.keys) >= limit:
                break
            if exporter.is_done(key):
                report.passed_over += 1
            else:
                exporter.write(load())
                report.written += 1
            report.keys.append(key)
            progress("export", len(report.keys), total, key)
    except BaseException:
        exporter.pause()
        raise
    if not report.keys:
        raise UsageError(f"no samples to export{f' in split {split}' if split else ''}")
    exporter.finish(report.keys)
    if not total:
        progress("export", len(report.keys), len(report.keys))
    report.notes = exporter.notes()
    return report


def _entries(
    samples: Iterable[OccSample] | KeyedSamples, split: str | None
) -> tuple[Iterator[tuple[str, Callable[[], OccSample]]], int]:
    """Return the keys with functions that read their samples, and their number (0 if unknown)."""
    if isinstance(samples, KeyedSamples):
        keys = list(samples.keys(split))
        store = samples
        return ((key, lambda key=key: store[key]) for key in keys), len(keys)
    chosen = (sample for sample in samples if split in (None, sample.split))
    total = len(samples) if split is None and hasattr(samples, "__len__") else 0  # type: ignore[arg-type]
    return ((sample.key, lambda sample=sample: sample) for sample in chosen), total


def _exporter(format: str, root: Path, rule: ExportRule) -> Exporter:
    """Create the exporter for a format, importing only its module."""
    if rule.axes != "published" and format in FORMATS and format != "occscannet":
        raise UsageError(f"axes {rule.axes} requires the format occscannet, got {format}")
    if format == "nyu":
        from world2minecraft.minecraftocc.exporters.nyu import NyuExporter  # noqa: PLC0415

        return NyuExporter(root, rule)
    if format == "occscannet":
        from world2minecraft.minecraftocc.exporters.occscannet import (  # noqa: PLC0415
            OccScanNetExporter,
        )

        return OccScanNetExporter(root, rule)
    if format == "embodied":
        from world2minecraft.minecraftocc.exporters.embodied import (  # noqa: PLC0415
            EmbodiedExporter,
        )

        return EmbodiedExporter(root, rule)
    if format == "npz":
        from world2minecraft.minecraftocc.exporters.npz import NpzExporter  # noqa: PLC0415

        return NpzExporter(root, rule)
    raise UnknownNameError("format", format, FORMATS)


def _claim(root: Path, choices: dict[str, Any], sha256: str) -> None:
    """Record the options of an export, or check that they match those of the existing export.

    Args:
        root: Output folder.
        choices: Format and options.
        sha256: SHA-256 of the data set, or an empty string if unknown. Samples of another data set
            may have the same keys and would be skipped as finished.
    """
    record = root / RECORD
    whole = {**choices, SOURCE: sha256} if sha256 else choices
    if not record.is_file():
        write_json(record, whole)
        return
    before = read_json(record)
    known = before if isinstance(before, dict) else {}
    names = [name for name in choices if name not in known or known[name] != choices[name]]
    names += [name for name in ("axes",) if name in known and name not in choices]
    if names:
        differences = ", ".join(f"{name} {known.get(name)!r}" for name in names)
        raise ConflictError(
            root,
            f"contains an export with {differences}; use the same options or another output folder",
        )
    if sha256 and known.get(SOURCE, sha256) != sha256:
        raise ConflictError(
            root,
            "contains an export of another data set or of an earlier build; choose another "
            "output folder",
        )  # fmt: skip
