"""Verify all files of a data set against its index: ``w2m dataset verify``."""

from dataclasses import asdict
from typing import Annotated

import typer

from world2minecraft.cli.dataset import options as option

EXAMPLES = """\
w2m dataset verify DATA             read all shards and compare all checksums
w2m dataset verify DATA --json      print the result as JSON
"""
MAX_SHOWN = 20


def run(
    folder: option.Folder,
    as_json: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Read a whole data set and list missing, damaged and unexpected contents.

    The exit code is 3 if there are faults, also with --json.

    Raises:
        InputError: If the folder is not a data set or the data set is incomplete.
        DamagedFileError: If the data set has faults.
    """
    from world2minecraft.api import verify_dataset
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.json_output import print_json
    from world2minecraft.core.errors import DamagedFileError

    with show_progress() as progress:
        report = verify_dataset(folder, progress=progress)
    if as_json:
        print_json(asdict(report))
    for fault in report.faults[:MAX_SHOWN] if not as_json else ():
        print(f"fault: {fault}")
    if report.faults:
        count = len(report.faults)
        raise DamagedFileError(
            folder,
            f"has {count:,} fault{'s' * (count > 1)}; delete the listed shards and repeat the "
            "w2m dataset build command",
        )
    if as_json:
        return
    size = report.bytes / 1e6
    print(f"{folder}: {report.samples:,} samples in {report.shards:,} shards, {size:,.0f} MB: ok")
    print(f"  sum    {report.sha256}")
    print(f"  next   w2m dataset stats {folder}")
