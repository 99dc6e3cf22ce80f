use std::sync::{Arc, LazyLock};

use identify::estimate::{Estimate, StopReason, Uncertainty};
use identify::{Identifier, IdentifyError};
use ship::FirstOrder;

use super::*;
use crate::benchmark::BenchDocument;
use crate::collect::collect_in_memory;
use crate::scenario::STRAIGHT_ON_ID;
use crate::testing::scenario;

/// A first-order ship, recorded without error, validated on the opposite side and on a circle.
const SCENARIO: &str = r#"
question = "?"
seed = 3
replicates = 2
ship.first-order = { K-per-s = 0.1, T-s = 20.0 }
manoeuvre.zig-zag = { rudder-deg = 20.0, heading-deg = 20.0, executes = 5 }
steering-gear.rate-deg-s = 2.5
recording.sampling-s = 1.0
identifier = [{ method.output-error = {} }, { trace = {} }, { straight-on = {} }]
[[sweep]]
name = "ship"
points = [{ label = "hers", set = {} }]
[[sweep]]
name = "what judges"
[[sweep.points]]
label = "other side"
set."validation.manoeuvre".zig-zag = { rudder-deg = 20.0, heading-deg = 20.0, executes = 5, first = "port" }
[[sweep.points]]
label = "circle"
set."validation.manoeuvre".turning-circle = { rudder-deg = 35.0, heading-change-deg = 360.0 }
"#;

const DAMPING: &str = "[[effect]]\nnonlinear_damping.n3-s2-per-deg2 = 0.4\n[sensor]\nheading-noise-deg = 0.05\n";

/// Estimator with known K (1/s) and T (s); fails without them.
struct KnownIndices(Option<[f64; 2]>);

impl Identifier for KnownIndices {
    fn id(&self) -> &'static str {
        "known"
    }

    fn summary(&self) -> &'static str {
        "knows"
    }

    fn identify(&self, _: &[Trial]) -> Result<Estimate, IdentifyError> {
        let [k, t] = self.0.ok_or(IdentifyError::NoTrial)?;
        let near = |value: f64| [0.9 * value, 1.1 * value];
        Ok(Estimate {
            response: FirstOrder::from_indices(k, t, 0.0),
            uncertainty: Uncertainty::Intervals { K: near(k), T: near(t), rudder_bias: [-0.1, 0.1], meaning: "near" },
            robust_covariance: None,
            stop: StopReason::Direct,
            evaluations: 0,
            noise: None,
            diagnostics: Vec::new(),
            warnings: Vec::new(),
        })
    }
}

/// Computed once for the tests of this file.
static RESULTS: LazyLock<BenchDocument> = LazyLock::new(|| {
    let studies = [SCENARIO.to_owned(), format!("{SCENARIO}{DAMPING}")].map(|text| {
        let mut study = scenario(text);
        for (label, indices) in [("perfect", Some([0.1, 20.0])), ("slow", Some([0.1, 24.0])), ("silent", None)] {
            study = study.with_identifier(label, Arc::new(KnownIndices(indices))).unwrap_or_else(|e| panic!("{e}"));
        }
        let (_, rows) = collect_in_memory(&study);
        (study, rows)
    });
    BenchDocument::from_studies(&studies, &[])
});

#[test]
fn scores_are_what_the_models_are_worth() {
    let results = &*RESULTS;
    let tasks: Vec<BenchTask> = results.boards.iter().map(|board| board.task).collect();
    assert_eq!(tasks, [BenchTask::Identify, BenchTask::Indices, BenchTask::OtherSide, BenchTask::Circle]);
    for board in &results.boards {
        let of = |method: &str| board.standings.iter().find(|standing| standing.method == method);
        let median = |method: &str| of(method).and_then(|standing| standing.median.value).expect("an answer");
        assert!(median("perfect") < 1e-6, "{:?}: {}", board.task, median("perfect"));
        assert!(median("output-error") < 1e-3, "{:?}: {}", board.task, median("output-error"));
        assert!(median("slow") > 0.1, "{:?}: {}", board.task, median("slow"));
        match board.task {
            BenchTask::Indices => {
                assert!(of(STRAIGHT_ON_ID).is_none(), "it has no K and no T");
                let slow = of("slow").expect("it answers");
                assert!((median("slow") - 20.0).abs() < 1e-9, "T is 24 s where it is 20 s");
                let holds = slow.coverage.expect("intervals").map(|share| (share.count, share.cases));
                assert_eq!(holds, [(2, 2), (0, 2)], "K is inside, 20 s is not within 24 s ± 10 %");
            }
            _ => assert!(median(STRAIGHT_ON_ID) > 2.0 * median("slow"), "{:?}", board.task),
        }
        assert_eq!((board.cases, board.clusters), (2, 2), "a trial is asked once, whatever judges it");
        let silent = board.standings.last().expect("a standing");
        assert_eq!((silent.method.as_str(), silent.failed, silent.median.value), ("silent", 2, None), "worse than any");
    }
    let silent = results.cases.iter().flat_map(|case| &case.answers).find(|answer| answer.method == "silent");
    assert_eq!(silent.and_then(|answer| answer.failure.as_deref()), Some("no-trial"));
}

#[test]
fn only_who_names_effects_is_asked_for_one() {
    let results = &*RESULTS;
    let [line] = &results.naming[..] else { panic!("{:?}", results.naming) };
    assert_eq!(
        (line.method.as_str(), line.missing.as_deref(), line.named.cases),
        ("trace", Some("nonlinear_damping"), 2)
    );
    assert!(results.cases.iter().filter(|case| case.task == BenchTask::Name).all(|case| case.answers.len() == 1));
}

#[test]
fn what_is_stored_is_read_back() {
    let results = &*RESULTS;
    let json = results.to_json().expect("numbers");
    assert_eq!(serde_json::from_str::<BenchDocument>(&json).expect("its own file"), *results);
    assert_eq!(json.lines().filter(|line| line.contains("\"answers\"")).count(), results.cases.len());
}

/// The task of a prediction is determined by the zig-zags alone.
#[test]
fn a_prediction_is_of_another_side_another_amplitude_or_a_turn() {
    let zig_zag = |angles: [f64; 2], side| SteeredRecord::new(None, Some((Some(angles), side)), String::new(), None);
    let [starboard, port, ten] =
        [([20.0, 20.0], Side::Starboard), ([20.0, 20.0], Side::Port), ([10.0, 10.0], Side::Port)]
            .map(|(angles, side)| zig_zag(angles, side));
    let turn = SteeredRecord::new(None, None, "turn".to_owned(), None);
    for (fitted, judge, task) in [
        (vec![&starboard], &port, Some(BenchTask::OtherSide)),
        (vec![&starboard], &ten, Some(BenchTask::OtherAmplitude)),
        (vec![&starboard, &port], &ten, Some(BenchTask::OtherAmplitude)),
        (vec![&starboard, &port], &turn, Some(BenchTask::Circle)),
        (vec![&starboard], &starboard, None),
        (vec![&starboard, &ten], &port, None),
        (vec![&turn], &starboard, None),
    ] {
        assert_eq!(prediction(&fitted, judge), task, "{}", judge.record.name);
    }
}
