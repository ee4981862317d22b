"""The scan benchmark for any method: its captures without their truth, and the scores of results.

``python -m benchmarks.scan_benchmark write FOLDER [--split test] [--difficulty noise ...]
[--trials N]`` makes the scans: ``FOLDER/captures/NAME`` is what a method may see, and
``FOLDER/truth/NAME`` what it may not. What is there already is not made again.

``python -m benchmarks.scan_benchmark score FOLDER RESULTS [--stages] [--json FILE] [--verbose]``
scores ``RESULTS/NAME`` of each truth: a run of ``w2m reconstruct``, or another method's
``labels.npz`` and ``objects.json``. Truths of ``w2m evaluate scannet SCANS --out FOLDER/truth``
are scored alike. docs/results/scan-benchmark.md has the rules; the file of ``--json`` is what
``python -m benchmarks.leaderboard add`` takes.
"""

import argparse
import shutil
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rich.console import Console

from benchmarks.check_faithful import CLEAN, chosen_trials, rows_table, stages_table
from world2minecraft.core.errors import InputError, UsageError, World2MinecraftError
from world2minecraft.core.files import read_json, write_json
from world2minecraft.evaluation.scoring import evaluate_reconstruction
from world2minecraft.evaluation.scoring.other_methods import evaluate_foreign, foreign_file
from world2minecraft.evaluation.scoring.stage_losses import stage_losses
from world2minecraft.procgen.benchmark_trials import DIFFICULTIES, Trial, write_trial

CAPTURES, TRUTHS = "captures", "truth"
TRUTH_FILES = ("truth.npz", "truth.json")
OWN = "own scenes"  # The row of truths that are no trials, such as a user's ScanNet.


def write_captures(trials: Sequence[Trial], folder: Path) -> None:
    """Write the captures of some trials and, apart from them, their truths.

    Raises:
        OutputError: the folder cannot be written.
    """
    for done, trial in enumerate(trials, start=1):
        truth = folder / TRUTHS / trial.name
        if not (truth / TRUTH_FILES[1]).is_file():
            making = folder / f"{trial.name}.part"
            write_trial(trial, making)
            truth.mkdir(parents=True, exist_ok=True)
            capture = folder / CAPTURES / trial.name
            stated = read_json(making / TRUTH_FILES[1]) | {
                "capture": f"../../{CAPTURES}/{trial.name}"
            }
            shutil.move(making / TRUTH_FILES[0], truth / TRUTH_FILES[0])
            (making / TRUTH_FILES[1]).unlink()
            shutil.rmtree(capture, ignore_errors=True)
            capture.parent.mkdir(parents=True, exist_ok=True)
            making.rename(capture)
            write_json(truth / TRUTH_FILES[1], stated)  # Last: it says that all is there.
        print(f"{trial.name} ({done} of {len(trials)})", file=sys.stderr, flush=True)


def score_results(folder: Path, results: Path, stages: bool = False) -> list[dict[str, Any]]:
    """Return a row of facts for each truth of which there is a result, as check_faithful's.

    Raises:
        InputError: there is no truth or no result, or a file is damaged.
    """
    names = [path.parent.name for path in (folder / TRUTHS).glob(f"*/{TRUTH_FILES[0]}")]
    if not names:
        raise InputError(
            folder / TRUTHS,
            f"holds no truth; make them: python -m benchmarks.scan_benchmark write {folder}",
        )
    names.sort(key=lambda name: (_order(name), name))
    there = [name for name in names if (results / name).exists()]
    if not there:
        raise InputError(results, f"holds no result; {names[0]}/labels.npz would be one")
    for name in names:
        if name not in there:
            print(f"no result for {name}", file=sys.stderr)
    return [_scored(folder / TRUTHS / name, results / name, stages) for name in there]


def group(name: str) -> str:
    """Return the row of the table that a truth belongs to.

    Example:
        >>> group("noise-1000"), group("noise-1000-clean"), group("scene0000_00")
        ('noise', 'clean', 'own scenes')
    """
    if name.endswith(f"-{CLEAN}"):
        return CLEAN
    first = name.partition("-")[0]
    return first if first in DIFFICULTIES else OWN


def _order(name: str) -> int:
    return (*DIFFICULTIES, CLEAN, OWN).index(group(name))


def _scored(truth: Path, result: Path, stages: bool) -> dict[str, Any]:
    foreign = foreign_file(result)
    row: dict[str, Any] = {"trial": truth.name, "difficulty": group(truth.name)}
    if foreign is not None:
        if stages:
            raise UsageError(f"{result} is no run of w2m reconstruct; leave --stages out")
        return row | {"labels": "given"} | evaluate_foreign(foreign, truth)
    row |= {"labels": "run"} | evaluate_reconstruction(result, truth)
    return row | {"stages": stage_losses(result, truth)} if stages else row


def main(words: Sequence[str]) -> int:
    """Do what ``words`` ask for and return the exit code."""
    chosen = _options(words)
    try:
        if chosen.what == "write":
            difficulties = chosen.difficulty or DIFFICULTIES
            write_captures(chosen_trials(chosen.split, difficulties, chosen.trials), chosen.folder)
            return 0
        rows = score_results(chosen.folder, chosen.results, chosen.stages)
    except World2MinecraftError as error:
        print(error, file=sys.stderr)
        return error.exit_code
    console = Console(width=None if sys.stdout.isatty() else 190)
    console.print(rows_table(str(chosen.results), rows, chosen.verbose))
    if chosen.stages:
        console.print(stages_table("what is left to lose", rows))
    if chosen.json:
        write_json(chosen.json, rows)
    return 0


def _options(words: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.scan_benchmark", description=(__doc__ or "").splitlines()[0]
    )
    verbs = parser.add_subparsers(dest="what", required=True)
    write = verbs.add_parser("write", help="make the scans, and their truths apart from them")
    write.add_argument("folder", type=Path)
    write.add_argument("--split", choices=("tune", "test"), default="test")
    write.add_argument("--difficulty", nargs="+", choices=(*DIFFICULTIES, CLEAN))
    write.add_argument("--trials", type=int, default=10, help="of each difficulty")
    score = verbs.add_parser("score", help="score results against the truths")
    score.add_argument("folder", type=Path)
    score.add_argument("results", type=Path, help="holds a folder for each scan, by its name")
    score.add_argument("--stages", action="store_true", help="what each stage of our runs loses")
    score.add_argument("--json", type=Path, help="write all figures to this file")
    score.add_argument("--verbose", action="store_true", help="a row for each scan")
    return parser.parse_args(words)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
