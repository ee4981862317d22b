"""The guard against regressions: a slower job fails it, noise of short ones does not."""

import pytest
from benchmarks.guard import report


@pytest.mark.parametrize(
    ("before", "now", "code"),
    [
        ({"build": 1.0}, {"build": 1.1}, 0),
        ({"build": 1.0}, {"build": 1.2}, 1),
        ({"build": 0.001}, {"build": 0.01}, 0),
        ({"build": 1.0, "walk": 1.0}, {"build": 0.5, "walk": 2.0}, 1),
    ],
)
def test_a_job_that_became_slower_fails(before, now, code, capsys):
    assert report([before], [now], 1.15) == code
    assert ("slower" in capsys.readouterr().out) is bool(code)


def test_the_least_of_all_rounds_counts():
    assert report([{"build": 1.0}, {"build": 3.0}], [{"build": 3.0}, {"build": 1.0}], 1.15) == 0
