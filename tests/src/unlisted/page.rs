//! The page of the study and its table of trials.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use campaign::statistics::share;
use document::trace::LocatedEntry;
use report::number::{MISSING, fixed, significant};
use report::{PageFigure, Table, TableHead};
use ship::angle::to_deg;

use super::chart;
use super::judged::{Answer, Judgement, NEAR, NEAR_PERIOD, Named};
use super::truths::{Kind, Times, Truth};
use super::{NOISES_DEG, Outcome, REPLICATES};

/// The command that makes the page.
pub const COMMAND: &str = "cargo run --release -p kempf-tests --bin unlisted -- results/published/unlisted";

/// The page.
pub fn markdown(truths: &[Truth], outcomes: &[Outcome]) -> String {
    let PageFigure { stem, caption, .. } = chart::outcomes(truths, outcomes);
    let figure = format!("![Figure 1]({stem}.png)\n\n{}", wrapped(&format!("*Figure 1. {caption}*")));
    let mut page = format!("{HEAD}\n\n{}\n\n{figure}\n\n{}\n", finding(truths, outcomes), how());
    for (group, columns, text) in [
        (Group::Listed, &LISTED[..], TEXT_LISTED),
        (Group::Unlisted, &UNLISTED[..], TEXT_UNLISTED),
        (Group::Nothing, &NOTHING[..], TEXT_NOTHING),
    ] {
        let table = table(truths, outcomes, group, columns);
        let _ = write!(page, "\n## {}\n\n{}\n\n{}", group.title(), wrapped(text), table.to_markdown());
    }
    let _ = write!(page, "\n## The truths\n\n{}", equations(truths).to_markdown());
    page
}

/// A line for every trial.
pub fn csv(truths: &[Truth], outcomes: &[Outcome]) -> String {
    let head = TableHead::default().texts(["truth", "group"]).numbers(["noise"]).unit("deg").counts(["trial"]);
    let head = head.numbers(["likelihood ratio"]).texts(["judgement", "verdict", "named", "aliases"]);
    let head = head.texts(["times"]).unit("s").texts(["depends on", "form", "nats"]).texts(["from", "until"]).unit("s");
    let mut table = Table::new(head.numbers(["moment", "heading before", "heading after"]).unit("deg"));
    for outcome in outcomes {
        let answer = outcome.answer.as_ref();
        let text = |of: &dyn Fn(&Named) -> String| {
            let all = answer.map_or(&[][..], |answer| &answer.named);
            all.iter().map(of).collect::<Vec<_>>().join("; ")
        };
        let shape = |of: &dyn Fn(&LocatedEntry) -> String| {
            let all = answer.map_or(&[][..], |answer| &answer.located);
            all.iter().map(of).collect::<Vec<_>>().join("; ")
        };
        let time = |time: Option<f64>| time.map_or_else(String::new, |time| fixed(time, 1));
        let heading = |side: usize| answer.map_or(f64::NAN, |answer| to_deg(answer.heading[side]));
        table.push([
            truths[outcome.ship].name.to_owned(),
            Group::of(&truths[outcome.ship]).title().to_owned(),
            outcome.noise_deg.to_string(),
            outcome.replicate.to_string(),
            fixed(outcome.ratio, 1),
            outcome.judgement.as_str().to_owned(),
            answer.map_or_else(String::new, |answer| answer.verdict.to_string()),
            text(&label),
            text(&|named| named.aliases.join("|")),
            text(&|named| time(named.time)),
            shape(&|entry| entry.depends_on.to_string()),
            shape(&|entry| entry.form.clone()),
            shape(&|entry| fixed(entry.nats, 1)),
            shape(&|entry| time(entry.from_s)),
            shape(&|entry| time(entry.until_s)),
            answer.and_then(|answer| answer.disturbance_deg).map_or_else(String::new, |own| significant(own, 3)),
            significant(heading(0), 4),
            significant(heading(1), 4),
        ]);
    }
    table.to_csv()
}

const HEAD: &str = "# Truths on no list

**What does a trace say when the truth is the same physics in another formula, or something that is on no list?**";

/// The groups of the page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Group {
    Listed,
    Unlisted,
    Nothing,
}

