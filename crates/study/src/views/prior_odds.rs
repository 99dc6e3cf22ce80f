//! Sensitivity of the probabilities of effects to their prior odds.

use document::names;
use document::trace::{CandidateOutcome, TraceDocument};
use report::PageFigure;
use report::figures::{AxisSpec, Layer, PanelGroup, PanelRow, Panels, Pen, TickRule};
use report::number::{fixed, significant};
use report::palette::{
    CurveStyle, DASHED, DIMENSION_LINE, HEADING, INK, MODEL_BEFORE, Marker, RECORD, RGBColor, RUDDER, SOLID,
};

/// Minimum probability, at some odds, at which an unnamed effect is plotted.
const MIN_DRAWN_PROBABILITY: f64 = 0.05;

/// Maximum number of lines of the figure.
const MAX_LINES: usize = 8;

/// Minimum change of a probability that is reported.
const MIN_CHANGE: f64 = 0.1;

const COLOURS: [RGBColor; 6] = [HEADING, RUDDER, DIMENSION_LINE, MODEL_BEFORE, INK, RECORD];
const MARKERS: [Marker; 4] = [Marker::Circle, Marker::Square, Marker::Diamond, Marker::Up];

/// Effect, or group that the records cannot separate, with its probability for every factor of the prior odds.
struct OddsLine<'a> {
    name: String,
    is_named: bool,
    probability: &'a [f64],
}

impl OddsLine<'_> {
    fn ends(&self) -> [f64; 2] {
        let fold = |by: fn(f64, f64) -> f64| self.probability.iter().copied().reduce(by).unwrap_or(f64::NAN);
        [fold(f64::min), fold(f64::max)]
    }

    fn change(&self) -> f64 {
        let [lowest, highest] = self.ends();
        highest - lowest
    }
}

/// Named effects, then other possible ones, the most probable first.
fn lines(document: &TraceDocument) -> Vec<OddsLine<'_>> {
    let trace = &document.trace;
    let is_whole = |probability: &[f64]| !probability.is_empty() && probability.len() == trace.prior.odds_factors.len();
    let named = trace.effects.iter().filter(|effect| is_whole(&effect.probability_by_prior_odds)).map(|effect| {
        let group = [&effect.id].into_iter().chain(&effect.aliases).map(|id| names::effect_name(id));
        let only = effect.only.as_ref().map_or_else(String::new, |only| format!(", in {}", names::record_name(only)));
        let name = group.collect::<Vec<_>>().join(" or ") + &only;
        OddsLine { name, is_named: true, probability: &effect.probability_by_prior_odds }
    });
    let is_other = |outcome| matches!(outcome, CandidateOutcome::Rejected | CandidateOutcome::NotObservable);
    let unnamed = trace.candidates.iter().filter(|candidate| is_other(candidate.outcome));
    let unnamed = unnamed.filter(|candidate| is_whole(&candidate.probability_by_prior_odds));
    let unnamed = unnamed.map(|candidate| OddsLine {
        name: names::effect_name(&candidate.id),
        is_named: false,
        probability: &candidate.probability_by_prior_odds,
    });
    let mut unnamed: Vec<OddsLine> = unnamed.filter(|line| line.ends()[1] >= MIN_DRAWN_PROBABILITY).collect();
    unnamed.sort_by(|first, second| second.ends()[1].total_cmp(&first.ends()[1]));
    let mut lines: Vec<OddsLine> = named.chain(unnamed).collect();
    lines.truncate(MAX_LINES);
    lines
}

/// Finding: the names that depend on the odds and those that do not, with numbers.
fn finding(lines: &[OddsLine], named_from: f64) -> String {
    let joined = |lines: &[&OddsLine]| lines.iter().map(|line| line.name.as_str()).collect::<Vec<_>>().join(", ");
    let lowest = |line: &OddsLine| line.ends()[0];
    let (named, unnamed): (Vec<&OddsLine>, Vec<&OddsLine>) = lines.iter().partition(|line| line.is_named);
    let (safe, weak): (Vec<&OddsLine>, Vec<&OddsLine>) = named.into_iter().partition(|line| lowest(line) >= named_from);
    let mut parts = Vec::new();
    if !safe.is_empty() {
        // Rounded down, so that no probability is below the stated one.
        let least = (1e3 * safe.iter().map(|line| lowest(line)).fold(1.0, f64::min)).floor() / 1e3;
        parts.push(format!("{} at {} or more", joined(&safe), fixed(least, 3)));
    }
    let moves = |line: &OddsLine| {
        let [lowest, highest] = line.ends().map(|end| fixed(end, 2));
        format!("{} from {lowest} to {highest}", line.name)
    };
    parts.extend(weak.iter().map(|line| moves(line)));
    let most = unnamed.into_iter().max_by(|first, second| first.change().total_cmp(&second.change()));
    match most {
        Some(line) if line.change() >= MIN_CHANGE => parts.push(moves(line)),
        Some(line) => parts.push(format!("no other above {}", fixed((1e2 * line.ends()[1]).ceil() / 1e2, 2))),
        None => parts.push(format!("no other above {}", fixed(MIN_DRAWN_PROBABILITY, 2))),
    }
    parts.join("; ")
}

