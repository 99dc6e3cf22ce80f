"""Work is done without the lock of the interpreter, and can be interrupted."""

import os
import signal
import threading
import time

import kempf
import pytest
from conftest import ZIGZAG


@pytest.fixture
def interrupted():
    """Sends Ctrl-C to this process after a while."""
    timers = []

    def after(seconds):
        timers.append(threading.Timer(seconds, os.kill, (os.getpid(), signal.SIGINT)))
        timers[-1].start()

    yield after
    for timer in timers:
        timer.cancel()


def test_other_threads_run_during_a_trace(undeclared):
    counted, done = [0], threading.Event()

    def count():
        while not done.wait(0.001):
            counted[0] += 1

    thread = threading.Thread(target=count)
    thread.start()
    before = counted[0]
    kempf.trace(undeclared)
    after = counted[0]
    done.set()
    thread.join()
    assert after - before > 20, "the other thread stood still"


def test_a_record_can_be_fitted_from_another_thread(first_order):
    found = []
    thread = threading.Thread(target=lambda: found.append(kempf.fit(first_order, methods="srivc")))
    thread.start()
    thread.join()
    assert found[0]["srivc"].ok


def test_an_interrupted_study_keeps_its_rows_and_goes_on(tmp_path, interrupted):
    many = ZIGZAG.replace("replicates = 3", "replicates = 1000000")
    interrupted(1.5)
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt, match=r"stopped after \d+ of 1000000 trials; their rows are kept"):
        kempf.run(many, tmp_path / "out")
    assert time.monotonic() - start < 20, "it was not waited for the end"
    assert any((tmp_path / "out" / "rows").glob("*.parquet"))
    interrupted(1.5)
    told = []
    with pytest.raises(KeyboardInterrupt):
        kempf.run(many, tmp_path / "out", progress=lambda done, most: told.append((done, most)))
    assert told[0][0] > 0 and told[-1][0] > told[0][0], "it did not go on where it was"
    assert all(most == 1000000 for _, most in told)


def test_rows_are_the_same_however_often_a_study_was_interrupted(tmp_path, interrupted):
    some = ZIGZAG.replace("replicates = 3", "replicates = 8000")
    whole = kempf.run(some, tmp_path / "whole", threads=2)

    def stop(done, most):
        if done > 100:
            raise KeyboardInterrupt("enough")

    with pytest.raises(KeyboardInterrupt):
        kempf.run(some, tmp_path / "parts", progress=stop)
    assert not (tmp_path / "parts" / "cells.json").exists()
    parts = kempf.run(some, tmp_path / "parts", threads=1)
    assert "resuming after" in parts.notes[0]
    blocks = sorted(path.name for path in whole.rows_path.iterdir())
    assert len(blocks) == 32
    for block in blocks:
        assert (parts.rows_path / block).read_bytes() == (whole.rows_path / block).read_bytes(), block


def test_what_a_progress_raises_comes_out(tmp_path):
    def fail(done, most):
        raise LookupError("my own")

    with pytest.raises(LookupError, match="my own"):
        kempf.run(ZIGZAG, tmp_path / "out", progress=fail)
    assert kempf.run(ZIGZAG, tmp_path / "out").rows_path.is_dir()


def test_an_interrupted_trace_returns_at_once(undeclared, interrupted):
    records = [kempf.read(undeclared)] * 6
    interrupted(0.3)
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        for _ in range(100):
            kempf.trace(records)
    assert time.monotonic() - start < 5


def test_progress_is_shown_on_standard_error(tmp_path, capsys):
    kempf.run(ZIGZAG, tmp_path / "out", progress=True)
    out, shown = capsys.readouterr()
    assert out == "" and shown.endswith("3 of 3 trials\n")
