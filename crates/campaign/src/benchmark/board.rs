//! Leaderboards: scores of all methods on one task, for the records of one study. A failed estimate ranks below any
//! other estimate.
//!
//! Source: Friedman (1937) for mean ranks, Wilson (1927) for intervals of shares.

use serde::{Deserialize, Serialize};

use crate::benchmark::cases::{BenchCase, BenchTask};
use crate::benchmark::statistics::{mean, median_and_p90, ranks, ratio};
use crate::statistics::{Statistic, grouped, resample_clusters, wilson_share};

pub use crate::benchmark::statistics::ScoreFigure;

/// Leaderboard: all methods on one task.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename = "Board")]
pub struct Leaderboard {
    /// Task.
    pub task: BenchTask,
    /// Study of the records.
    #[serde(rename = "field")]
    pub study: String,
    /// Number of cases.
    pub cases: usize,
    /// Number of trials or scored records that the bootstrap resamples; cases of one cluster are not independent.
    pub clusters: usize,
    /// Methods, in the order of increasing median.
    pub standings: Vec<LeaderboardRow>,
}

/// Line of a leaderboard: one method on one task.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LeaderboardRow {
    /// Label of the method.
    pub method: String,
    /// Number of cases in which it failed.
    pub failed: usize,
    /// Median of the score.
    pub median: ScoreFigure,
    /// 90 % quantile of the score.
    #[serde(rename = "high")]
    pub quantile_90: ScoreFigure,
    /// Median ratio of the score to that of the reference in the same case; `null` for the reference itself, and if it
    /// takes no part.
    pub ratio: Option<ScoreFigure>,
    /// Share of cases in which the score is smaller than that of the reference; ties count half.
    #[serde(rename = "better")]
    pub share_better: Option<ScoreFigure>,
    /// Mean rank among all methods.
    pub rank: f64,
    /// Coverage of the 95 % intervals of K and of T; `null` without intervals.
    #[serde(rename = "holds")]
    pub coverage: Option<[WilsonShare; 2]>,
}

/// A share with its 95 % interval (Wilson 1927).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WilsonShare {
    /// Number of successes.
    pub count: usize,
    /// Number of cases.
    #[serde(rename = "of")]
    pub cases: usize,
    /// 95 % interval.
    pub ci95: [f64; 2],
}

impl WilsonShare {
    /// Share of `count` in `cases`; `None` without cases.
    pub fn new(count: usize, cases: usize) -> Option<Self> {
        let Statistic { ci95, .. } = wilson_share(count as u64, cases as u64)?;
        Some(Self { count, cases, ci95: ci95? })
    }
}

/// Leaderboards of all tasks that have a score, one per task and study; `reference` labels the reference method.
pub fn leaderboards(cases: &[BenchCase], methods: &[String], reference: &str) -> Vec<Leaderboard> {
    let scored = by_task_and_study(cases, |task| task.score_label().is_some());
    scored.into_iter().map(|((task, study), group)| leaderboard(task, study, &group, methods, reference)).collect()
}

/// Cases of the selected tasks, grouped by task and study.
pub(super) fn by_task_and_study(
    cases: &[BenchCase],
    is_wanted: impl Fn(BenchTask) -> bool,
) -> Vec<((BenchTask, &str), Vec<&BenchCase>)> {
    grouped(cases.iter().filter(|case| is_wanted(case.task)), |case| (case.task, case.study.as_str()))
}

/// Scores of a set of cases.
pub(super) struct Scores {
    /// Clusters of the bootstrap, as case indices.
    pub clusters: Vec<Vec<usize>>,
    /// Methods with a result in every case, failed ones included, and their scores by case.
    pub methods: Vec<(String, Vec<f64>)>,
    /// Ranks of these methods, by case.
    pub ranks: Vec<Vec<f64>>,
}

impl Scores {
    pub(super) fn from_cases(cases: &[&BenchCase], methods: &[String]) -> Self {
        let of_method = |method: &String| {
            let scores: Option<Vec<f64>> = cases.iter().map(|case| case.method_score(method)).collect();
            Some((method.clone(), scores?))
        };
        let methods: Vec<(String, Vec<f64>)> = methods.iter().filter_map(of_method).collect();
        let of_case = |case: usize| ranks(&methods.iter().map(|(_, scores)| scores[case]).collect::<Vec<f64>>());
        let ranks = (0..cases.len()).map(of_case).collect();
        let clusters = grouped(0..cases.len(), |&place| cases[place].cluster());
        Self { clusters: clusters.into_iter().map(|(_, places)| places).collect(), methods, ranks }
    }

    /// Two statistics of all cases, with intervals of the cluster bootstrap.
    fn figures(&self, statistic: impl Fn(&[usize]) -> [f64; 2]) -> [ScoreFigure; 2] {
        let whole: Vec<usize> = (0..self.ranks.len()).collect();
        let (values, drawn) = (statistic(&whole), resample_clusters(&self.clusters, &statistic));
        [0, 1]
            .map(|k| ScoreFigure::new(values[k], self.clusters.len(), drawn.iter().map(|figures| figures[k]).collect()))
    }
}

