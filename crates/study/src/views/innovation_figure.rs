//! Check of model and noise on a record: a normal Q–Q plot of the innovations of its headings with the pointwise 95 %
//! band of normal numbers, and their autocorrelation with the test of whiteness.

use ::trace::SIGNIFICANCE_LEVEL;
use estimation::residuals::{GappedSeries, autocorrelation, whiteness_lags, whiteness_test};
use estimation::statistics::upper_median;
use report::figures::{AxisSpec, Layer, LayerKind, PanelGroup, PanelRow, Panels, Pen};
use report::number::significant;
use report::palette::{CurveStyle, DASHED, HEADING, INK, Marker, RECORD, SOLID};
use report::{PageFigure, PlotCurve};
use statrs::distribution::{Beta, ContinuousCDF, Normal};

/// Minimum number of innovations for the figure.
const MIN_INNOVATIONS: usize = 8;

/// Maximum number of ranks between the ends at which the band is plotted.
const MAX_DRAWN_RANKS: usize = 150;

/// Number of ranks at either end that are all plotted.
const END_RANKS: usize = 20;

/// Distribution of the i-th smallest of n uniform numbers (David and Nagaraja 2003, 2.1).
fn ordered(rank: usize, count: usize) -> Beta {
    Beta::new(rank as f64, (count + 1 - rank) as f64).expect("a rank is from 1 to the count")
}

/// Quantile of the i-th smallest of n standard normal numbers.
fn order_quantile(rank: usize, count: usize, probability: f64) -> f64 {
    Normal::standard().inverse_cdf(ordered(rank, count).inverse_cdf(probability))
}

/// Expected value of the i-th smallest of n standard normal numbers (Blom 1958).
fn expected(rank: usize, count: usize) -> f64 {
    Normal::standard().inverse_cdf((rank as f64 - 0.375) / (count as f64 + 0.25))
}

/// Ranks of a normal plot that are drawn: all near both ends, and an even selection between them; ascending.
fn ranks(count: usize) -> Vec<usize> {
    let step = count.div_ceil(MAX_DRAWN_RANKS);
    (1..=count).filter(|rank| *rank <= END_RANKS || *rank + END_RANKS > count || rank % step == 0).collect()
}

/// Figure of the innovations of a record at times (s), in standard deviations of the estimated noise; `None` for fewer
/// than eight.
pub fn innovation_figure(stem: String, name: &str, [time, values]: &[Vec<f64>; 2]) -> Option<PageFigure> {
    let spacing = upper_median(time.windows(2).map(|pair| pair[1] - pair[0])).unwrap_or_default();
    let mut sorted: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    if time.len() != values.len() || sorted.len() < MIN_INNOVATIONS || spacing <= 0.0 {
        return None;
    }
    sorted.sort_by(f64::total_cmp);
    let series = GappedSeries::new(time, values, spacing);
    let p_value = whiteness_test(std::slice::from_ref(&series)).p_value;
    let judged = match p_value < SIGNIFICANCE_LEVEL {
        true => format!("innovations are not white, p < {SIGNIFICANCE_LEVEL}"),
        false => format!("innovations, p = {} if they are white", significant(p_value, 2)),
    };
    let title = format!("{name}: {judged} (Ljung–Box, {} lags)", whiteness_lags(sorted.len()));
    let caption = format!(
        "{name}: innovations (one-step prediction errors) over the standard deviation of the noise. Left: innovations that \
         are normal and as large as the estimated noise lie on the line, each inside the band with a probability of 95 %. \
         Right: their autocorrelation; 95 % of that of white innovations lies between the dashed lines.",
    );
    let groups = vec![quantiles(&sorted), correlation(&series)];
    Some(PageFigure::new(stem, title, caption, Panels { groups, ..Panels::default() }))
}

