"""What is beside the methods of the program: the answer to take, warnings, functions, logs, the benchmark."""

import warnings

import kempf
import numpy as np
import pandas
import pytest
from conftest import RECORDS, ZIGZAG


def steady(record):
    """Least squares of the heading rate on the integral of T r' + r = K (δ + δ_r), in degrees."""
    t, psi, delta = record.t_s, record.heading_deg, record.rudder_deg
    rate = np.gradient(psi, t)
    integral = np.concatenate([[0.0], np.cumsum(0.5 * (delta[1:] + delta[:-1]) * np.diff(t))])
    table = np.stack([-(rate - rate[0]), integral, t - t[0]], axis=1)
    (T, K, bias), residual, *_ = np.linalg.lstsq(table, psi - psi[0], rcond=None)
    return K, T, bias / K


def test_the_best_answer_is_that_of_the_verdict(fitted):
    assert fitted.best is not None and fitted.best.method == fitted.document["verdict"]["method"]
    assert fitted.best is fitted[fitted.best.method]
    assert fitted.best.T_s.value == fitted.document["verdict"]["T_s"]["value"]


def test_results_have_their_warnings(fitted, traced, first_order, tmp_path):
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always", kempf.KempfWarning)
        twice = kempf.fit([first_order, first_order], methods=["output-error", "srivc"])
        predicted = kempf.predict(twice, "zig-zag:10/10", draws=50)
    assert any("given twice" in warning for warning in twice.warnings)
    told = [str(one.message) for one in said]
    assert all(warning in told for warning in (*twice.warnings, *predicted.warnings)) and predicted.warnings
    study = kempf.run(ZIGZAG, tmp_path / "study")
    for result in (fitted, traced, study):
        assert isinstance(result.warnings, tuple) and all(isinstance(one, str) for one in result.warnings)


def test_a_function_is_a_method(first_order):
    seen = []

    def mine(record):
        seen.append(record)
        return steady(record)

    fit = kempf.fit(first_order, methods="output-error", own={"mine": mine})
    assert [one.method for one in fit.methods] == ["output-error", "mine"]
    assert isinstance(seen[0], kempf.Record) and seen[0].name == "first-order"
    K, T, delta_r = steady(kempf.read(first_order))
    own = fit["mine"]
    assert (own.K_per_s.value, own.T_s.value, own.delta_r_deg.value) == pytest.approx((K, T, delta_r), rel=1e-12)
    assert own.K_per_s.ci95 is None and own.heading_rmse_deg < 2.0
    assert fit.replay("mine") is not None
    assert kempf.fit([first_order] * 2, own={"two": lambda one, other: steady(other)}, methods="srivc")["two"].ok


def test_a_function_may_know_its_errors(first_order):
    errors = np.diag([0.004, 0.9, 0.2]) ** 2
    fit = kempf.fit(first_order, methods="srivc", own={"mine": lambda record: (*steady(record), errors)})
    own = fit["mine"]
    assert (own.K_per_s.sd, own.T_s.sd, own.delta_r_deg.sd) == pytest.approx((0.004, 0.9, 0.2), rel=1e-9)
    assert kempf.predict(fit, "zig-zag:10/10", method="mine", draws=50).manoeuvres


def test_a_function_that_fails_says_why(first_order):
    def raises(record):
        raise ValueError("no excitation")

    own = {"raises": raises, "short": lambda record: (0.1, 16.0), "no-ship": lambda record: (-0.1, 16.0, 0.0)}
    fit = kempf.fit(first_order, methods="srivc", own=own)
    assert "ValueError: no excitation" in fit["raises"].reason
    assert "2 values" in fit["short"].reason and "not a ship" in fit["no-ship"].reason
    for label in ("srivc", ""):
        with pytest.raises(kempf.KempfError, match="label"):
            kempf.fit(first_order, methods="srivc", own={label: steady})


@pytest.mark.parametrize("zone", [None, "Asia/Tokyo"])
def test_dates_of_an_index_are_the_time(undeclared, zone):
    record = kempf.read(undeclared)
    start = pandas.Timestamp("2026-03-01 12:00:00", tz=zone)
    frame = pandas.DataFrame(
        {"heading_deg": record.heading_deg, "rudder_deg": record.rudder_deg},
        index=start + pandas.to_timedelta(record.t_s, unit="s"),
    )
    own = kempf.Record.from_frame(frame)
    np.testing.assert_allclose(own.t_s - own.t_s[0], record.t_s - record.t_s[0], atol=1e-6)
    part = kempf.Record.from_frame(frame, from_s="12:00:30", until_s="12:03:20")
    assert part.t_s[-1] - part.t_s[0] == pytest.approx(170.0)
    assert kempf.fit(frame, methods="srivc")["srivc"].ok
    frame["t_s"] = record.t_s
    assert kempf.Record.from_frame(frame).t_s[0] == record.t_s[0], "a column goes before the index"


def test_manoeuvres_of_logs_are_found(first_order, study):
    found = kempf.find(first_order)
    assert found.manoeuvres[0].kind.startswith("zig-zag") and found.manoeuvres[0].trial == 1
    assert found._text == study("find", first_order, "--format", "json")
    assert len(kempf.find([first_order, RECORDS / "undeclared-damping.csv"]).to_frame()) >= 2
    assert "zig-zag" in repr(found)
    read = kempf.read(first_order, trial=1)
    assert read.t_s[0] >= found.manoeuvres[0].from_s - 1e-9
    with pytest.raises(kempf.KempfError, match="none.csv"):
        kempf.find("none.csv")


def test_a_function_takes_part_in_a_benchmark(tmp_path, study):
    scenario = tmp_path / "one.toml"
    scenario.write_text(ZIGZAG, "utf-8")
    told = []
    result = kempf.bench(
        scenario,
        methods=["output-error", "integral-least-squares"],
        own={"mine": steady},
        tasks="indices",
        progress=lambda done, most: told.append((done, most)),
    )
    standings = {one.method: one for one in result.standings}
    assert set(standings) == {"output-error", "integral-least-squares", "mine"} and standings["mine"].failed == 0
    assert standings["output-error"].median < standings["mine"].median
    assert told[-1] == (3, 3) and result.warnings == ()
    assert len(result.to_frame()) == 3 and "mine" in repr(result)
    command = ("bench", scenario, "--method", "output-error", "--task", "indices", "--format", "json")
    alone = kempf.bench(scenario, methods="output-error", tasks="indices")
    assert alone._text == study(*command)
    with pytest.raises(kempf.KempfError, match="no such task"):
        kempf.bench(scenario, tasks="squares")
