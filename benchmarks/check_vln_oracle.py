"""Success rate and SPL of the navigation oracle in given worlds.

``python -m benchmarks.check_vln_oracle WORLD...``

Episodes are drawn as in the environment, executed move by move and scored. The exit code is 1 if
the oracle misses a goal or its SPL is below the target.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

from world2minecraft.navigation.environment.env import VlnEnv
from world2minecraft.navigation.episodes import random_episodes
from world2minecraft.navigation.scene import open_scene
from world2minecraft.navigation.types import MOVE_SETS

LEAST_SPL = 0.95


def main(words: list[str]) -> int:
    """Print a line a world and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("worlds", nargs="+", type=Path)
    parser.add_argument("--episodes", type=int, default=20)
    parser.add_argument("--moves", choices=sorted(MOVE_SETS), default="vlnce")
    options = parser.parse_args(words)
    missed = 0
    for world in options.worlds:
        scene = open_scene(world)
        scores = []
        for episode in random_episodes(scene, options.episodes, move_set=options.moves):
            env = VlnEnv(scene, episodes=[episode], move_set=options.moves, observations=["pose"])
            env.reset()
            ends = [env.step(int(move)) for move in episode.moves]
            scores.append(ends[-1][4]["score"])
        reached = np.mean([score["success"][0] for score in scores])
        spl = np.mean([score["spl"] for score in scores])
        length = np.mean([score["shortest_m"] for score in scores])
        steps = np.mean([score["steps"] for score in scores])
        print(
            f"{scene.scene_id}: {len(scores)} episodes of {length:.1f} m and {steps:.0f} moves, "
            f"SR at 0.5 m {reached:.3f}, SPL {spl:.3f}, body {scene.body:g}"
        )
        missed += reached < 1 or (spl < LEAST_SPL and options.moves != "block")
    return int(missed > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
