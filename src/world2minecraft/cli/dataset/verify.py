"""Verify and repair all files of a data set: ``w2m dataset verify``."""

from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import typer

from world2minecraft.cli.dataset import options as option

EXAMPLES = """\
w2m dataset verify DATA             read all files and compare all checksums
w2m dataset verify DATA --repair    make damaged files again from the plan of the data set
w2m dataset verify DATA --json      print the result as JSON
"""
MAX_SHOWN = 20

Repair = Annotated[
    bool,
    typer.Option("--repair", help="Make damaged and missing files again from plan and seed."),
]


def run(
    folder: option.Folder,
    repair: Repair = False,
    jobs: option.Jobs = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Read a whole data set and list missing, changed and unexpected files.

    With --repair, files are replaced only by files with the same contents as before; those that
    remain are named with what to do. The exit code is 3 if there are faults, also with --json.

    Raises:
        InputError: If the folder is not a data set or the data set is incomplete.
        ConflictError: If another process writes the data set.
        DamagedFileError: If the data set has faults.
    """
    from world2minecraft.api import verify_dataset
    from world2minecraft.api.datasets import repair_dataset
    from world2minecraft.api.progress import show_progress

    with show_progress() as progress:
        made = repair_dataset(folder, jobs=jobs, progress=progress) if repair else None
        report = verify_dataset(folder, progress=progress)
    print_faults(folder, report, made, as_json, "w2m dataset verify")
    if as_json:
        return
    size = report.bytes / 1e6
    shards = f"{report.shards:,} shard{'s' * (report.shards != 1)}"
    print(f"{folder}: {report.samples:,} samples in {shards}, {size:,.0f} MB: ok")
    if not report.files:
        print("  note   of a former version: only shards are checked; --repair adds a list")
    print(f"  sum    {report.sha256}")
    print(f"  next   w2m dataset stats {folder}")


def print_faults(folder: Path, report: Any, made: Any, as_json: bool, command: str) -> None:
    """Print the faults of a folder and what a repair has done, or both as JSON.

    Args:
        folder: Folder that was verified.
        report: Result of the verification, with ``faults``.
        made: Result of the repair, with ``repaired`` and ``left``. None if nothing was repaired.
        as_json: Whether to print JSON.
        command: Command that repairs the folder.

    Raises:
        DamagedFileError: If there are faults.
    """
    from world2minecraft.cli.json_output import print_json
    from world2minecraft.core.errors import DamagedFileError

    if as_json:
        print_json({**asdict(report), **({} if made is None else asdict(made))})
    else:
        lines = [f"fault: {one}" for one in report.faults]
        if made is not None:
            lines = [f"repaired: {one}" for one in made.repaired]
            lines += [f"left: {one}" for one in made.left]
        for line in lines[:MAX_SHOWN]:
            print(line)
        if len(lines) > MAX_SHOWN:
            print(f"and {len(lines) - MAX_SHOWN:,} more; --json lists all")
    if report.faults:
        count = len(report.faults)
        text = f"has {count:,} fault{'s' * (count > 1)}"
        advice = (
            f"repair it with {command} {folder} --repair" if made is None else "see the lines above"
        )
        raise DamagedFileError(folder, f"{text}; {advice}")
