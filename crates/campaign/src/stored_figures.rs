//! Plot data stored for the first trial of a cell, and the plots.

use report::figures::{
    AxisSpec, Layer, LayerKind, LayeredPanel, NamedRows, PanelGroup, PanelRow, Panels, Pen, RowItem, RowKind,
    RowsColumn, TickRule,
};
use report::number::{self, MISSING};
use report::palette::{HEADING, INK, RECORD};
use report::{CurveOrigin, PlotCurve, symbol};
use serde::{Deserialize, Serialize};

/// Curve fitted to a heading, a Fourier series or any other, with the goodness of fit.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[schemars(rename = "CurveFit")]
pub struct FourierFitCurves {
    /// Measured heading, deg, against time, s.
    pub measured: PlotCurve,
    /// Fitted heading, deg, against time, s, dense enough for a smooth curve.
    pub fitted: PlotCurve,
    /// Name of the fitted curve, such as "Fourier series, 5 harmonics".
    pub fitted_name: String,
    /// Method of the fit; determines the style of the curve.
    #[serde(default)]
    pub origin: Option<CurveOrigin>,
    /// Measured minus fitted heading, deg, against time, s.
    pub residual: PlotCurve,
    /// Coefficient of determination of the heading.
    pub r_squared: Option<f64>,
    /// Fundamental frequency of the series, rad/s.
    pub fundamental_rad_s: Option<f64>,
}

impl FourierFitCurves {
    /// Panels: measured points and fitted curve above, the residual on its own scale below.
    pub fn panels(&self) -> Panels {
        let name = if self.fitted_name.is_empty() { "fitted curve" } else { &self.fitted_name };
        let upper = vec![
            Layer::new("measured", self.measured.clone(), LayerKind::Record),
            Layer::line(name, self.fitted.clone(), self.origin.as_ref().map_or(Pen::new(HEADING), Pen::from_origin)),
        ];
        let lower = vec![
            Layer::line("", self.residual.clone(), Pen::new(RECORD).width(0.6)),
            Layer::new("", self.residual.clone(), LayerKind::Dots(INK)),
        ];
        let residual = AxisSpec::new("residual [°]", TickRule::Angle);
        let rows = vec![(PanelRow::new(AxisSpec::heading(), 0.32), upper), (PanelRow::zeroed(residual, 0.14), lower)];
        let finite = |value: Option<f64>| value.filter(|value| value.is_finite());
        // Five decimals, because the fit of a smooth record differs from 1 in the fourth.
        let r_squared = finite(self.r_squared).map(|value| format!("{} = {}", symbol("R²"), number::fixed(value, 5)));
        let fundamental = finite(self.fundamental_rad_s)
            .map(|value| format!("fundamental {} = {} rad/s", symbol("ω"), number::significant(value, 4)));
        let fit_figures = r_squared.into_iter().chain(fundamental).collect();
        Panels { legend_texts: fit_figures, ..Panels::over_time(rows) }
    }
}

/// Heading, yaw rate and yaw acceleration from one source; an empty curve is not plotted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct MotionCurves {
    /// Source of the curves; determines their style.
    pub origin: CurveOrigin,
    /// Name in the legend, if it differs from that of the origin.
    pub name: Option<String>,
    /// Heading, deg, against time, s.
    pub heading: PlotCurve,
    /// Yaw rate, deg/s, against time, s.
    pub yaw_rate: PlotCurve,
    /// Yaw acceleration, deg/s², against time, s.
    pub yaw_acceleration: PlotCurve,
}

/// Headings and their derivatives.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
pub struct DerivativeCurves {
    /// Sources, in plotting order.
    pub curves: Vec<MotionCurves>,
}

impl DerivativeCurves {
    /// Panels: heading, yaw rate and yaw acceleration above each other. They show how differentiation amplifies a small
    /// error of the heading.
    pub fn panels(&self) -> Panels {
        let row = |y: AxisSpec, series: fn(&MotionCurves) -> &PlotCurve| {
            let layer = |motion: &MotionCurves| {
                let name = motion.name.as_deref().unwrap_or_else(|| motion.origin.label());
                Layer::line(name, series(motion).clone(), Pen::from_origin(&motion.origin))
            };
            (PanelRow::new(y, 0.2), self.curves.iter().map(layer).collect())
        };
        let rows = vec![
            row(AxisSpec::heading(), |motion| &motion.heading),
            row(AxisSpec::yaw_rate(), |motion| &motion.yaw_rate),
            row(AxisSpec::decimal(format!("yaw accel. {} [°/s²]", symbol("ṙ"))), |motion| &motion.yaw_acceleration),
        ];
        Panels::over_time(rows)
    }
}

/// Replay of a method: the heading of the model for the recorded rudder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ReplayCurves {
    /// Method, which determines the style of the replay.
    pub origin: CurveOrigin,
    /// Replayed heading, deg, against time, s.
    pub heading: PlotCurve,
    /// Recorded minus replayed heading, deg, against time, s.
    pub residual: PlotCurve,
    /// Root mean square of the residual, deg.
    pub rms_deg: Option<f64>,
}

