//! Leaderboards: the scores of one task on measured or on simulated records, method by method. An answer that failed is
//! worse than any other, whatever is made of it.

use crate::statistics::{Statistic, share};
use serde::{Deserialize, Serialize};

use crate::benchmark::cases::{Case, mean};
use crate::benchmark::statistics::{middle_and_high, ranks, ratio, resampled};
use crate::benchmark::task::Task;

pub use crate::benchmark::statistics::{FEWEST, Figure};

/// All methods on one task.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Board {
    /// The task.
    pub task: Task,
    /// The field of its records.
    pub field: String,
    /// Number of cases.
    pub cases: usize,
    /// Number of trials or scored records that are drawn for intervals; cases of one are not independent.
    pub clusters: usize,
    /// The methods, that with the smallest median first.
    pub standings: Vec<Standing>,
}

/// A method on one task.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Standing {
    /// Its label.
    pub method: String,
    /// Cases in which it had no answer.
    pub failed: usize,
    /// Median of the score.
    pub median: Figure,
    /// What the score does not exceed in 90 % of the cases.
    pub high: Figure,
    /// Median of the score over that of the reference in the same case; none of the reference itself, and where it
    /// takes no part.
    pub ratio: Option<Figure>,
    /// Share of cases in which the score is smaller than that of the reference, equal ones counted half.
    pub better: Option<Figure>,
    /// Mean rank among all methods.
    pub rank: f64,
    /// How often 95 % intervals of K and of T hold the truth; none without intervals.
    pub holds: Option<[Share; 2]>,
}

/// A share with Wilson's 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Share {
    /// How many.
    pub count: usize,
    /// Of how many.
    pub of: usize,
    /// The interval.
    pub ci95: [f64; 2],
}

impl Share {
    /// A share; `None` of nothing.
    pub fn new(count: usize, of: usize) -> Option<Self> {
        let Statistic { ci95, .. } = share(count as u64, of as u64)?;
        Some(Self { count, of, ci95: ci95? })
    }
}

/// The boards of all tasks that have a score.
pub fn boards(cases: &[Case], methods: &[String], reference: &str) -> Vec<Board> {
    let scored = by_field(cases, |task| task.score().is_some());
    scored.into_iter().map(|(place, own)| board(place, &own, methods, reference)).collect()
}

/// The cases of some tasks, field by field.
pub(crate) fn by_field(cases: &[Case], is_wanted: impl Fn(Task) -> bool) -> Vec<((Task, &str), Vec<&Case>)> {
    let mut found: Vec<((Task, &str), Vec<&Case>)> = Vec::new();
    for case in cases.iter().filter(|case| is_wanted(case.task)) {
        let place = (case.task, case.field.as_str());
        match found.iter_mut().find(|(known, _)| *known == place) {
            Some((_, own)) => own.push(case),
            None => found.push((place, vec![case])),
        }
    }
    found
}

/// Cases that are drawn together, as their places.
pub(crate) fn clusters(cases: &[&Case]) -> Vec<Vec<usize>> {
    let mut found: Vec<((&str, String), Vec<usize>)> = Vec::new();
    for (place, case) in cases.iter().enumerate() {
        let own = case.cluster();
        match found.iter_mut().find(|(known, _)| *known == own) {
            Some((_, places)) => places.push(place),
            None => found.push((own, vec![place])),
        }
    }
    found.into_iter().map(|(_, places)| places).collect()
}

/// Methods that were asked in some cases, and their scores case by case.
pub(crate) fn scores(cases: &[&Case], methods: &[String]) -> Vec<(String, Vec<f64>)> {
    let of = |method: &String| {
        let own: Option<Vec<f64>> = cases.iter().map(|case| case.score_of(method)).collect();
        Some((method.clone(), own?))
    };
    methods.iter().filter_map(of).collect()
}

