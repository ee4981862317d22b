"""Verify and repair all files of a navigation set: ``w2m vln verify``."""

from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.cli.dataset.verify import Repair, print_faults
from world2minecraft.cli.vln.build import Workers

EXAMPLES = """\
w2m vln verify SET             read all files and compare all checksums
w2m vln verify SET --repair    make damaged files again from the options of the set
w2m vln verify SET --json      print the result as JSON
"""

Folder = Annotated[Path, typer.Argument(metavar="SET", help="Navigation set from w2m vln build.")]


def run(
    folder: Folder,
    repair: Repair = False,
    workers: Workers = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Read a whole navigation set and list missing, changed and unexpected files.

    With --repair, images are rendered again, and scenes and records built again; files are replaced
    only by files with the same contents as before, and the others are named with what to do. The
    exit code is 3 if there are faults, also with --json.

    Raises:
        InputError: If the folder is not a navigation set.
        ConflictError: If another process writes the set.
        DamagedFileError: If the set has faults.
    """
    from world2minecraft.api.navigation import repair_navigation_set, verify_navigation_set
    from world2minecraft.api.progress import show_progress

    with show_progress() as progress:
        made = repair_navigation_set(folder, workers=workers, progress=progress) if repair else None
        report = verify_navigation_set(folder, progress=progress)
    print_faults(folder, report, made, as_json, "w2m vln verify")
    if as_json:
        return
    if report.files:
        print(f"{folder}: {report.items:,} items, {report.files:,} files: ok")
    else:
        print(f"{folder}: {report.items:,} items: the records and their images are ok")
        print("  note   of a former version; --repair adds a list of all files")
    print(f"  next   w2m vln stats {folder}")
