"""Export of a set into a folder for a trainer or simulator."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from world2minecraft import __version__
from world2minecraft.core.errors import ConflictError, UnknownNameError, UsageError
from world2minecraft.core.files import read_json, write_json, write_text
from world2minecraft.core.output_folders import others_in
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.whole_reads import read_whole
from world2minecraft.navigation.exporters import easyr1, llamafactory
from world2minecraft.navigation.exporters.options import ExportedFile, ExportOptions, group_items
from world2minecraft.navigation.exporters.pictures import SetPictures
from world2minecraft.navigation.exporters.r2r import write_r2r
from world2minecraft.navigation.exporters.recipes import render_recipe
from world2minecraft.navigation.exporters.trl import write_trl
from world2minecraft.navigation.exporters.vlnce import write_vlnce
from world2minecraft.navigation.records import read_episodes, read_items, read_trajectories

# The functions that measure and write the rows of a format.
TRAINERS = {
    "llamafactory": (llamafactory.max_row_tokens, llamafactory.write_llamafactory),
    "easyr1": (easyr1.max_prompt_tokens, easyr1.write_easyr1),
    "trl": (llamafactory.max_row_tokens, write_trl),
}
FORMATS = (*TRAINERS, "vlnce", "r2r")
RECORD = "handoff.json"  # The options of the export, in the root of the folder.
TITLES = {
    "llamafactory": "MinecraftVLN for LLaMA-Factory",
    "easyr1": "MinecraftVLN for EasyR1",
    "trl": "MinecraftVLN for TRL",
    "vlnce": "MinecraftVLN as VLN-CE episodes",
    "r2r": "MinecraftVLN as R2R paths",
}


@dataclass(frozen=True)
class ExportResult:
    """The files written by an export."""

    out: Path
    format: str
    written: list[ExportedFile] = field(default_factory=list)

    @property
    def notes(self) -> list[str]:
        """The notes of all files."""
        return [note for one in self.written for note in one.notes]


def export_set(
    folder: str | Path,
    format: str,
    out: str | Path,
    rule: ExportOptions | None = None,
    *,
    progress: Progress = no_progress,
) -> ExportResult:
    """Export a set in one of ``FORMATS``. The same set and options give identical files.

    The whole set is read and checked before the first file is written.

    Args:
        folder: The folder of the set with ``items.jsonl`` and ``images/``, and ``episodes.jsonl``
            for vlnce or ``trajectories.jsonl`` for r2r.
        format: "llamafactory", "easyr1", "trl", "vlnce" or "r2r".
        out: The output folder, which must be new, empty, or an export with the same options.
        rule: The options. None uses the defaults.
        progress: Called after each part of the work.

    Raises:
        UnknownNameError: If the format is unknown.
        ConflictError: If the folder contains other files.
        UsageError: If there is nothing to export, or a row exceeds the limits of the recipe.
        InputError: If the set cannot be read.
        OutputError: If the folder cannot be written.
    """
    source, root, chosen = Path(folder), Path(out), rule or ExportOptions()
    if format not in FORMATS:
        raise UnknownNameError("format", format, FORMATS)
    choices = {"format": format, **chosen.as_data()}
    _check_folder(root, choices)
    progress("export", 0, 2, "reading")
    write = read_whole(source, lambda: _plan_export(source, format, chosen))
    progress("export", 1, 2, "writing")
    write_json(root / RECORD, {"choices": choices, "version": __version__})
    written = write(root)
    write_text(root / "README.md", _readme(format, written))
    progress("export", 2, 2)
    return ExportResult(root, format, written)


def _plan_export(
    source: Path, format: str, rule: ExportOptions
) -> Callable[[Path], list[ExportedFile]]:
    """Read and check a set, and return the function that writes it to a folder."""
    if format in TRAINERS:
        most_tokens, write = TRAINERS[format]
        parts, pictures = group_items(read_items(source), rule), SetPictures(source)
        tokens = [most_tokens(part, pictures, rule) for part in parts]
        return lambda root: write(root, parts, pictures, rule, tokens)
    if format == "vlnce":
        episodes = read_episodes(source)
        scales = {item.scene_id: item.metres_per_block for item in read_items(source)}
        if episodes:
            return lambda root: write_vlnce(root, episodes, source, scales)
    walks = read_trajectories(source) if format == "r2r" else []
    if any(one.instructions for one in walks):
        return lambda root: write_r2r(root, walks)
    missing = "any episodes" if format == "vlnce" else "any walks with instructions"
    raise UsageError(
        f"{source} does not contain {missing}, which the format {format} requires; build "
        "it with w2m vln build"
    )


def _check_folder(root: Path, choices: dict[str, Any]) -> None:
    """Check that a folder is empty or contains an export with the same options."""
    record = root / RECORD
    if record.is_file():
        data = read_json(record)
        existing = data.get("choices") if isinstance(data, dict) else None
        if existing != choices:
            existing = existing if isinstance(existing, dict) else {}
            other = [
                f"{k} {existing.get(k)!r}, not {v!r}"
                for k, v in choices.items()
                if existing.get(k) != v
            ]
            raise ConflictError(
                root,
                f"the folder contains an export with other options ({', '.join(other)}); "
                "choose another folder",
            )
    elif others_in(root):
        raise ConflictError(
            root, "the folder is not empty and does not contain an export; choose another folder"
        )


def _readme(format: str, written: list[ExportedFile]) -> str:
    lines = ["| file | rows | steps | longest row, tokens | command |", "|---|---|---|---|---|"]
    for one in written:
        command = f"`{one.command}`" if one.command else ""
        steps, tokens = (f"{n:,}" if n else "" for n in (one.steps, one.tokens))
        lines.append(f"| {one.name} | {one.rows:,} | {steps} | {tokens} | {command} |")
    return render_recipe(
        "readme.md",
        title=TITLES[format],
        table="\n".join(lines),
        notes=[note for one in written for note in one.notes],
        more=_MORE[format],
    )


_MORE = {
    "llamafactory": (
        "Rows are shuffled, because `max_samples` selects the first rows of a file. Each "
        "`<image>` is the placeholder of one image. To train on several sets at once, use "
        "a `combined` file, because a list of names would use `max_samples` rows of each "
        "set."
    ),
    "easyr1": (
        "Run EasyR1 from this folder, because paths in the recipe are relative to it. The "
        "reward is 90 percent for the correct letter and 10 percent for the format that "
        "`mc.jinja` requests."
    ),
    "trl": (
        "`sft.py` and `grpo.py` are complete scripts that you can read and modify. Use "
        "`--cpu --max-steps 3` to try them without a GPU."
    ),
    "vlnce": (
        "Stages are at `SCENE/stages/SCENE.glb`. Write them with `w2m convert SCENE_PATH "
        "SCENE.habitat`, which uses the same coordinates in metres. `names.json` maps "
        "numbers to episodes. `geodesic_distance` is the length of the expert path."
    ),
    "r2r": (
        "`viewpoints.json` contains the position and images of each viewpoint, and "
        "`connectivity/` the graph of each scene."
    ),
}
