"""What engines are given to do in tests; workers import it by its name."""

import os
import signal
import time
from pathlib import Path

from world2minecraft.core.errors import OutputError


def square(number, tick):
    tick(1)
    return number * number


def fail(number, tick):
    if number == 2:
        raise OutputError("DATA", "the disk is full")
    return number


def fail_strangely(number, tick):
    class Local(Exception):
        pass

    raise Local("odd")


def die_once(place, tick):
    """Kill the own process, but not where another did before."""
    try:
        Path(place).touch(exist_ok=False)
    except FileExistsError:
        tick(1)
        return "went on"
    os.kill(os.getpid(), signal.SIGKILL)


def die(number, tick):
    os._exit(7)


def say_nothing(place, tick):
    Path(place).write_text(str(os.getpid()))
    time.sleep(3600)


def tick_for_ever(place, tick):
    Path(place).write_text(str(os.getpid()))
    while True:
        tick(1)
        time.sleep(0.01)
