"""The numbers are those of the command, to the last bit."""

import json

import kempf
from conftest import ZIGZAG


def test_a_fit_is_that_of_the_command(study, tmp_path, first_order, undeclared):
    study("fit", first_order, "--validate", undeclared, "--length-m", 100, "--speed-kn", 15, "--out", "f")
    known = {"length_m": 100, "speed_kn": 15}
    records = [kempf.read(path, **known) for path in (first_order, undeclared)]
    result = kempf.fit(records[0], validate=records[1])
    expected = (tmp_path / "f" / "fit.json").read_bytes()
    assert result.save(tmp_path / "own.json").read_bytes() == expected
    assert repr(result.document) == repr(json.loads(expected))
    entry = next(one for one in json.loads(expected)["methods"] if one["method"] == "output-error")
    assert result["output-error"].T_s.value == entry["parameters"]["T_s"]["value"]
    assert result["output-error"].T_s.ci95 == tuple(entry["parameters"]["T_s"]["ci95"])
    assert result["output-error"].K_prime.value == entry["prime"]["K"]["value"]


def test_a_fit_of_paths_and_of_some_methods_is_that_of_the_command(study, tmp_path, first_order):
    study("fit", first_order, "--method", "srivc", "--method", "output-error", "--seed", 3, "--out", "f")
    result = kempf.fit(first_order, methods=["srivc", "output-error"], seed=3)
    assert result.save(tmp_path / "own.json").read_bytes() == (tmp_path / "f" / "fit.json").read_bytes()


def test_a_trace_is_that_of_the_command(study, tmp_path, first_order, undeclared):
    words = ["--without", "wind", "--without-effect", "second_order,wind_moment", "--rule", "bic"]
    study("trace", undeclared, "--validate", first_order, *words, "--out", "t")
    result = kempf.trace(
        undeclared,
        validate=first_order,
        without="wind",
        without_effect=["second_order", "wind_moment"],
        rule="bic",
    )
    expected = (tmp_path / "t" / "trace.json").read_bytes()
    assert result.save(tmp_path / "own.json").read_bytes() == expected
    assert repr(result.document) == repr(json.loads(expected))


def test_a_prediction_is_that_of_the_command(study, tmp_path, monkeypatch, first_order, fitted):
    monkeypatch.chdir(tmp_path)
    fitted.save("fit.json")
    words = ["--manoeuvre", "turning-circle:-35", "--manoeuvre", "zig-zag:20/20", "--draws", 200]
    study(
        "predict",
        "fit.json",
        *words,
        "--method",
        "output-error",
        "--replay",
        first_order,
        "--calm",
        "--length-m",
        100,
        "--speed-kn",
        15,
        "--out",
        "p",
    )
    asked = {"method": "output-error", "draws": 200, "calm": True, "length_m": 100, "speed_kn": 15}
    expected = (tmp_path / "p" / "predict.json").read_bytes()
    replay = kempf.read(first_order, length_m=100, speed_kn=15)
    for model in ("fit.json", fitted):
        result = kempf.predict(model, ["turning-circle:-35", "zig-zag:20/20"], replay=replay, **asked)
        assert result.save("own.json").read_bytes() == expected
    assert repr(result.document) == repr(json.loads(expected))


def test_the_manoeuvres_of_the_imo_are_predicted_where_none_is_named(study, tmp_path, monkeypatch, traced):
    monkeypatch.chdir(tmp_path)
    traced.save("trace.json")
    study("predict", "trace.json", "--draws", 100, "--out", "p")
    result = kempf.predict(traced, draws=100)
    assert result.save("own.json").read_bytes() == (tmp_path / "p" / "predict.json").read_bytes()
    assert {one.criterion for one in result.imo} >= {"10/10 first overshoot"}


def test_a_simulated_record_is_the_file_that_the_command_writes(study, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "zz.toml").write_text(ZIGZAG)
    study("simulate", "zz.toml", "--replicate", 2, "--out", "zz-2.csv")
    simulated = kempf.simulate("zz.toml", replicate=2)
    assert simulated.truth.document == json.loads((tmp_path / "zz-2.truth.json").read_text())
    study("fit", "zz-2.csv", "--out", "f")
    assert simulated.record.name == "zz-2"
    assert kempf.fit(simulated).save("own.json").read_bytes() == (tmp_path / "f" / "fit.json").read_bytes()


def test_the_hull_of_a_simulated_record_is_known_to_a_prediction(study, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    hull = ZIGZAG.replace("[ship.first-order]\nK-per-s = 0.1\nT-s = 16.3\nrudder-bias-deg = 0.5", "[ship.kvlcc2]")
    (tmp_path / "hull.toml").write_text(hull.replace("duration-s = 240.0", "duration-s = 900.0"))
    study("simulate", "hull.toml", "--out", "hull-0.csv")
    study("fit", "hull-0.csv", "--method", "output-error", "--out", "f")
    study("predict", "f/fit.json", "--replay", "hull-0.csv", "--length-m", 7, "--out", "p", "--draws", 50)
    simulated = kempf.simulate("hull.toml")
    replay = kempf.Record.from_frame(simulated.record.to_frame(), name="hull-0", length_m=simulated.record.length_m)
    assert replay.length_m == simulated.record.length_m > 100
    result = kempf.predict("f/fit.json", replay=kempf.read("hull-0.csv", length_m=7), length_m=7, draws=50)
    assert result.save("own.json").read_bytes() == (tmp_path / "p" / "predict.json").read_bytes()


def test_arrays_are_read_as_the_file_of_them_would_be(study, tmp_path, monkeypatch, undeclared):
    monkeypatch.chdir(tmp_path)
    frame = kempf.read(undeclared).to_frame()
    frame.to_csv("own.csv", index=False)
    study("fit", "own.csv", "--length-m", 105, "--speed-m-s", 8, "--out", "f")
    record = kempf.Record.from_frame(frame, name="own", length_m=105, ship_speed_m_s=8)
    found = kempf.fit(record).document
    expected = json.loads((tmp_path / "f" / "fit.json").read_text())
    for document in (found, expected):
        # Another program may write another number of digits for the same number.
        del document["trials"][0]["sha256"]
    assert repr(found) == repr(expected)


def test_a_study_is_that_of_the_command(study, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "zz.toml").write_text(ZIGZAG)
    said = json.loads(study("zz.toml", "--out", "a", "--format", "json"))
    result = kempf.run("zz.toml", "b", threads=1)
    import pandas as pd

    # A block says by which program it was made, and the two may be of different times.
    assert pd.read_parquet("a/rows").equals(pd.read_parquet("b/rows"))
    for name in ("summary.csv", "pairs.csv"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes(), name
    for document in (said, own := result.document):
        document["folder"] = ""
        # What depends on the clock and on when the two were built.
        for key in ("sha256", "machine", "git-revision", "git-dirty", "version"):
            document["manifest"].pop(key, None)
    assert repr(own) == repr(said)
    assert (tmp_path / "b" / "report.html").is_file()