/// Sentence on the named effects that would not be named at lower odds; `None` if there are none.
pub fn prior_odds_sentence(document: &TraceDocument) -> Option<String> {
    let prior = &document.trace.prior;
    unnamed_below(&lines(document), *prior.odds_factors.first()?, prior.min_named_probability)
}

/// Sentence for the smallest factor of the odds.
fn unnamed_below(lines: &[OddsLine], least: f64, named_from: f64) -> Option<String> {
    let fallen = lines.iter().filter(|line| line.is_named && line.probability[0] < named_from);
    let fallen: Vec<String> = fallen.map(|line| format!("{} ({})", line.name, fixed(line.probability[0], 2))).collect();
    (!fallen.is_empty()).then(|| {
        format!(
            "With {} times the prior odds these effects would fall below a probability of {} and not be named: {}.",
            significant(least, 1),
            significant(named_from, 2),
            fallen.join(", ")
        )
    })
}

/// Figure of the probabilities over the factor of the odds; `None` if the document does not hold them.
pub fn prior_odds_figure(document: &TraceDocument) -> Option<PageFigure> {
    let prior = &document.trace.prior;
    let lines = lines(document);
    let [least, .., most] = prior.odds_factors[..] else { return None };
    let layer = |(number, line): (usize, &OddsLine)| {
        let colour = COLOURS[number % COLOURS.len()];
        let dash = if line.is_named { SOLID } else { DASHED };
        let style = CurveStyle { colour, marker: MARKERS[number % MARKERS.len()], dash, is_hollow: !line.is_named };
        let points = prior.odds_factors.iter().zip(line.probability).map(|(x, y)| (*x, *y, None)).collect();
        Layer::marks(line.name.as_str(), style, points).with_line(Pen { dash, ..Pen::new(colour) })
    };
    let layers = lines.iter().enumerate().map(layer).collect();
    let row = PanelRow {
        dashed_levels: vec![prior.min_named_probability],
        ..PanelRow::zeroed(AxisSpec::decimal("probability"), 0.32)
    };
    let x = AxisSpec::new("prior odds of every effect, times", TickRule::Logarithmic);
    let [least, most] = [least, most].map(|factor| significant(factor, 1));
    let caption = format!(
        "Probability of every effect if the prior odds of all effects are {least} to {most} times the usual. Solid: named. \
         Dashed level: the probability from which an effect is named. Structures that the search did not fit are left out."
    );
    let finding = format!("Prior odds × {least} to × {most}: {}", finding(&lines, prior.min_named_probability));
    let plot = Panels::new(PanelGroup::over(x, vec![(row, layers)]));
    (!lines.is_empty()).then(|| PageFigure::new("prior-odds", finding, caption, plot))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_do_not_move_are_safe() {
        let line = |name: &str, is_named, probability| OddsLine { name: name.into(), is_named, probability };
        let lines = [
            line("sway", true, &[0.972_9, 0.99, 1.0]),
            line("damping", true, &[0.98, 1.0, 1.0]),
            line("speed loss", true, &[0.7, 0.96, 0.99]),
            line("lag", false, &[0.1, 0.4, 0.8]),
            line("dead band", false, &[0.0, 0.0, 0.06]),
        ];
        let expected = "sway, damping at 0.972 or more; speed loss from 0.70 to 0.99; lag from 0.10 to 0.80";
        assert_eq!(finding(&lines, 0.95), expected);
        assert_eq!(finding(&lines[..1], 0.95), "sway at 0.972 or more; no other above 0.05");
        assert_eq!(finding(&lines[4..], 0.95), "no other above 0.06");
        let expected = "With 0.1 times the prior odds these effects would fall below a probability of 0.95 and not be \
            named: speed loss (0.70).";
        assert_eq!(unnamed_below(&lines, 0.1, 0.95).as_deref(), Some(expected));
        assert_eq!(unnamed_below(&lines[..2], 0.1, 0.95), None);
    }
}