impl Group {
    fn of(truth: &Truth) -> Self {
        match truth.kind {
            Kind::Listed { .. } => Self::Listed,
            Kind::Unlisted { .. } => Self::Unlisted,
            Kind::Nothing { .. } => Self::Nothing,
        }
    }

    fn title(self) -> &'static str {
        match self {
            Self::Listed => "Other formulas",
            Self::Unlisted => "On no list",
            Self::Nothing => "Nothing missing",
        }
    }
}

/// The judgement that a column of a table counts.
type Counted = (&'static str, Judgement);

const LISTED: [Counted; 7] = [
    ("right", Judgement::Right),
    ("alias", Judgement::Alias),
    ("wrong", Judgement::Wrong),
    ("located instead", Judgement::Elsewhere),
    ("unexplained", Judgement::Unexplained),
    ("disturbed", Judgement::Disturbed),
    ("clean", Judgement::Clean),
];

const UNLISTED: [Counted; 7] = [
    ("located", Judgement::Located),
    ("unexplained", Judgement::Unexplained),
    ("alias", Judgement::Alias),
    ("wrong", Judgement::Wrong),
    ("elsewhere", Judgement::Elsewhere),
    ("disturbed", Judgement::Disturbed),
    ("clean", Judgement::Clean),
];

const NOTHING: [Counted; 4] = [
    ("clean", Judgement::Clean),
    ("disturbed", Judgement::Disturbed),
    ("unexplained", Judgement::Unexplained),
    ("wrong", Judgement::Wrong),
];

const TEXT_LISTED: &str = "*Right*: the group of the truth was named and no other; *alias*: the trace says that it \
    cannot tell what it named or located from the group of the truth, or what it named counts as such; *wrong*: \
    another name, alone or beside the right one; *located instead*: no name, but a moment that depends on something; \
    *unexplained*, *disturbed* and *clean*: neither a name nor a located moment, under that verdict; *and more*: \
    right, with a moment located beside the name.";

const TEXT_UNLISTED: &str = "*Right* is *located* or *unexplained*. *Located*: a moment with the dependence of the \
    truth, and near a change or with a period where the truth has one; or nothing but names of effects of time, all \
    near a change; *unexplained*: called so, with neither a name nor a located moment; *alias*: an effect of the ship \
    that the trace cannot tell from one of time; *wrong*: an effect of the ship, whatever is located beside it; \
    *elsewhere*: a moment with another dependence or at another time, or an effect of time away from every change; \
    *disturbed*: nothing but a random moment, which is not right; *clean*: nothing; *and more*: located, with another \
    moment beside it that is not right. The list of effects has a moment that stays and a moment for a while, with \
    smooth edges: of them a name near a change is as good as a located moment.";

const TEXT_NOTHING: &str = "*Right* is *clean*, and *disturbed* where chance turns the ship or its recorded rudder; \
    *wrong*: a name or a located moment.";

/// What came out, in counts.
fn finding(truths: &[Truth], outcomes: &[Outcome]) -> String {
    let counted = |group: Group, judgements: &[Judgement]| {
        let of: Vec<_> = outcomes.iter().filter(|outcome| Group::of(&truths[outcome.ship]) == group).collect();
        let count = of.iter().filter(|outcome| judgements.contains(&outcome.judgement)).count();
        with_interval(count, of.len())
    };
    use Judgement::{Alias, Clean, Disturbed, Elsewhere, Located, Right, Unexplained, Wrong};
    let sentences = [
        format!(
            "Listed physics in another formula is named by its group in {}, as an alias in {}, by a wrong name in {}, \
             and not at all in {}.",
            counted(Group::Listed, &[Right]),
            counted(Group::Listed, &[Alias]),
            counted(Group::Listed, &[Wrong]),
            counted(Group::Listed, &[Elsewhere, Unexplained, Disturbed, Clean]),
        ),
        format!(
            "What is on no list is located by what it depends on, and when, in {}, and called unexplained in {}; an \
             effect of the ship is named in {}, and one that cannot be told from an effect of time in {}; another \
             dependence or time is given in {}; nothing but a random moment in {}; it is called clean in {}.",
            counted(Group::Unlisted, &[Located]),
            counted(Group::Unlisted, &[Unexplained]),
            counted(Group::Unlisted, &[Wrong]),
            counted(Group::Unlisted, &[Alias]),
            counted(Group::Unlisted, &[Elsewhere]),
            counted(Group::Unlisted, &[Disturbed]),
            counted(Group::Unlisted, &[Clean]),
        ),
        hardly_right(truths, outcomes),
        format!("Where nothing is missing, something is named or located in {}.", counted(Group::Nothing, &[Wrong])),
    ];
    let failed = outcomes.iter().filter(|outcome| outcome.judgement == Judgement::Failed).count();
    let failed = if failed > 0 { format!(" {failed} trials have no trace.") } else { String::new() };
    wrapped(&(sentences.join(" ") + &failed))
}

/// The ships on no list of which a trace is right in no more than half of the trials.
fn hardly_right(truths: &[Truth], outcomes: &[Outcome]) -> String {
    let is_right = |outcome: &&Outcome| outcome.judgement.is_right(&truths[outcome.ship].kind);
    let cells = outcomes.chunk_by(|one, other| one.ship == other.ship);
    let cells = cells.filter(|cell| Group::of(&truths[cell[0].ship]) == Group::Unlisted);
    let names = cells.filter_map(|cell| {
        let count = cell.iter().filter(is_right).count();
        (2 * count <= cell.len()).then(|| format!("{} ({count} of {})", truths[cell[0].ship].name, cell.len()))
    });
    let names: Vec<String> = names.collect();
    let names = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
    format!("Right there in no more than half of the trials: {names}.")
}

/// How records are made and judged.
fn how() -> String {
    let made = "Shares have Wilson's intervals, 95 %: of the noise, not of the choice of truths. Made by";
    let records = format!(
        "Every ship has K = 0.1 1/s, T = 16.3 s and a rudder bias of 0.5 deg, and one thing more, whose equation \
         stands below; it is integrated by code of its own, that no trace can reach. It is steered through a zig-zag \
         10/10 (another where its equation says so) on the compass that is recorded, with a rudder of 2.5 deg/s, 300 \
         rows of 1 s, and traced with the usual settings. *Likelihood ratio*: twice the logarithm of that of the truth \
         against the nearest first-order response, on average over the noise. *Before* and *after*: heading error of \
         the recorded rudder replayed through the nearest first-order response and through the final model, as a \
         multiple of the noise, in the median trial; the final model is replayed without random and located moments. \
         *Moment*: the random moment beside what is named and located, in the median trial that has one. Near a change \
         is within {NEAR} s of it, by the beginning, the end or the middle of a moment: a beginning chosen at random \
         is near one change of a record in 13 % of all cases, near one of two in 27 %. A period is right within {} % \
         of those of the truth, or as two or three times one, where its harmonics are located with it. There are \
         {REPLICATES} trials of every ship at each of {} noises. Every trial has a line in \
         [outcomes.csv](outcomes.csv).",
        100.0 * NEAR_PERIOD,
        NOISES_DEG.len(),
    );
    format!("{made}\n\n```text\n{COMMAND}\n```\n\n{}", wrapped(&records))
}

/// The ships of one group at both noises.
fn table(truths: &[Truth], outcomes: &[Outcome], group: Group, counted: &[Counted]) -> Table {
    let head = TableHead::default().texts(["truth"]).numbers(["noise"]).unit("deg").numbers(["likelihood ratio"]);
    let head = head.counts(["trials"]).texts(["right"]).unit("%");
    let head = head.counts(counted.iter().map(|(heading, _)| *heading));
    let head = head.counts(["and more"]).numbers(["before", "after"]).unit("× noise");
    let head = head.numbers(["moment"]).unit("deg").texts(["named and located"]);
    let mut table = Table::new(head);
    for cell in outcomes.chunk_by(|one, other| (one.ship, one.noise_deg) == (other.ship, other.noise_deg)) {
        let (truth, noise_deg) = (&truths[cell[0].ship], cell[0].noise_deg);
        if Group::of(truth) != group {
            continue;
        }
        let count = |is_of: &dyn Fn(&Outcome) -> bool| cell.iter().filter(|outcome| is_of(outcome)).count();
        let is_right = |outcome: &Outcome| outcome.judgement.is_right(&truth.kind);
        let says_more = |outcome: &Outcome| outcome.answer.as_ref().is_some_and(|own| own.says_more(&truth.kind));
        let median = |of: &dyn Fn(&Answer) -> Option<f64>| {
            let mut all: Vec<f64> = cell.iter().filter_map(|outcome| of(outcome.answer.as_ref()?)).collect();
            significant(estimation::statistics::median(&mut all).unwrap_or(f64::NAN), 3)
        };
        let error = |side: usize| median(&|answer| Some(to_deg(answer.heading[side]) / noise_deg));
        let mut row = vec![
            truth.name.to_owned(),
            noise_deg.to_string(),
            fixed(cell[0].ratio, 0),
            cell.len().to_string(),
            percent(count(&is_right), cell.len()),
        ];
        row.extend(counted.iter().map(|(_, said)| count(&|outcome| outcome.judgement == *said).to_string()));
        row.push(count(&|outcome| is_right(outcome) && says_more(outcome)).to_string());
        row.extend([error(0), error(1), median(&|answer| answer.disturbance_deg), names(cell)]);
        table.push(row);
    }
    table
}

/// The equations, and what is right to say of them.
fn equations(truths: &[Truth]) -> Table {
    let mut table = Table::new(TableHead::default().texts(["truth", "equation", "right"]));
    for truth in truths {
        let right = match truth.kind {
            Kind::Listed { right, alias: [] } => right.join(", "),
            Kind::Listed { right, alias } => format!("{}; as an alias {}", right.join(", "), alias.join(", ")),
            Kind::Unlisted { depends_on, times } => {
                let when = match times {
                    Times::Always => String::new(),
                    Times::Instants(changes) => {
                        let changes: Vec<String> = changes.iter().map(|change| format!("{change} s")).collect();
                        format!(", at {}", changes.join(" or "))
                    }
                    Times::Periods([from, to]) if from == to => format!(", with a period of {from} s"),
                    Times::Periods([from, to]) => format!(", with periods from {from} to {to} s"),
                };
                format!("depends on {depends_on}{when}; or unexplained")
            }
            Kind::Nothing { disturbed: false } => "clean".to_owned(),
            Kind::Nothing { disturbed: true } => "clean or disturbed".to_owned(),
        };
        table.push([truth.name.to_owned(), truth.equation.to_owned(), right]);
    }
    table
}

/// What was named and located in some trials and how often, the most frequent first.
fn names(cell: &[Outcome]) -> String {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for answer in cell.iter().filter_map(|outcome| outcome.answer.as_ref()) {
        let mut dependences: Vec<String> = answer.located.iter().map(|entry| entry.depends_on.to_string()).collect();
        dependences.sort_unstable();
        dependences.dedup();
        let dependences = dependences.iter().map(|dependence| format!("depends on {dependence}"));
        let labels: Vec<String> = answer.named.iter().map(label).chain(dependences).collect();
        if !labels.is_empty() {
            *counts.entry(labels.join(" + ")).or_default() += 1;
        }
    }
    let mut counts: Vec<_> = counts.into_iter().collect();
    counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    counts.into_iter().map(|(names, count)| format!("{names} {count}")).collect::<Vec<_>>().join(", ")
}

fn label(named: &Named) -> String {
    format!("{} ({})", named.id, named.form)
}

/// `83 [64, 93]`, in per cent.
fn percent(count: usize, of: usize) -> String {
    let figure = share(count as u64, of as u64).map(|figure| figure.times(100.0));
    let of_ends = |[low, high]: [f64; 2]| format!(" [{}, {}]", fixed(low, 0), fixed(high, 0));
    figure.map_or(MISSING.to_owned(), |figure| fixed(figure.value, 0) + &figure.ci95.map_or_else(String::new, of_ends))
}

/// `20 of 24 trials (83 % [64, 93])`.
fn with_interval(count: usize, of: usize) -> String {
    let text = percent(count, of);
    let (value, ends) = text.split_once(' ').unwrap_or((&text, ""));
    format!("{count} of {of} trials ({value} % {ends})")
}

/// Prose in lines of at most 120 characters.
fn wrapped(text: &str) -> String {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let last = lines.last().map_or(0, |line| line.chars().count());
        if last > 0 && last + 1 + word.chars().count() > 120 {
            lines.push(String::new());
        }
        let line = lines.last_mut().expect("there is a line");
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(word);
    }
    lines.join("\n")
}
