//! The page and the table of measured trials beside their predictions.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use campaign::statistics::{Statistic, share};
use report::number::{MISSING, fixed, interval, significant, supported};
use report::{Page, Table, TableHead, Theme};

use super::charts;
use super::figure::{FigureKind, ForecastFigure, ForecastGroup, ForecastScore, KINDS};
use super::forecast::Forecasts;
use crate::measured::sets::Outcome;

const INTRODUCTION: &str = "A ship is traced from some trials, and what she does in her other trials is predicted. Nothing \
is fitted to the trials that are predicted. Every figure of every trial stands beside its 90 % interval in \
[predicted.csv](predicted.csv), a row each. KVLCC2 goes from the 7 m model of HSVA to the full-scale values of MARIN by \
Froude; Esso Osaka from one rate of her propeller to another, and with it to another approach speed. The hulls of the trace \
take the particulars of the sidecars; trials whose wind was measured are predicted in their mean wind. [METHODOLOGY](../../../METHODOLOGY.md) says what was looked at when hulls were \
fitted: these records are not blind for it. Where the records come from says [the \
book](../../../docs/src/howto/public-trials.md). Made by";

const COMMAND: &str = "```sh\ncargo run --release -p kempf-tests --bin predicted -- results/published/predicted\n```";

const SCORES: &str = "*n*: figures (a trial has several, and every model predicts all of them, so they are not \
independent). *error*: median of |predicted − measured|. *held*: share inside the 90 % interval, with the 95 % interval \
of Wilson. *width*: median width of the 90 % interval. Times, lengths, speeds and yaw rates in per cent of what was \
measured.";

/// The figures that satisfy a condition.
fn those(figures: &[ForecastFigure], wanted: impl Fn(&ForecastFigure) -> bool) -> Vec<&ForecastFigure> {
    figures.iter().filter(|own| wanted(own)).collect()
}

fn cells(group: &str, kind: &str, unit: &str, score: &ForecastScore) -> Vec<String> {
    let size =
        |value: f64| if unit.is_empty() { MISSING.to_owned() } else { format!("{} {unit}", significant(value, 2)) };
    vec![
        group.to_owned(),
        kind.to_owned(),
        score.count.to_string(),
        size(score.error),
        format!("{} {}", supported(score.held.value, score.held.ci95), interval(score.held.ci95)),
        size(score.width),
    ]
}

/// The table of the page: groups and kinds of figure, and all kinds of a group together.
fn scores(figures: &[ForecastFigure]) -> Table {
    let head = TableHead::default().texts(["what from what", "figure"]);
    let mut table = Table::new(head.counts(["n", "error", "held [%]", "width"]));
    let judged = those(figures, |own| own.kind().is_some());
    let whole =
        |words: &str, own: &[&ForecastFigure]| ForecastScore::of(own).map(|score| cells(words, "all", "", &score));
    whole("all together", &judged).into_iter().for_each(|row| table.push(row));
    for group in ForecastGroup::ALL {
        let own: Vec<&ForecastFigure> = judged.iter().copied().filter(|own| own.group == group).collect();
        whole(group.words(), &own).into_iter().for_each(|row| table.push(row));
        for kind in KINDS {
            let of: Vec<&ForecastFigure> = own.iter().copied().filter(|own| own.kind() == Some(kind)).collect();
            if let Some(score) = ForecastScore::of(&of) {
                table.push(cells("", kind.words, kind.unit(), &score));
            }
        }
    }
    table
}

