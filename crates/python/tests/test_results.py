"""Results can be read, shown, tabulated and drawn."""

import dataclasses

import kempf
import matplotlib.figure
import pandas
import polars
import pytest
from conftest import RECORDS, ZIGZAG


@pytest.fixture(scope="module")
def predicted(fitted):
    asked = {"method": "maximum-likelihood", "draws": 100}
    return kempf.predict(fitted, ["turning-circle:35", "zig-zag:10/10"], replay=kempf.simulate(ZIGZAG), **asked)


@pytest.fixture(scope="module")
def ran(tmp_path_factory):
    return kempf.run(ZIGZAG, tmp_path_factory.mktemp("study") / "out")


def test_a_fit_is_read_by_names(fitted):
    found = fitted["output-error"]
    assert found.K_per_s.ci95[0] < 0.1 < found.K_per_s.ci95[1] and found.ok and not found.course_unstable
    assert [one.method for one in fitted.methods][0] == "output-error" and len(fitted.methods) == 6
    assert fitted.records[0].zigzag.overshoots_deg[0] == pytest.approx(6.86, abs=0.01)
    assert found.validation_rmse_deg[0] > found.heading_rmse_deg
    with pytest.raises(KeyError, match="guess: there are output-error"):
        fitted["guess"]


def test_a_trace_names_what_is_missing(traced):
    assert traced.verdict == "traced" and traced.effects[0].id == "nonlinear_damping"
    effect = traced.effects[0]
    assert effect.aliases == () and effect.probability > 0.95
    symbol = {"r³": "n₃/T", "r|r|": "n₂/T"}[effect.form]
    assert effect.parameters[symbol].unit == {"r³": "s/rad²", "r|r|": "1/rad"}[effect.form]
    assert traced.structures[0].weight >= traced.structures[-1].weight and traced.headline
    assert traced.structures[0].effects[0][0] == "nonlinear_damping"
    assert {one.id for one in traced.candidates if one.outcome == "added"} == {"nonlinear_damping"}
    fitted, held_out = traced.errors
    assert not fitted.held_out and held_out.held_out and held_out.after_deg < held_out.before_deg
    assert fitted.horizons == () and held_out.horizons[-1].after_deg == held_out.after_deg
    assert effect.probability_by_prior_odds[1.0] == pytest.approx(effect.probability)
    assert "zig-zag" in traced.next_trial


def test_a_prediction_has_medians_and_intervals(predicted):
    figure = predicted["zig-zag 10/10"].figures["first_overshoot_deg"]
    assert figure.ci90[0] <= figure.ci50[0] <= figure.median <= figure.ci50[1] <= figure.ci90[1]
    assert predicted["turning-circle 35"].figures["steady_rate_deg_s"].extrapolated
    assert 0 <= predicted.replays[0].band_coverage_90 <= 1 and not predicted.replays[0].extrapolated
    assert predicted.replays[0].figures["first_overshoot_deg"].measured == pytest.approx(6.8, abs=0.3)


def test_a_study_has_its_summary_and_rows(ran):
    assert ran.folder.joinpath("report.html").is_file() and ran.manifest["name"] == "scenario"
    assert [entry["method"] for entry in ran.summary] == ["output-error", "integral-least-squares"]
    assert len(ran.rows()) == len(ran.rows("polars")) == 6
    assert ran.to_frame()["trials"].tolist() == [3, 3]


def test_results_do_not_change(fitted, traced):
    for result in (fitted, fitted.methods[0], traced, traced.effects[0], fitted.methods[0].K_per_s):
        with pytest.raises(dataclasses.FrozenInstanceError):
            setattr(result, dataclasses.fields(result)[0].name, None)


@pytest.mark.parametrize("name", ["fitted", "traced", "predicted", "ran"])
def test_results_are_shown_as_text_and_in_notebooks(name, request):
    result = request.getfixturevalue(name)
    text, page = repr(result), result._repr_html_()
    assert len(text.splitlines()) > 2 and max(map(len, text.splitlines())) < 260
    assert page.startswith("<div>") and page.count("<tr>") > 1 and page.count("<div>") == page.count("</div>")
    for kind, library in (("pandas", pandas), ("polars", polars)):
        frame = result.to_frame(kind)
        assert isinstance(frame, library.DataFrame) and len(frame) > 0


def test_nothing_from_a_record_is_taken_for_markup(first_order):
    frame = kempf.read(first_order).to_frame()
    frame["<b>bold</b>"] = 1.0
    shown = kempf.Record.from_frame(frame, name="a&b")._repr_html_()
    assert "&lt;b&gt;bold" in shown and "a&amp;b" in shown and "<b>" not in shown


def test_numbers_have_the_digits_of_their_errors():
    shown = kempf.Quantity(0.123456, None, (0.1230, 0.1239))
    assert str(shown) == "0.12346 [0.12300, 0.12390]"
    assert str(kempf.Quantity(None, None, None)) == "–"
    assert str(kempf.Quantity(16.3, 0.8, None)) == "16.3"
    assert str(kempf.Quantity(16.3, 1.2, (None, 19.0))) == "16.3 [–, 19]"


@pytest.mark.parametrize(
    ("name", "draw", "panels"),
    [
        ("fitted", lambda result: result.plot(), 3),
        ("fitted", lambda result: result.plot(methods=["maximum-likelihood", "fourier-projected"], record=1), 3),
        ("fitted", lambda result: result.plot("estimates"), 3),
        ("traced", lambda result: result.plot(record=1), 3),
        ("predicted", lambda result: result.plot(), 8),
    ],
)
def test_figures_are_drawn(name, draw, panels, request, tmp_path):
    figure = draw(request.getfixturevalue(name))
    assert isinstance(figure, matplotlib.figure.Figure) and len(figure.axes) == panels
    figure.savefig(tmp_path / "figure.png")
    matplotlib.pyplot.close(figure)


def test_a_figure_shows_the_replay(fitted, first_order):
    figure = fitted.plot(methods="least-squares")
    rudder, heading, residual = figure.axes
    measured, replayed = (line.get_ydata() for line in heading.lines)
    left = residual.lines[1].get_ydata()
    assert measured - replayed == pytest.approx(left, abs=1e-9)
    assert (left**2).mean() ** 0.5 == pytest.approx(fitted["least-squares"].heading_rmse_deg, rel=1e-9)
    matplotlib.pyplot.close(figure)


def test_a_record_is_drawn(first_order):
    figure = kempf.read(first_order).plot()
    assert len(figure.axes) == 2
    matplotlib.pyplot.close(figure)


def test_an_effect_of_ones_own_is_weighed_with_the_others():
    record = kempf.read(RECORDS / "undeclared-damping.csv")
    trace = kempf.trace(record, effects={"cubic": "c * r^3"})
    assert any(one.id == "cubic" for one in trace.candidates)
    with pytest.raises(kempf.KempfError, match="did you mean `delta`"):
        kempf.trace(record, effects={"cubic": "c * dleta"})
