"""What all tests share: a scenario, its records, and the command ``study``, which is named by ``KEMPF_STUDY``."""

import os
import subprocess
import warnings
from pathlib import Path

import kempf
import pytest

os.environ.setdefault("MPLBACKEND", "Agg")

ROOT = Path(__file__).parents[3]
RECORDS = ROOT / "scenarios" / "records"

ZIGZAG = """
question = "What are K and T?"
seed = 5
replicates = 3

[ship.first-order]
K-per-s = 0.1
T-s = 16.3
rudder-bias-deg = 0.5

[manoeuvre.zig-zag]
rudder-deg = 10.0
heading-deg = 10.0

[steering-gear]
rate-deg-s = 2.5

[recording]
sampling-s = 1.0
duration-s = 240.0

[sensor]
heading-noise-deg = 0.1

[[identifier]]
method.output-error = {}

[[identifier]]
method.integral-least-squares = {}
"""


@pytest.fixture(autouse=True)
def quiet():
    """Warnings of the program are looked at where they are the matter."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", kempf.KempfWarning)
        yield


@pytest.fixture
def study(tmp_path):
    """Runs the command in a folder of its own; returns what it wrote to standard output."""
    program = os.environ.get("KEMPF_STUDY")
    if not program:
        pytest.skip("KEMPF_STUDY does not name the command study")
    program = str(Path(program).resolve())

    def run(*words):
        done = subprocess.run([program, *map(str, words)], cwd=tmp_path, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run


@pytest.fixture(scope="session")
def first_order():
    return RECORDS / "first-order.csv"


@pytest.fixture(scope="session")
def undeclared():
    return RECORDS / "undeclared-damping.csv"


@pytest.fixture(scope="session")
def fitted(first_order):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return kempf.fit(first_order, validate=RECORDS / "undeclared-damping.csv")


@pytest.fixture(scope="session")
def traced(undeclared):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return kempf.trace(undeclared, validate=RECORDS / "first-order.csv")
