"""LLaMA-Factory's chat server on a CPU: ``python run_api.py --model_name_or_path FOLDER ...``."""

import cpu_shims  # noqa: F401
from llamafactory.api.app import run_api

if __name__ == "__main__":
    run_api()