/// What was to be reached, and what is.
fn reached(figures: &[ForecastFigure]) -> Table {
    let mut table = Table::new(TableHead::default().texts(["to reach", "reached", "met"]));
    let mut row = |what: &str, is: String, met: bool| {
        table.push([what.to_owned(), is, String::from(if met { "yes" } else { "no" })]);
    };
    for (kind, limit) in [("advance", 2.0), ("tactical diameter", 3.0)] {
        let errors = |group: ForecastGroup| -> Vec<f64> {
            let is_wanted =
                |own: &ForecastFigure| own.group == group && own.kind().is_some_and(|own| own.words == kind);
            those(figures, is_wanted).into_iter().map(ForecastFigure::error).collect()
        };
        let (together, single) = (errors(ForecastGroup::MarinOfAll), errors(ForecastGroup::MarinOfOne));
        let within = single.iter().filter(|error| error.abs() <= limit).count();
        let shown = together.iter().map(|error| format!("{} %", signed(*error))).collect::<Vec<_>>().join(", ");
        let is = format!("{shown} from all eight together; within it from {within} of {} alone", single.len());
        let met = !together.is_empty() && together.iter().all(|error| error.abs() <= limit);
        row(&format!("{kind} of MARIN's circle within {} %, from HSVA's zig-zags", fixed(limit, 0)), is, met);
    }
    let is_overshoot = |own: &&ForecastFigure| own.name.ends_with("overshoot_deg");
    let of = |group: ForecastGroup| -> Vec<&ForecastFigure> {
        figures.iter().filter(|own| own.group == group).filter(is_overshoot).collect()
    };
    let within = |group: ForecastGroup| of(group).iter().filter(|own| own.error().abs() <= 1.5).count();
    let [together, alone] = [ForecastGroup::MarinOfAll, ForecastGroup::MarinOfOne];
    let (count, single) = (of(together).len(), of(alone).len());
    let is = format!("{} of {count} from all eight; {} of {single} from one", within(together), within(alone));
    row("MARIN's overshoots within 1.5°, six of seven", is, within(together) >= 6);
    if let Some(score) = ForecastScore::of(&those(figures, |own| own.kind().is_some())) {
        let met = (85.0..=95.0).contains(&score.held.value);
        row("90 % intervals hold 85 to 95 % of all figures", in_per_cent(Some(score.held)), met);
    }
    let is_steady = |own: &ForecastFigure| own.group == ForecastGroup::EssoOsaka && own.name == "steady_rate_deg_s";
    let rates = those(figures, is_steady);
    let within: Vec<&&ForecastFigure> = rates.iter().filter(|own| own.error().abs() <= 10.0).collect();
    let circles: BTreeSet<&str> = rates.iter().map(|own| own.trial).collect();
    let models: BTreeSet<&str> = rates.iter().map(|own| own.fitted.as_str()).collect();
    let counts = format!("{} circles, models of {} zig-zags", circles.len(), models.len());
    let is = format!("{} of {} ({counts})", within.len(), rates.len());
    row("steady rates of Esso Osaka's circles within 10 %", is, within.len() == rates.len());
    table
}

fn signed(value: f64) -> String {
    format!("{}{}", if value < 0.0 { "−" } else { "+" }, fixed(value.abs(), 1))
}

fn in_per_cent(share: Option<Statistic>) -> String {
    share.map_or_else(
        || MISSING.to_owned(),
        |own| format!("{} % {}", supported(own.value, own.ci95), interval(own.ci95)),
    )
}

/// Every figure, a row each.
fn rows(figures: &[ForecastFigure]) -> Table {
    let head = TableHead::default().texts(["what from what", "fitted", "trial", "figure"]);
    let head = head.numbers(["measured", "median", "lower 90", "upper 90"]).texts(["held"]);
    let mut table = Table::new(head.numbers(["width over value"]).texts(["judged as"]));
    for own in figures {
        let [low, high] = own.compared.interval.ci90;
        let number = |value: f64| significant(value, 5);
        table.push([
            own.group.words().to_owned(),
            own.fitted.clone(),
            own.trial.to_owned(),
            own.name.clone(),
            number(own.compared.measured),
            number(own.compared.interval.median),
            number(low),
            number(high),
            String::from(if own.compared.inside90 { "yes" } else { "no" }),
            significant(own.relative_width(), 3),
            own.kind().map_or_else(String::new, |kind: FigureKind| kind.words.to_owned()),
        ]);
    }
    table
}

/// The headline of the page: what the intervals hold, and of how many trials.
fn headline(figures: &[ForecastFigure]) -> String {
    let judged = those(figures, |own| own.kind().is_some());
    let held = judged.iter().filter(|own| own.compared.inside90).count();
    let trials: BTreeSet<&str> = judged.iter().map(|own| own.trial).collect();
    let held = share(held as u64, judged.len() as u64).map(|own| own.times(100.0));
    format!(
        "**90 % intervals hold {} of {} figures of {} measured trials.**",
        in_per_cent(held),
        judged.len(),
        trials.len()
    )
}

/// Writes `README.md`, `predicted.csv` and the figures.
///
/// Fails where a file cannot be written.
pub fn write(forecasts: &Forecasts, results: &Path) -> Outcome<()> {
    let Forecasts { figures, tracks, steady } = forecasts;
    let mut page = Page::titled("Predictions held against measured trials");
    page.say(headline(figures));
    page.table(reached(figures));
    page.figures([charts::overshoots(figures)]);
    page.figures(tracks.iter().enumerate().map(|(number, track)| charts::track(number, track)));
    page.figures([charts::steady(steady), charts::rates(steady), charts::coverage(figures)]);
    page.part("How well, figure by figure");
    page.say(SCORES);
    page.table(scores(figures));
    page.part("How it was made");
    page.say(INTRODUCTION);
    page.say(COMMAND);
    fs::create_dir_all(results)?;
    for figure in page.drawings() {
        fs::write(results.join(format!("{}.png", figure.stem)), figure.plot.draw(&Theme::screen()).png()?)?;
    }
    fs::write(results.join("README.md"), page.to_markdown())?;
    fs::write(results.join("predicted.csv"), rows(figures).to_csv())?;
    Ok(())
}
