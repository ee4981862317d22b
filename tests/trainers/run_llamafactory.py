"""LLaMA-Factory's training on a CPU: ``python run_llamafactory.py RECIPE.yaml key=value ...``."""

import cpu_shims  # noqa: F401
from llamafactory.train.tuner import run_exp

if __name__ == "__main__":
    run_exp()
