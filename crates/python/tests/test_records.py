"""Records come in and go out as arrays and tables."""

import kempf
import numpy as np
import pandas
import polars
import pytest
from conftest import ROOT


@pytest.fixture
def record(undeclared):
    return kempf.read(undeclared)


def columns(record):
    return {name: np.array(record[name]) for name in record.columns}


def test_columns_are_arrays_in_degrees_that_cannot_be_written(record):
    assert record.t_s.dtype == np.float64 and len(record.t_s) == len(record) == 235
    assert abs(record.rudder_deg).max() == pytest.approx(20.0, abs=0.1)
    assert record.yaw_rate_deg_s is None
    assert record.columns == ("t_s", "heading_deg", "rudder_deg", "rudder_order_deg")
    assert record.heading_deg is record["heading_deg"]
    with pytest.raises(ValueError):
        record.heading_deg[0] = 1.0
    with pytest.raises(KeyError, match="thrust.*rudder_order_deg"):
        record["thrust"]


def test_arrays_make_the_same_record(record):
    own = kempf.Record.from_arrays(**columns(record), name="own")
    assert (own.name, own.file) == ("own", "own.csv")
    for name in record.columns:
        np.testing.assert_allclose(own[name], record[name], rtol=1e-15, atol=0)
    lists = kempf.Record.from_arrays(**{name: list(values) for name, values in columns(record).items()}, name="own")
    assert lists.sha256 == own.sha256 != ""


@pytest.mark.parametrize("library", [pandas, polars])
def test_tables_make_the_same_record_and_come_out_again(record, library):
    own = kempf.Record.from_frame(library.DataFrame(columns(record)), name="own")
    assert own.sha256 == kempf.Record.from_arrays(**columns(record), name="own").sha256
    frame = own.to_frame(library.__name__)
    assert isinstance(frame, library.DataFrame) and list(frame.columns) == list(own.columns)
    np.testing.assert_array_equal(frame["heading_deg"].to_numpy(), own.heading_deg)


def test_a_table_can_be_fitted_as_it_is(record):
    frame = pandas.DataFrame(columns(record))
    assert kempf.fit(frame, methods="srivc")["srivc"].ok
    assert len(kempf.fit([frame, record], methods="srivc").records) == 2


def test_numbers_of_any_kind_and_gaps_are_understood(record):
    given = columns(record)
    given["t_s"] = given["t_s"].astype(np.int64)
    given["heading_deg"] = np.mod(given["heading_deg"], 360.0).astype(np.float32)[::1]
    given["heading_deg"][7] = np.nan
    own = kempf.Record.from_arrays(**given)
    assert np.isnan(own.heading_deg[7]) and np.isfinite(own.heading_deg[8])
    assert abs(np.diff(own.heading_deg[8:])).max() < 3, "headings are unwrapped"
    strided = {name: np.repeat(values, 2)[::2] for name, values in columns(record).items()}
    assert len(kempf.Record.from_arrays(**strided)) == len(record)


def test_columns_with_stamps_words_and_other_units_are_understood(record):
    frame = pandas.DataFrame(columns(record))
    frame["time"] = pandas.Timestamp("2026-03-01 12:00:00") + pandas.to_timedelta(frame.pop("t_s"), unit="s")
    frame["heading_rad"] = np.radians(frame.pop("heading_deg"))
    frame["thrust"] = 1000.0 + frame.index
    own = kempf.Record.from_frame(frame)
    np.testing.assert_allclose(own.heading_deg, record.heading_deg, rtol=1e-12)
    assert own["thrust"][3] == 1003.0
    part = kempf.Record.from_frame(frame, from_s="12:00:30", until_s="12:03:20")
    assert part.t_s[-1] - part.t_s[0] == 170.0


def test_a_part_of_a_file_is_read(undeclared):
    whole, part = kempf.read(undeclared), kempf.read(undeclared, from_s=20, until_s=200.5)
    assert (part.t_s[0], part.t_s[-1]) == (20.0, 200.0)
    assert part.sha256 != whole.sha256