/// Record and its replays.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Replays {
    /// Recorded heading, deg, against time, s.
    pub record: PlotCurve,
    /// Noise-free heading, deg, against time, s.
    pub truth: Option<PlotCurve>,
    /// One replay per method.
    pub replays: Vec<ReplayCurves>,
}

/// Maximum excursion of a replay beyond the range of the record, as a share of that range; beyond it the replay is cut.
const HEADING_ROOM: f64 = 0.25;
/// Limit of a residual in multiples of the median absolute value; beyond it the residual is cut.
const RESIDUAL_ROOM: f64 = 10.0;

impl Replays {
    /// Panels: record and replays above, one residual panel per method below, because seven residuals in one panel are
    /// unreadable. A diverging replay or residual is cut at the frame, so that one failure does not flatten the
    /// others; the title of every panel states the extent of its residual.
    pub fn panels(&self) -> Panels {
        let mut upper = vec![Layer::new("record", self.record.clone(), LayerKind::Record)];
        let truth = |curve: &PlotCurve| Layer::line("truth", curve.clone(), Pen::from_origin(&CurveOrigin::Truth));
        upper.extend(self.truth.as_ref().map(truth));
        upper.extend(self.replays.iter().map(|replay| {
            Layer::line(replay.origin.label(), replay.heading.clone(), Pen::from_origin(&replay.origin))
                .widening_at_most(HEADING_ROOM)
        }));
        let below = |replay: &ReplayCurves| {
            let size = |size: f64| format!("{}°", number::significant(size, 2));
            let rms = replay.rms_deg.filter(|rms| rms.is_finite()).map_or_else(|| MISSING.into(), size);
            let largest = replay.residual.finite_pairs().map(|(_, y)| y.abs()).reduce(f64::max);
            let largest = largest.map_or_else(String::new, |largest| format!(", up to {}", size(largest)));
            let solid = Pen::new(replay.origin.style().colour).width(0.8);
            LayeredPanel {
                head: Some(format!("{}, rms {rms}{largest}", replay.origin.label())),
                layers: vec![Layer::line("", replay.residual.clone(), solid)],
                ..LayeredPanel::default()
            }
        };
        let residual = AxisSpec::new("residual [°]", TickRule::Angle).limited_about_zero(RESIDUAL_ROOM);
        let across = if self.replays.len() < 3 { 1 } else { 2 };
        let multiples = self.replays.iter().map(below).collect();
        let lower = PanelGroup::multiples(across, AxisSpec::time(), PanelRow::zeroed(residual, 0.085), multiples);
        let mut time = AxisSpec::time();
        let mut groups = vec![lower];
        if self.replays.is_empty() {
            groups.clear();
        } else {
            time.title.clear();
        }
        groups.insert(0, PanelGroup::over(time, vec![(PanelRow::new(AxisSpec::heading(), 0.28), upper)]));
        let note = (!self.replays.is_empty()).then(|| String::from("What leaves its panel is cut."));
        Panels { groups, note, ..Panels::default() }
    }
}

/// Estimate of K or T, with its interval if the method gives one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[schemars(rename = "PointEstimate")]
pub struct EstimateWithInterval {
    /// Estimate: of K in 1/s, of T in s.
    pub value: f64,
    /// 95 % interval, in the same unit.
    pub interval: Option<[f64; 2]>,
}

/// Estimates of one method; `None` if it gives none.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct MethodEstimate {
    /// Method, which determines the style of the row.
    pub origin: CurveOrigin,
    /// K, 1/s.
    pub k_per_s: Option<EstimateWithInterval>,
    /// T, s.
    pub t_s: Option<EstimateWithInterval>,
}

/// Reference values of K and T.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[schemars(rename = "Reference")]
pub struct ReferenceIndices {
    /// K, 1/s.
    pub k_per_s: f64,
    /// T, s.
    pub t_s: f64,
}

/// Estimates of K and T with their 95 % intervals, against the truth and the published value.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[schemars(rename = "Intervals")]
pub struct ConfidenceIntervals {
    /// Estimates, from top to bottom.
    pub estimates: Vec<MethodEstimate>,
    /// Parameters of the simulated trial.
    pub truth: Option<ReferenceIndices>,
    /// Published parameters.
    pub published: Option<ReferenceIndices>,
}

/// Half-width of the axis in multiples of the median distance from the truth; values beyond are outliers.
const SPREADS: f64 = 7.0;

