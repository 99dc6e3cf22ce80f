//! One ranking over all predictions: the mean over their boards of the mean rank of a method. It hides by how much a
//! method is better, on which ships and at what.

use serde::{Deserialize, Serialize};

use crate::benchmark::board::{Figure, by_field, clusters, ranks_of, scores};
use crate::benchmark::cases::{Case, mean};
use crate::benchmark::statistics::resampled_by_set;
use crate::benchmark::task::Task;

/// The ranking.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Overall {
    /// The boards it is made of, each counting the same.
    pub boards: Vec<(Task, String)>,
    /// Mean ranks, the best first. Intervals come from drawing sets, and their records.
    pub standings: Vec<(String, Figure)>,
}

/// Ranks methods over the tasks in which a record is predicted that was not fitted; `None` without such a task.
pub fn overall(cases: &[Case], methods: &[String]) -> Option<Overall> {
    let fields = by_field(cases, Task::is_prediction);
    let boards = fields.iter().map(|((task, field), _)| (*task, (*field).to_owned())).collect();
    // Every method is asked for every prediction.
    let of_boards: Vec<Ranks> = fields.iter().map(|(_, cases)| Ranks::of(cases, methods)).collect();
    let first = of_boards.first()?;
    let over_boards = |of_board: &dyn Fn(&Ranks) -> f64| mean(of_boards.iter().map(of_board)).unwrap_or(f64::NAN);
    let standing = |(place, method): (usize, &String)| {
        let value = over_boards(&|board| board.whole[place]);
        let draws = first.drawn.len();
        let drawn = (0..draws).map(|draw| over_boards(&|board| board.drawn[draw][place])).collect();
        let clusters = of_boards.iter().map(|board| board.clusters).sum();
        (method.clone(), Figure::new(value, clusters, drawn))
    };
    let mut standings: Vec<(String, Figure)> = first.methods.iter().enumerate().map(standing).collect();
    let worst = f64::INFINITY;
    standings.sort_by(|(_, one), (_, other)| one.value.unwrap_or(worst).total_cmp(&other.value.unwrap_or(worst)));
    Some(Overall { boards, standings })
}

/// Mean ranks of all methods on one board, and of many draws of its sets.
struct Ranks {
    methods: Vec<String>,
    clusters: usize,
    whole: Vec<f64>,
    drawn: Vec<Vec<f64>>,
}

impl Ranks {
    fn of(cases: &[&Case], methods: &[String]) -> Self {
        let scores = scores(cases, methods);
        let ranks = ranks_of(&scores, cases.len());
        let means = |cases: &[usize]| -> Vec<f64> {
            let of = |place: usize| mean(cases.iter().map(|&case| ranks[case][place])).unwrap_or(f64::NAN);
            (0..scores.len()).map(of).collect()
        };
        let all = clusters(cases);
        let mut sets: Vec<(&str, Vec<Vec<usize>>)> = Vec::new();
        for cluster in &all {
            let set = cases[cluster[0]].set.as_str();
            match sets.iter_mut().find(|(known, _)| *known == set) {
                Some((_, own)) => own.push(cluster.clone()),
                None => sets.push((set, vec![cluster.clone()])),
            }
        }
        let sets: Vec<Vec<Vec<usize>>> = sets.into_iter().map(|(_, clusters)| clusters).collect();
        Self {
            clusters: all.len(),
            whole: means(&(0..cases.len()).collect::<Vec<usize>>()),
            drawn: resampled_by_set(&sets, means),
            methods: scores.into_iter().map(|(method, _)| method).collect(),
        }
    }
}