def test_files_are_joined_and_described(tmp_path):
    logs = ROOT / "tests" / "logs"
    rudder = logs / "two-files-rudder.csv"
    joined = kempf.read(logs / "two-files-heading.csv", with_columns=rudder)
    assert len(joined) > 8 and joined.sha256 == kempf.read(logs / "two-files-heading.csv", with_columns=[rudder]).sha256
    sidecar = tmp_path / "own.toml"
    sidecar.write_text("[ship]\nlength-m = 7.0\nspeed-m-s = 1.18\n")
    described = kempf.read(logs / "clean.csv", columns=sidecar)
    assert (described.length_m, described.approach_speed_m_s) == (7.0, 1.18)


def test_length_and_speed_are_given(undeclared):
    record = kempf.read(undeclared, length_m=120.5, speed_kn=10)
    assert record.length_m == 120.5 and record.approach_speed_m_s == pytest.approx(5.144444, rel=1e-6)


def test_a_record_is_saved_and_read_again(record, tmp_path):
    again = kempf.read(record.save(tmp_path / "again.csv"))
    np.testing.assert_allclose(again.heading_deg, record.heading_deg, rtol=1e-15)


def test_scenarios_come_as_text_path_and_dictionary(tmp_path):
    from conftest import ZIGZAG

    tree = {
        "question": "What are K and T?",
        "seed": np.int64(5),
        "replicates": 3,
        "ship": {"first-order": {"K-per-s": 0.1, "T-s": 16.3, "rudder-bias-deg": np.float64(0.5)}},
        "manoeuvre": {"zig-zag": {"rudder-deg": 10, "heading-deg": 10}},
        "steering-gear": {"rate-deg-s": 2.5},
        "recording": {"sampling-s": 1.0, "duration-s": 240.0},
        "sensor": {"heading-noise-deg": 0.1},
        "identifier": [{"method": {"output-error": {}}}],
    }
    path = tmp_path / "scenario.toml"
    path.write_text(ZIGZAG)
    trials = [kempf.simulate(scenario, replicate=1) for scenario in (ZIGZAG, path, str(path), tree)]
    assert len({trial.record.sha256 for trial in trials}) == 1
    truth = trials[0].truth
    assert (truth.nearest.K_per_s, truth.nearest.T_s) == pytest.approx((0.1, 16.3))
    assert truth.nearest.delta_r_deg == pytest.approx(0.5)
    assert truth.effects == () and len(truth.motion.t_s) == len(truth.motion.heading_deg) > 200
    assert len(kempf.simulate(ZIGZAG, replicate="all")) == 3
    assert kempf.simulate(ZIGZAG, seed=6).record.sha256 != kempf.simulate(ZIGZAG).record.sha256


def test_effects_and_cells_of_a_scenario_are_told():
    from conftest import ZIGZAG

    swept = ZIGZAG + "\n[[effect]]\nnonlinear_damping.n3-s2-per-deg2 = 1.0\n"
    swept += "\n[[sweep]]\nkey = 'ship.first-order.T-s'\nvalues = [15.0, 20.0]\n"
    trials = kempf.simulate(swept)
    assert [trial.truth.own.T_s for trial in trials] == pytest.approx([15.0, 20.0])
    assert all(trial.truth.effects == ("nonlinear_damping",) for trial in trials)
    assert len(kempf.simulate(swept, replicate="all")) == 6


def test_particulars_of_the_hull_are_checked(undeclared):
    with pytest.raises(kempf.KempfError, match=r"B/d \(draught-m\) is 16"):
        kempf.read(undeclared, length_m=105, speed_m_s=8.6, ship={"beam_m": 16, "draught_m": 1})
    with pytest.raises(kempf.KempfError, match="--breadth-m"):
        kempf.read(undeclared, length_m=105, speed_m_s=8.6, ship={"breadth_m": 16})
    assert kempf.read(undeclared, length_m=105, speed_m_s=8.6, ship={"beam_m": 16}).length_m == 105