/// Ranks of some methods case by case.
pub(crate) fn ranks_of(scores: &[(String, Vec<f64>)], cases: usize) -> Vec<Vec<f64>> {
    (0..cases).map(|case| ranks(&scores.iter().map(|(_, own)| own[case]).collect::<Vec<f64>>())).collect()
}

fn board((task, field): (Task, &str), cases: &[&Case], methods: &[String], reference: &str) -> Board {
    let clusters = clusters(cases);
    let scores = scores(cases, methods);
    let ranks = ranks_of(&scores, cases.len());
    let other = scores.iter().find(|(method, _)| method == reference).map(|(_, scores)| scores.as_slice());
    let whole: Vec<usize> = (0..cases.len()).collect();
    let standing = |(place, (method, own)): (usize, &(String, Vec<f64>))| {
        let of_scores = |cases: &[usize]| middle_and_high(cases.iter().map(|&case| own[case]).collect());
        let drawn = resampled(&clusters, of_scores);
        let figure = |k: usize| {
            Figure::new(of_scores(&whole)[k], clusters.len(), drawn.iter().map(|figures| figures[k]).collect())
        };
        let paired = other.filter(|_| method != reference).map(|other| {
            let of_pairs = |cases: &[usize]| {
                let median = middle_and_high(cases.iter().map(|&case| ratio(own[case], other[case])).collect())[0];
                let smaller = cases.iter().map(|&case| match own[case].total_cmp(&other[case]) {
                    std::cmp::Ordering::Less => 1.0,
                    std::cmp::Ordering::Equal => 0.5,
                    std::cmp::Ordering::Greater => 0.0,
                });
                [median, mean(smaller).unwrap_or(f64::NAN)]
            };
            let drawn = resampled(&clusters, of_pairs);
            [0, 1].map(|k| {
                Figure::new(of_pairs(&whole)[k], clusters.len(), drawn.iter().map(|figures| figures[k]).collect())
            })
        });
        Standing {
            method: method.clone(),
            failed: own.iter().filter(|score| score.is_infinite()).count(),
            median: figure(0),
            high: figure(1),
            ratio: paired.map(|[ratio, _]| ratio),
            better: paired.map(|[_, better]| better),
            rank: mean(ranks.iter().map(|own| own[place])).unwrap_or(f64::NAN),
            holds: holds(cases, method),
        }
    };
    let mut standings: Vec<Standing> = scores.iter().enumerate().map(standing).collect();
    let worst = f64::INFINITY;
    let key = |one: &Standing| [one.median, one.high].map(|figure| figure.value.unwrap_or(worst));
    standings.sort_by(|one, other| {
        let ([a, b], [c, d]) = (key(one), key(other));
        a.total_cmp(&c).then(b.total_cmp(&d))
    });
    Board { task, field: field.to_owned(), cases: cases.len(), clusters: clusters.len(), standings }
}

/// How often the intervals of a method hold K and T.
fn holds(cases: &[&Case], method: &str) -> Option<[Share; 2]> {
    let answers = cases.iter().flat_map(|case| &case.answers).filter(|answer| answer.method == method);
    let held: Vec<[bool; 2]> = answers.filter_map(|answer| answer.holds).collect();
    let of = |index: usize| Share::new(held.iter().filter(|both| both[index]).count(), held.len());
    Some([of(0)?, of(1)?])
}

/// The scores of one set.
#[derive(Debug, Clone, PartialEq)]
pub struct SetLine {
    /// The task.
    pub task: Task,
    /// Name of the set.
    pub set: String,
    /// Number of cases.
    pub cases: usize,
    /// Median and failures of every method; none of one that takes no part.
    pub methods: Vec<Option<(f64, usize)>>,
}

