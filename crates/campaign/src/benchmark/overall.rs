//! Overall ranking: mean over the leaderboards of predictions of the mean rank of each method (Friedman 1937). It does
//! not state by how much a method is better, on which ships or at which task.

use serde::{Deserialize, Serialize};

use crate::benchmark::board::{ScoreFigure, Scores, by_task_and_study};
use crate::benchmark::cases::{BenchCase, BenchTask};
use crate::benchmark::statistics::mean;
use crate::statistics::{grouped, resample_sets};

/// Overall ranking of the methods.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OverallRanking {
    /// Leaderboards in the mean, with equal weights.
    pub boards: Vec<(BenchTask, String)>,
    /// Mean ranks, best first, with intervals by resampling sets and clusters within them.
    pub standings: Vec<(String, ScoreFigure)>,
}

/// Ranking over the tasks that predict a record outside the fit; `None` if there is no such task.
pub fn overall_ranking(cases: &[BenchCase], methods: &[String]) -> Option<OverallRanking> {
    let is_prediction = |task| matches!(task, BenchTask::OtherSide | BenchTask::OtherAmplitude | BenchTask::Circle);
    let groups = by_task_and_study(cases, is_prediction);
    let boards = groups.iter().map(|((task, study), _)| (*task, (*study).to_owned())).collect();
    // Every method takes part in every prediction.
    let of_boards: Vec<MeanRanks> = groups.iter().map(|(_, cases)| MeanRanks::from_cases(cases, methods)).collect();
    let first = of_boards.first()?;
    let clusters = of_boards.iter().map(|board| board.clusters).sum();
    let standing = |(place, method): (usize, &String)| {
        let value = mean(of_boards.iter().map(|board| board.whole[place]));
        let of_draw = |draw: usize| mean(of_boards.iter().map(|board| board.drawn[draw][place]));
        let drawn = (0..first.drawn.len()).map(of_draw).collect();
        (method.clone(), ScoreFigure::new(value, clusters, drawn))
    };
    let mut standings: Vec<(String, ScoreFigure)> = first.methods.iter().enumerate().map(standing).collect();
    standings.sort_by(|(_, a), (_, b)| a.order(b));
    Some(OverallRanking { boards, standings })
}

/// Mean ranks of all methods on one leaderboard: for all cases, and for every resample of the sets.
struct MeanRanks {
    /// Labels of the methods.
    methods: Vec<String>,
    /// Number of clusters.
    clusters: usize,
    /// Mean rank over all cases, by method.
    whole: Vec<f64>,
    /// Mean rank in each resample, by method.
    drawn: Vec<Vec<f64>>,
}

impl MeanRanks {
    fn from_cases(cases: &[&BenchCase], methods: &[String]) -> Self {
        let Scores { clusters, methods, ranks } = Scores::from_cases(cases, methods);
        let means = |cases: &[usize]| -> Vec<f64> {
            (0..methods.len()).map(|place| mean(cases.iter().map(|&case| ranks[case][place]))).collect()
        };
        let whole = means(&(0..cases.len()).collect::<Vec<usize>>());
        let count = clusters.len();
        let sets = grouped(clusters, |cluster| cases[cluster[0]].set.as_str());
        let sets: Vec<Vec<Vec<usize>>> = sets.into_iter().map(|(_, clusters)| clusters).collect();
        let drawn = resample_sets(&sets, means);
        Self { clusters: count, whole, drawn, methods: methods.into_iter().map(|(method, _)| method).collect() }
    }
}
