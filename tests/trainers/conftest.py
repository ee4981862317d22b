"""The programs beside run in the trainers' own environments, and cannot be imported in ours."""

collect_ignore = [
    *("cpu_shims.py", "tiny_qwen.py", "run_llamafactory.py", "run_script.py", "read_easyr1.py"),
    "run_api.py",
]