/// Medians set by set.
pub fn by_set(cases: &[Case], methods: &[String]) -> Vec<SetLine> {
    let mut lines: Vec<(Task, &str, Vec<&Case>)> = Vec::new();
    for case in cases.iter().filter(|case| case.task.score().is_some()) {
        match lines.iter_mut().find(|(task, set, _)| (*task, *set) == (case.task, case.set.as_str())) {
            Some((_, _, own)) => own.push(case),
            None => lines.push((case.task, &case.set, vec![case])),
        }
    }
    let line = |(task, set, own): (Task, &str, Vec<&Case>)| {
        let scores = scores(&own, methods);
        let of = |method: &String| {
            let (_, own) = scores.iter().find(|(known, _)| known == method)?;
            let failed = own.iter().filter(|score| score.is_infinite()).count();
            Some((middle_and_high(own.clone())[0], failed))
        };
        SetLine { task, set: set.to_owned(), cases: own.len(), methods: methods.iter().map(of).collect() }
    };
    lines.into_iter().map(line).collect()
}

/// The share of cases within a score, score by score, of one method on one task; a line that ends below one belongs to
/// a method that fails.
pub fn steps(cases: &[Case], task: Task, field: &str, method: &str) -> Vec<(f64, f64)> {
    let own = cases.iter().filter(|case| (case.task, case.field.as_str()) == (task, field));
    let mut scores: Vec<f64> = own.filter_map(|case| case.score_of(method)).collect();
    scores.sort_by(f64::total_cmp);
    let of = scores.len() as f64;
    let steps = scores.iter().enumerate().map(|(place, &score)| (score, (place + 1) as f64 / of));
    steps.filter(|(score, _)| score.is_finite()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::benchmark::cases::Answer;

    fn case(trial: u64, scores: [Option<f64>; 2]) -> Case {
        let answers = ["a", "b"].iter().zip(scores).map(|(method, score)| {
            let failure = score.is_none().then(|| "singular".to_owned());
            Answer { method: (*method).to_owned(), score, failure, ..Answer::default() }
        });
        Case {
            task: Task::Circle,
            field: "made".into(),
            set: "s".into(),
            trial: Some(trial),
            fitted: vec!["zigzag".into()],
            scored: Some("circle".into()),
            missing: None,
            answers: answers.collect(),
        }
    }

    #[test]
    fn a_failed_answer_is_worse_than_any() {
        // b is twice as good wherever it answers, and fails in four of ten.
        let cases: Vec<Case> = (0..10).map(|trial| case(trial, [Some(2.0), (trial < 6).then_some(1.0)])).collect();
        let methods = ["a", "b", "c"].map(str::to_owned);
        let boards = boards(&cases, &methods, "a");
        let [Board { standings, cases: 10, clusters: 10, .. }] = &boards[..] else { panic!("{boards:?}") };
        let [b, a] = &standings[..] else { panic!("c was not asked: {standings:?}") };
        assert_eq!((b.method.as_str(), b.failed, b.median.value, b.high.value), ("b", 4, Some(1.0), None));
        assert_eq!((b.ratio.and_then(|ratio| ratio.value), b.better.and_then(|b| b.value)), (Some(0.5), Some(0.6)));
        assert_eq!((a.median, a.ratio), (Figure { value: Some(2.0), ci95: Some([Some(2.0); 2]) }, None));
        assert_eq!((a.rank, b.rank), (1.6, 1.4));
        // Half of the draws have five failures or more: the interval of the median has no upper end.
        assert_eq!(b.median.ci95, Some([Some(1.0), None]));
        assert_eq!(steps(&cases, Task::Circle, "made", "b").last(), Some(&(1.0, 0.6)));
    }

    #[test]
    fn cases_of_one_trial_are_drawn_together() {
        let cases: Vec<Case> = [0, 0, 1, 1, 1].map(|trial| case(trial, [Some(1.0); 2])).to_vec();
        let all: Vec<&Case> = cases.iter().collect();
        assert_eq!(clusters(&all), [vec![0, 1], vec![2, 3, 4]]);
        assert_eq!(boards(&cases, &["a".to_owned()], "a")[0].standings[0].median.ci95, None, "two clusters");
    }
}
