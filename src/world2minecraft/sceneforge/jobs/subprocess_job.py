"""Jobs that run in a subprocess, which can be stopped at any moment.

The subprocess is ``python -m world2minecraft.sceneforge.jobs.worker``. It receives one JSON line
with a task and its arguments, and answers with JSON lines: progress steps, then a result or an
error. It exits by itself when the program that started it has exited.
"""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import WorkerError, World2MinecraftError
from world2minecraft.sceneforge.jobs.jobs import JobFunction, JobProgress

WORKER = (sys.executable, "-m", "world2minecraft.sceneforge.jobs.worker")
GRACE_S = 3.0  # Time for a process to exit after SIGTERM.
ON_WINDOWS = sys.platform == "win32"


class ReportedError(World2MinecraftError):
    """An error reported by a worker process, with the message of that process."""


def run_in_subprocess(task: str, within: Path | None = None, **needs: Any) -> JobFunction:
    """Return a work function for a job that runs a task of ``worker.TASKS`` in a subprocess.

    Args:
        task: Name of the task.
        within: Folder whose path is removed from error messages, because it does not help the user.
        needs: Arguments of the task as JSON values.
    """

    def work(report: JobProgress) -> Any:
        try:
            return _relay(start_worker(task, needs), report)
        except ReportedError as error:
            raise ReportedError(
                str(error).replace(f"{within}{os.sep}", "") if within else error
            ) from None

    return work


def start_worker(task: str, needs: Mapping[str, Any]) -> "subprocess.Popen[bytes]":
    """Start a worker process that runs a task."""
    process = subprocess.Popen(
        WORKER,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        start_new_session=not ON_WINDOWS,
    )
    with suppress(OSError):  # ``_relay`` reports a process that exited at once.
        _pipe(process.stdin).write(json.dumps([task, needs]).encode() + b"\n")
        _pipe(process.stdin).flush()
    return process


def _pipe(stream: Any) -> Any:
    """Return a stream of a process that was started with pipes."""
    if stream is None:
        raise WorkerError("the job process was started without pipes for stdin and stdout")
    return stream


def _relay(process: "subprocess.Popen[bytes]", report: JobProgress) -> Any:
    """Forward the progress of a process to a job, and return its result."""
    report.on_cancel(lambda: stop_worker(process))
    try:
        for line in _pipe(process.stdout):
            message = json.loads(line)
            if "error" in message:
                raise ReportedError(message["error"])
            if "result" in message:
                return message["result"]
            report(message["stage"], message["done"], message["total"], message["note"])
    finally:
        stop_worker(process)
    code = process.returncode
    if code == -signal.SIGTERM:
        raise WorkerError("the job process was terminated")
    reason = "killed by the system, probably out of memory" if code == -9 else f"exit code {code}"
    raise WorkerError(f"the job failed: {reason}; try fewer blocks per metre")


def stop_worker(process: "subprocess.Popen[bytes]") -> None:
    """Terminate a worker process and its child processes."""
    with suppress(OSError):
        _pipe(process.stdin).close()
    if process.poll() is None:
        _signal(process, signal.SIGTERM)
        try:
            process.wait(GRACE_S)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


def _signal(process: "subprocess.Popen[bytes]", number: int) -> None:
    with suppress(OSError):
        if ON_WINDOWS:
            process.terminate()
        else:
            os.killpg(process.pid, number)
