//! The page of the study and its table of trials.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use campaign::statistics::share;
use report::number::{MISSING, fixed, significant};
use report::{PageFigure, Table, TableColumn};
use ship::angle::to_deg;

use super::Outcome;
use super::chart;
use super::judged::{Judgement, NEAR, Named};
use super::truths::{Kind, Truth};

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
    let mut table = Table::new([
        TableColumn::left("truth"),
        TableColumn::decimal("noise").unit("deg"),
        TableColumn::right("trial"),
        TableColumn::decimal("likelihood ratio"),
        TableColumn::left("judgement"),
        TableColumn::left("verdict"),
        TableColumn::left("named"),
        TableColumn::left("aliases"),
        TableColumn::left("times").unit("s"),
        TableColumn::left("noise named"),
        TableColumn::left("shape without a name"),
        TableColumn::decimal("heading before").unit("deg"),
        TableColumn::decimal("heading after").unit("deg"),
    ]);
    for outcome in outcomes {
        let answer = outcome.answer.as_ref();
        let text = |of: &dyn Fn(&Named) -> String| {
            let all = answer.map_or(&[][..], |answer| &answer.named);
            all.iter().map(of).collect::<Vec<_>>().join("; ")
        };
        let heading = |side: usize| answer.map_or(f64::NAN, |answer| to_deg(answer.heading[side]));
        table.push([
            truths[outcome.ship].name.to_owned(),
            outcome.noise_deg.to_string(),
            outcome.replicate.to_string(),
            fixed(outcome.ratio, 1),
            outcome.judgement.as_str().to_owned(),
            answer.map_or("", |answer| answer.verdict.as_str()).to_owned(),
            text(&label),
            text(&|named| named.aliases.join("|")),
            text(&|named| named.time.map_or_else(String::new, |time| fixed(time, 1))),
            answer.map_or("", |answer| if answer.noise { "yes" } else { "no" }).to_owned(),
            answer.and_then(|answer| answer.shape.clone()).unwrap_or_default(),
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
            Kind::Nothing => Self::Nothing,
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

/// Judgements that a column of a table counts.
type Counted = (&'static str, &'static [Judgement]);

const LISTED: [Counted; 6] = [
    ("right", &[Judgement::Right]),
    ("alias", &[Judgement::Alias]),
    ("wrong", &[Judgement::Wrong]),
    ("nothing, unexplained", &[Judgement::Unexplained]),
    ("nothing, noise", &[Judgement::Noise]),
    ("nothing, clean", &[Judgement::Clean]),
];

const UNLISTED: [Counted; 8] = [
    ("right", &[Judgement::Located, Judgement::Unexplained]),
    ("located", &[Judgement::Located]),
    ("unexplained", &[Judgement::Unexplained]),
    ("alias", &[Judgement::Alias]),
    ("wrong", &[Judgement::Wrong]),
    ("elsewhere", &[Judgement::Elsewhere]),
    ("noise", &[Judgement::Noise]),
    ("clean", &[Judgement::Clean]),
];

const NOTHING: [Counted; 4] = [
    ("right", &[Judgement::Clean]),
    ("wrong", &[Judgement::Wrong]),
    ("unexplained", &[Judgement::Unexplained]),
    ("noise", &[Judgement::Noise]),
];

const TEXT_LISTED: &str = "*right*: the group of the truth was named and nothing else; *alias*: the trace says that \
    it cannot tell what it named from the group of the truth, or what it named counts as such; *wrong*: another name, \
    alone or beside the right one; *nothing*: no name, the record called unexplained, clean with a random moment that \
    describes what is left, or clean.";

const TEXT_UNLISTED: &str = "*right*: *located* or *unexplained*; *located*: nothing but effects of time near a change \
    and shapes without a name; *unexplained*: called so, and no effect of the ship named; *alias*: an effect of the \
    ship that the trace cannot tell from one of time; *wrong*: an effect of the ship; *elsewhere*: an effect of time \
    away from every change, or without an instant; *noise*: clean with a random moment that describes what is left, \
    which is not counted as right; *clean*: clean without one.";

const TEXT_NOTHING: &str = "*right*: clean and nothing named; *wrong*: a name; *noise*: clean with a random moment.";

/// What came out, in counts.
fn finding(truths: &[Truth], outcomes: &[Outcome]) -> String {
    let counted = |group: Group, judgements: &[Judgement]| {
        let of: Vec<_> = outcomes.iter().filter(|outcome| Group::of(&truths[outcome.ship]) == group).collect();
        let count = of.iter().filter(|outcome| judgements.contains(&outcome.judgement)).count();
        with_interval(count, of.len())
    };
    use Judgement::{Alias, Clean, Elsewhere, Located, Noise, Right, Unexplained, Wrong};
    let sentences = [
        format!(
            "Listed physics in another formula is named by its group in {}, as an alias in {}, by a wrong name in {}, \
             and not at all in {}.",
            counted(Group::Listed, &[Right]),
            counted(Group::Listed, &[Alias]),
            counted(Group::Listed, &[Wrong]),
            counted(Group::Listed, &[Unexplained, Noise, Clean]),
        ),
        format!(
            "What is on no list is located or called unexplained in {}; an effect of the ship is named in {}, and one \
             that cannot be told from an effect of time in {}; an effect of time away from every change is named in \
             {}; nothing but noise in {}; it is called clean in {}.",
            counted(Group::Unlisted, &[Located, Unexplained]),
            counted(Group::Unlisted, &[Wrong]),
            counted(Group::Unlisted, &[Alias]),
            counted(Group::Unlisted, &[Elsewhere]),
            counted(Group::Unlisted, &[Noise]),
            counted(Group::Unlisted, &[Clean]),
        ),
        mostly_right(truths, outcomes),
        format!("Where nothing is missing, something is named in {}.", counted(Group::Nothing, &[Wrong])),
    ];
    let failed = outcomes.iter().filter(|outcome| outcome.judgement == Judgement::Failed).count();
    let failed = if failed > 0 { format!(" {failed} trials have no trace.") } else { String::new() };
    wrapped(&(sentences.join(" ") + &failed))
}

/// The ships on no list of which a trace is right in more than half of the trials.
fn mostly_right(truths: &[Truth], outcomes: &[Outcome]) -> String {
    let right = |outcome: &&Outcome| [Judgement::Located, Judgement::Unexplained].contains(&outcome.judgement);
    let cells = outcomes.chunk_by(|one, other| one.ship == other.ship);
    let cells = cells.filter(|cell| Group::of(&truths[cell[0].ship]) == Group::Unlisted);
    let (most, others): (Vec<_>, Vec<_>) = cells.partition(|cell| 2 * cell.iter().filter(right).count() > cell.len());
    let count = |cells: &[&[Outcome]]| {
        let all = || cells.iter().copied().flatten();
        format!("{} of {} trials", all().filter(right).count(), all().count())
    };
    let names: Vec<&str> = most.iter().map(|cell| truths[cell[0].ship].name).collect();
    let names = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
    format!("Mostly right there: {names} ({}); of the others {} are.", count(&most), count(&others))
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
         multiple of the noise, in the median trial; where a random moment was named, the final model is replayed \
         without it, and may be further from the record than the nearest response. Near a change is within {NEAR} s of \
         it: an instant chosen at random is near one change of a record in 13 % of all cases, near one of two in 27 %. \
         Every trial has a line in [outcomes.csv](outcomes.csv)."
    );
    format!("{made}\n\n```text\n{COMMAND}\n```\n\n{}", wrapped(&records))
}

/// The ships of one group at both noises.
fn table(truths: &[Truth], outcomes: &[Outcome], group: Group, counted: &[Counted]) -> Table {
    let mut columns = vec![
        TableColumn::left("truth"),
        TableColumn::decimal("noise").unit("deg"),
        TableColumn::decimal("likelihood ratio"),
        TableColumn::right("trials"),
        TableColumn::left("right").unit("%"),
    ];
    columns.extend(counted.iter().map(|(heading, _)| TableColumn::right(*heading)));
    columns.extend([
        TableColumn::decimal("before").unit("× noise"),
        TableColumn::decimal("after").unit("× noise"),
        TableColumn::left("named"),
    ]);
    let mut table = Table::new(columns);
    for cell in outcomes.chunk_by(|one, other| (one.ship, one.noise_deg) == (other.ship, other.noise_deg)) {
        let (truth, noise_deg) = (&truths[cell[0].ship], cell[0].noise_deg);
        if Group::of(truth) != group {
            continue;
        }
        let count = |judgements: &[Judgement]| cell.iter().filter(|one| judgements.contains(&one.judgement)).count();
        let median = |side: usize| {
            let answers = cell.iter().filter_map(|outcome| outcome.answer.as_ref());
            let mut errors: Vec<f64> = answers.map(|answer| to_deg(answer.heading[side]) / noise_deg).collect();
            estimation::statistics::median(&mut errors).unwrap_or(f64::NAN)
        };
        let mut row = vec![
            truth.name.to_owned(),
            noise_deg.to_string(),
            fixed(cell[0].ratio, 0),
            cell.len().to_string(),
            percent(count(counted[0].1), cell.len()),
        ];
        row.extend(counted.iter().map(|(_, judgements)| count(judgements).to_string()));
        row.extend([significant(median(0), 3), significant(median(1), 3), names(cell)]);
        table.push(row);
    }
    table
}

/// The equations, and what is right to say of them.
fn equations(truths: &[Truth]) -> Table {
    let mut table = Table::new([TableColumn::left("truth"), TableColumn::left("equation"), TableColumn::left("right")]);
    for truth in truths {
        let right = match truth.kind {
            Kind::Listed { right, alias: [] } => right.join(", "),
            Kind::Listed { right, alias } => format!("{}; as an alias {}", right.join(", "), alias.join(", ")),
            Kind::Unlisted { changes: [] } => "unexplained, or a shape without a name".to_owned(),
            Kind::Unlisted { changes } => {
                let changes: Vec<String> = changes.iter().map(|change| format!("{change} s")).collect();
                format!("unexplained, or an effect of time at {}", changes.join(" or "))
            }
            Kind::Nothing => "clean".to_owned(),
        };
        table.push([truth.name.to_owned(), truth.equation.to_owned(), right]);
    }
    table
}

/// What was named in some trials and how often, the most frequent first.
fn names(cell: &[Outcome]) -> String {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for answer in cell.iter().filter_map(|outcome| outcome.answer.as_ref()).filter(|answer| !answer.named.is_empty()) {
        let labels: Vec<String> = answer.named.iter().map(label).collect();
        *counts.entry(labels.join(" + ")).or_default() += 1;
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
