"""A script of an export on a CPU: ``python run_script.py SCRIPT.py ...``."""

import runpy
import sys
from pathlib import Path

import cpu_shims  # noqa: F401

if __name__ == "__main__":
    sys.argv = sys.argv[1:]
    sys.path.insert(0, str(Path(sys.argv[0]).parent))
    runpy.run_path(sys.argv[0], run_name="__main__")
