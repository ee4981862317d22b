"""Error of the scale estimated for captures of unknown unit.

``python -m benchmarks.check_scale [tune]`` takes the trials on which nothing was tuned, hides their
unit and prints, by difficulty, the median and the worst error and how many exceed 15 %.
"""

import sys
from dataclasses import replace

import numpy as np

from world2minecraft.capture.scale import collect_unscaled, estimate_scale, scale_points
from world2minecraft.procgen import room_views
from world2minecraft.procgen.benchmark_trials import DIFFICULTIES, Trial, list_trials

MOST_FRAMES = 60


def error_of(trial: Trial) -> tuple[float, float]:
    """Return the relative error of a trial's scale, and the sigma that was stated."""
    views = room_views(
        trial.room(),
        sensor=trial.sensor,
        frames=min(trial.frames, MOST_FRAMES),
        seed=trial.seed,
        coverage=trial.coverage,
        depth_scale_sigma=trial.depth_scale_sigma,
        width=320,
        height=240,
    )
    surface = collect_unscaled([replace(view, colour=None, colour_camera=None) for view in views])
    factor = float(np.exp(np.random.default_rng(trial.seed).uniform(-2, 2)))
    found = estimate_scale(scale_points(surface, factor))
    return found.scale * factor - 1, found.sigma


def main(split: str = "test") -> None:
    """Print the table of a split."""
    print(f"{'difficulty':<12}{'median':>8}{'worst':>8}{'over 15 %':>11}{'error / sigma':>15}")
    for difficulty in DIFFICULTIES:
        rows = [error_of(trial) for trial in list_trials(split, difficulty)]  # type: ignore[arg-type]
        errors = np.abs([error for error, _ in rows])
        ratio = np.sqrt(np.mean([(error / sigma) ** 2 for error, sigma in rows]))
        over = int((errors > 0.15).sum())
        print(
            f"{difficulty:<12}{100 * np.median(errors):>7.1f}%{100 * errors.max():>7.1f}%"
            f"{over:>5} of {len(rows):<3}{ratio:>15.2f}",
            flush=True,
        )


if __name__ == "__main__":
    main(*sys.argv[1:2])