fn leaderboard(task: BenchTask, study: &str, cases: &[&BenchCase], methods: &[String], reference: &str) -> Leaderboard {
    let scores = Scores::from_cases(cases, methods);
    let other = scores.methods.iter().find(|(method, _)| method == reference).map(|(_, scores)| scores.as_slice());
    let row = |(place, (method, values)): (usize, &(String, Vec<f64>))| {
        let [median, quantile_90] = scores.figures(|cases| median_and_p90(cases.iter().map(|&k| values[k]).collect()));
        let paired = other.filter(|_| method != reference).map(|other| {
            scores.figures(|cases| {
                let median = median_and_p90(cases.iter().map(|&case| ratio(values[case], other[case])).collect())[0];
                let smaller = cases.iter().map(|&case| match values[case].total_cmp(&other[case]) {
                    std::cmp::Ordering::Less => 1.0,
                    std::cmp::Ordering::Equal => 0.5,
                    std::cmp::Ordering::Greater => 0.0,
                });
                [median, mean(smaller)]
            })
        });
        LeaderboardRow {
            method: method.clone(),
            failed: values.iter().filter(|score| score.is_infinite()).count(),
            median,
            quantile_90,
            ratio: paired.map(|[ratio, _]| ratio),
            share_better: paired.map(|[_, better]| better),
            rank: mean(scores.ranks.iter().map(|ranks| ranks[place])),
            coverage: coverage(cases, method),
        }
    };
    let mut standings: Vec<LeaderboardRow> = scores.methods.iter().enumerate().map(row).collect();
    standings.sort_by(|a, b| a.median.order(&b.median).then(a.quantile_90.order(&b.quantile_90)));
    Leaderboard { task, study: study.to_owned(), cases: cases.len(), clusters: scores.clusters.len(), standings }
}

/// Coverage of the intervals of a method, for K and T; `None` without intervals.
fn coverage(cases: &[&BenchCase], method: &str) -> Option<[WilsonShare; 2]> {
    let answers = cases.iter().flat_map(|case| &case.answers).filter(|answer| answer.method == method);
    let held: Vec<[bool; 2]> = answers.filter_map(|answer| answer.contains_truth).collect();
    let share = |index: usize| WilsonShare::new(held.iter().filter(|both| both[index]).count(), held.len());
    Some([share(0)?, share(1)?])
}

/// Scores of one set, as one line of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct SetLine {
    /// Task.
    pub task: BenchTask,
    /// Name of the set.
    pub set: String,
    /// Number of cases.
    pub cases: usize,
    /// Median score and number of failures of every method; `None` for a method that takes no part. A median that falls
    /// on a failed estimate is infinite.
    pub methods: Vec<Option<(f64, usize)>>,
}

/// Medians of all methods, by task and set.
pub fn set_lines(cases: &[BenchCase], methods: &[String]) -> Vec<SetLine> {
    let scored = cases.iter().filter(|case| case.task.score_label().is_some());
    let line = |((task, set), group): ((BenchTask, &str), Vec<&BenchCase>)| {
        let scores = Scores::from_cases(&group, methods);
        let figures = |method: &String| {
            let (_, values) = scores.methods.iter().find(|(name, _)| name == method)?;
            let failed = values.iter().filter(|score| score.is_infinite()).count();
            Some((median_and_p90(values.clone())[0], failed))
        };
        SetLine { task, set: set.to_owned(), cases: group.len(), methods: methods.iter().map(figures).collect() }
    };
    grouped(scored, |case| (case.task, case.set.as_str())).into_iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::benchmark::cases::CaseAnswer;

    fn case(trial: u64, scores: [Option<f64>; 2]) -> BenchCase {
        let answers = ["a", "b"].iter().zip(scores).map(|(method, score)| {
            let failure = score.is_none().then(|| "singular".to_owned());
            CaseAnswer { method: (*method).to_owned(), score, failure, ..CaseAnswer::default() }
        });
        BenchCase {
            task: BenchTask::Circle,
            study: "made".into(),
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
        // b is twice as good unless it fails, which it does in four of ten.
        let cases: Vec<BenchCase> = (0..10).map(|trial| case(trial, [Some(2.0), (trial < 6).then_some(1.0)])).collect();
        let methods = ["a", "b", "c"].map(str::to_owned);
        let boards = leaderboards(&cases, &methods, "a");
        let [Leaderboard { standings, cases: 10, clusters: 10, .. }] = &boards[..] else { panic!("{boards:?}") };
        let [b, a] = &standings[..] else { panic!("c was not asked: {standings:?}") };
        assert_eq!((b.method.as_str(), b.failed, b.median.value, b.quantile_90.value), ("b", 4, Some(1.0), None));
        assert_eq!((b.ratio.and_then(|r| r.value), b.share_better.and_then(|b| b.value)), (Some(0.5), Some(0.6)));
        assert_eq!((a.median, a.ratio), (ScoreFigure { value: Some(2.0), ci95: Some([Some(2.0); 2]) }, None));
        assert_eq!((a.rank, b.rank), (1.6, 1.4));
        // Half of the resamples have five failures or more: the interval of the median has no upper end.
        assert_eq!(b.median.ci95, Some([Some(1.0), None]));
    }

    #[test]
    fn cases_of_one_trial_are_drawn_together() {
        let cases: Vec<BenchCase> = [0, 0, 1, 1, 1].map(|trial| case(trial, [Some(1.0); 2])).to_vec();
        let all: Vec<&BenchCase> = cases.iter().collect();
        assert_eq!(Scores::from_cases(&all, &[]).clusters, [vec![0, 1], vec![2, 3, 4]]);
        assert_eq!(leaderboards(&cases, &["a".to_owned()], "a")[0].standings[0].median.ci95, None, "two clusters");
    }
}