impl ConfidenceIntervals {
    /// Rows: K and T side by side, one row per method.
    pub fn rows(&self) -> NamedRows {
        type Estimated = fn(&MethodEstimate) -> Option<EstimateWithInterval>;
        let column = |title: String, quantity: Estimated, reference: fn(&ReferenceIndices) -> f64| {
            let row = |estimate: &MethodEstimate| {
                let mark = |point: EstimateWithInterval| {
                    RowItem::new("", RowKind::Mark(estimate.origin.style(), point.value, point.interval))
                };
                quantity(estimate).map(mark).into_iter().collect()
            };
            let line = |origin: CurveOrigin, pair: Option<ReferenceIndices>| {
                pair.map(|pair| (origin.label().to_owned(), Pen::from_origin(&origin).width(0.8), reference(&pair)))
            };
            let truth = line(CurveOrigin::Truth, self.truth);
            let centre = truth.as_ref().map(|(.., value)| *value);
            RowsColumn {
                x: AxisSpec::decimal(title).limited_around(SPREADS, centre),
                rows: self.estimates.iter().map(row).collect(),
                vertical_lines: truth.into_iter().chain(line(CurveOrigin::Published, self.published)).collect(),
                ..RowsColumn::default()
            }
        };
        let lacks =
            |row: &&MethodEstimate| [row.k_per_s, row.t_s].iter().flatten().any(|point| point.interval.is_none());
        let lacks: Vec<&str> = self.estimates.iter().filter(lacks).map(|estimate| estimate.origin.label()).collect();
        let note = (!lacks.is_empty()).then(|| format!("No interval from {}.", lacks.join(", ")));
        NamedRows {
            names: self.estimates.iter().map(|estimate| estimate.origin.label().to_owned()).collect(),
            columns: vec![
                column(format!("{} [1/s]", symbol("K")), |estimate| estimate.k_per_s, |estimate| estimate.k_per_s),
                column(format!("{} [s]", symbol("T")), |estimate| estimate.t_s, |estimate| estimate.t_s),
            ],
            note,
            ..NamedRows::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use report::Theme;
    use report::figures::Plot;
    use report::palette::method_ids;

    use super::*;

    fn svg(plot: impl Into<Plot>) -> String {
        plot.into().draw("", &Theme::screen()).svg().to_owned()
    }

    fn wave(size: f64) -> PlotCurve {
        let x: Vec<f64> = (0..200).map(|k| 0.5 * f64::from(k)).collect();
        let y: Vec<f64> = x.iter().map(|x| size * (x / 20.0).sin()).collect();
        PlotCurve::new(x, y)
    }

    #[test]
    fn a_fit_and_its_derivatives_have_symbols_and_units() {
        let fit = FourierFitCurves {
            measured: wave(25.0),
            fitted: wave(25.0),
            residual: wave(0.1),
            r_squared: Some(f64::NAN),
            fundamental_rad_s: Some(0.05),
            ..FourierFitCurves::default()
        };
        let drawn = svg(fit.panels());
        assert!(drawn.contains("0.05000 rad/s") && drawn.contains("fitted curve") && !drawn.contains("NaN"));
        let origin = CurveOrigin::Truth;
        let [heading, yaw_rate, yaw_acceleration] = [25.0, 1.0, 0.1].map(wave);
        let motion = MotionCurves { origin, name: None, heading, yaw_rate, yaw_acceleration };
        assert!(svg(DerivativeCurves { curves: vec![motion] }.panels()).contains(" [°/s²]"));
    }

    #[test]
    fn every_replay_says_how_far_it_is_off_and_what_runs_off_is_cut() {
        let replay = |method: &str, size: f64| ReplayCurves {
            origin: CurveOrigin::Method(method.into()),
            heading: wave(25.0),
            residual: wave(25.0 * size),
            rms_deg: Some(size),
        };
        let mut replays: Vec<ReplayCurves> = method_ids().map(|id| replay(id, 0.02)).collect();
        replays[3].residual = wave(1000.0);
        let drawn = svg(Replays { record: wave(25.0), replays, ..Replays::default() }.panels());
        for (number, id) in method_ids().enumerate() {
            let size = if number == 3 { "1000" } else { "0.50" };
            assert!(drawn.contains(&format!("\n{id}, rms 0.020°, up to {size}°\n")), "{id}: {drawn}");
        }
        assert!(drawn.contains("What leaves its panel is cut.") && drawn.contains(" clip-path=\"url(#"));
        svg(Replays::default().panels());
    }

    #[test]
    fn what_lies_beyond_an_axis_and_what_is_missing_is_said() {
        let point = |value: f64| Some(EstimateWithInterval { value, interval: Some([value - 0.01, value + 0.01]) });
        let estimate = |(number, id): (usize, &str)| MethodEstimate {
            origin: CurveOrigin::Method(id.to_owned()),
            k_per_s: point(if number == 7 { 0.4 } else { 0.1 + 0.001 * number as f64 }),
            t_s: None,
        };
        let truth = Some(ReferenceIndices { k_per_s: 0.1, t_s: 16.0 });
        let estimates = method_ids().enumerate().map(estimate).collect();
        let drawn = svg(ConfidenceIntervals { estimates, truth, ..ConfidenceIntervals::default() }.rows());
        assert!(drawn.contains("<tspan font-style=\"italic\">K</tspan> [1/s]") && drawn.contains("no estimate"));
        assert!(drawn.contains("Error bars: 95 % intervals") && drawn.contains("Arrows: beyond the axis."));
    }
}