/// Q–Q plot: sorted innovations over the expected values of sorted standard normal numbers, with their pointwise 95 %
/// band.
fn quantiles(sorted: &[f64]) -> PanelGroup {
    let count = sorted.len();
    let outside = (1..=count)
        .filter(|&rank| !(0.025..=0.975).contains(&ordered(rank, count).cdf(Normal::standard().cdf(sorted[rank - 1]))))
        .count();
    let ranks = ranks(count);
    let across: Vec<f64> = ranks.iter().map(|&rank| expected(rank, count)).collect();
    let over = |y: Vec<f64>| PlotCurve::new(across.clone(), y);
    let end = |probability| over(ranks.iter().map(|&rank| order_quantile(rank, count, probability)).collect());
    let dots = LayerKind::Dots(HEADING);
    let layers = vec![
        Layer::band("95 % band, point by point", [end(0.025), end(0.975)], RECORD, 0.3),
        Layer::line("normal, as large as the noise", over(across.clone()), Pen { dash: DASHED, ..Pen::new(INK) }),
        Layer::new("innovations", over(ranks.iter().map(|&rank| sorted[rank - 1]).collect()), dots),
    ];
    let row = PanelRow::zeroed(AxisSpec::decimal("innovation [sd]"), 0.32);
    let mut group = PanelGroup::over(AxisSpec::decimal("normal quantile [sd]"), vec![(row, layers)]);
    (group.is_half, group.has_zero_line) = (true, true);
    group.panels[0].head = Some(format!("{outside} of {count} outside the band"));
    group
}

/// Autocorrelation, with the limits that contain 95 % of that of white noise.
fn correlation(series: &GappedSeries) -> PanelGroup {
    let count = series.values.len();
    let points = autocorrelation(series, whiteness_lags(count));
    let bound = 1.96 / (count as f64).sqrt();
    let outside = points.iter().filter(|lag| lag.coefficient.abs() > bound).count();
    let style = CurveStyle { colour: HEADING, marker: Marker::Circle, dash: SOLID, is_hollow: false };
    let places = points.iter().map(|lag| (lag.lag as f64 * series.spacing, lag.coefficient, None)).collect();
    let row =
        PanelRow { dashed_levels: vec![-bound, bound], ..PanelRow::zeroed(AxisSpec::decimal("autocorrelation"), 0.32) };
    let thin = Pen::new(HEADING).width(0.6);
    let mut group = PanelGroup::over(
        AxisSpec::decimal("lag [s]"),
        vec![(row, vec![Layer::marks("", style, places).with_line(thin)])],
    );
    group.is_half = true;
    group.panels[0].head = Some(format!("{outside} of {} lags outside ±1.96/√n", points.len()));
    group
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A single number has the quantiles of a normal; the smallest of n is above x if all are: (1 − Φ)ⁿ.
    #[test]
    fn the_band_is_that_of_order_statistics() {
        assert!((order_quantile(1, 1, 0.975) - 1.959_964).abs() < 1e-5);
        let smallest = order_quantile(1, 50, 0.025);
        let above = Normal::standard().sf(smallest).powi(50);
        assert!((above - 0.975).abs() < 1e-6, "{above}");
        assert!((order_quantile(50, 50, 0.975) + smallest).abs() < 1e-6, "the largest mirrors it");
    }

    fn groups(values: &[f64]) -> (String, Vec<PanelGroup>) {
        let time = (0..values.len()).map(|row| 0.5 * row as f64).collect();
        let figure = innovation_figure("innovations".into(), "run", &[time, values.to_vec()]).expect("many");
        let report::figures::Plot::Panels(panels) = figure.plot else { panic!("panels") };
        (figure.finding, panels.groups)
    }

    #[test]
    fn normal_white_numbers_lie_inside_and_others_do_not() {
        let count = 101;
        // The quantiles themselves, in an order without a pattern.
        let normal: Vec<f64> = (0..count).map(|row| expected(1 + row * 37 % count, count)).collect();
        let (title, good) = groups(&normal);
        assert_eq!(good[0].panels[0].head.as_deref(), Some("0 of 101 outside the band"), "{title}");
        let twice: Vec<f64> = normal.iter().map(|value| 2.0 * value).collect();
        let head = groups(&twice).1[0].panels[0].head.clone().unwrap_or_default();
        let outside: usize = head.split(' ').next().and_then(|count| count.parse().ok()).expect("a number");
        assert!(outside > 50, "{head}");
        let mut slow = normal.clone();
        slow.sort_by(f64::total_cmp);
        let (title, coloured) = groups(&slow);
        assert_eq!(title, "run: innovations are not white, p < 0.0001 (Ljung–Box, 20 lags)");
        assert_eq!(coloured[1].panels[0].head.as_deref(), Some("20 of 20 lags outside ±1.96/√n"));
    }

    #[test]
    fn few_numbers_are_not_judged() {
        assert!(innovation_figure(String::new(), "run", &[vec![0.0, 1.0], vec![0.1, 0.2]]).is_none());
        assert!(ranks(5000).len() < 200 && ranks(9).len() == 9);
    }
}
