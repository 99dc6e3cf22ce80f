use std::sync::{Arc, LazyLock};

use identify::estimate::{Estimate, StopReason, Uncertainty};
use identify::{Identifier, IdentifyError};

use super::*;
use crate::NoObserver;

const DEFINITION: &str = r#"
name = "own"
reference = "output-error"
[[simulated]]
name = "one"
title = "One ship"
scenario = "one.toml"
records = ["zigzag", "zigzag-port", "circle"]
tasks.identify = ["zigzag"]
tasks.indices = ["zigzag"]
tasks.other-side = [{ fit = ["zigzag"], score = ["zigzag-port"] }]
tasks.circle = [{ fit = ["zigzag"], score = ["circle"] }]
[[simulated]]
name = "damped"
title = "The same ship with damping"
scenario = "damped.toml"
records = ["zigzag", "zigzag-port", "circle"]
tasks.name = ["zigzag"]
"#;

/// A first-order ship, recorded without an error.
const SCENARIO: &str = r#"
question = "?"
seed = 3
replicates = 2
ship.first-order = { K-per-s = 0.1, T-s = 20.0 }
manoeuvre.zig-zag = { rudder-deg = 20.0, heading-deg = 20.0, executes = 5 }
steering-gear.rate-deg-s = 2.5
recording.sampling-s = 1.0
identifier = [{ method.output-error = {} }]
[[also]]
manoeuvre.zig-zag = { rudder-deg = 20.0, heading-deg = 20.0, executes = 5, first = "port" }
[[also]]
manoeuvre.turning-circle = { rudder-deg = 35.0, heading-change-deg = 360.0 }
"#;

const DAMPING: &str = "[[effect]]\nnonlinear_damping.n3-s2-per-deg2 = 0.4\n[sensor]\nheading-noise-deg = 0.05\n";

fn definition() -> Definition {
    let desk = tempfile::tempdir().expect("a folder");
    let path = desk.path().join("own.toml");
    std::fs::write(&path, DEFINITION).expect("written");
    std::fs::write(desk.path().join("one.toml"), SCENARIO).expect("written");
    std::fs::write(desk.path().join("damped.toml"), format!("{SCENARIO}{DAMPING}")).expect("written");
    Definition::read(&path, None).unwrap_or_else(|failure| panic!("{failure}"))
}

/// Knows K (1/s) and T (s) beforehand; without them it fails.
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
            robust: None,
            stop: StopReason::Direct,
            evaluations: 0,
            noise: None,
            diagnostics: Vec::new(),
            warnings: Vec::new(),
        })
    }
}

/// Asked once for the tests of this file.
static RESULTS: LazyLock<BenchDocument> = LazyLock::new(|| {
    let mut methods = BenchMethod::ours();
    methods.retain(|method| ["output-error", "trace", method::STRAIGHT_ON].contains(&method.label()));
    for (label, known) in [("perfect", Some([0.1, 20.0])), ("slow", Some([0.1, 24.0])), ("silent", None)] {
        methods.push(BenchMethod::new(label, Arc::new(KnownIndices(known))));
    }
    run(&definition(), &RecordStore::default(), &methods, &NoObserver, || Ok(()))
        .unwrap_or_else(|failure| panic!("{failure}"))
});

#[test]
fn scores_are_what_the_models_are_worth() {
    let results = &*RESULTS;
    assert_eq!(results.boards.len(), 4);
    for board in &results.boards {
        let of = |method: &str| board.standings.iter().find(|standing| standing.method == method);
        let median = |method: &str| of(method).and_then(|standing| standing.median.value).expect("an answer");
        assert!(median("perfect") < 1e-6, "{:?}: {}", board.task, median("perfect"));
        assert!(median("output-error") < 1e-3, "{:?}: {}", board.task, median("output-error"));
        assert!(median("slow") > 0.1, "{:?}: {}", board.task, median("slow"));
        match board.task {
            BenchTask::Indices => {
                assert!(of(method::STRAIGHT_ON).is_none(), "it has no K and no T");
                let slow = of("slow").expect("it answers");
                assert!((median("slow") - 20.0).abs() < 1e-9, "T is 24 s where it is 20 s");
                let holds = slow.holds.expect("intervals").map(|share| (share.count, share.of));
                assert_eq!(holds, [(2, 2), (0, 2)], "K is inside, 20 s is not within 24 s ± 10 %");
            }
            _ => assert!(median(method::STRAIGHT_ON) > 2.0 * median("slow"), "{:?}", board.task),
        }
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
    assert_eq!((line.method.as_str(), line.missing.as_deref(), line.named.of), ("trace", Some("nonlinear_damping"), 2));
    assert_eq!(line.counts.iter().sum::<usize>(), 2);
    assert!(results.cases.iter().filter(|case| case.task == BenchTask::Name).all(|case| case.answers.len() == 1));
}

#[test]
fn what_is_stored_is_read_back() {
    let results = &*RESULTS;
    let json = results.json().expect("numbers");
    assert_eq!(serde_json::from_str::<BenchDocument>(&json).expect("its own file"), *results);
    assert_eq!(json.lines().filter(|line| line.contains("\"answers\"")).count(), results.cases.len());
}

#[test]
fn labels_are_names_of_files_and_different() {
    let definition = definition();
    for (labels, said) in [(["a", "A"], "two methods are called"), (["a", "b/c"], "the name of a file")] {
        let methods = labels.map(|label| BenchMethod::new(label, Arc::new(KnownIndices(None))));
        let error = run(&definition, &RecordStore::default(), &methods, &NoObserver, || Ok(()))
            .expect_err("refused")
            .to_string();
        assert!(error.contains(said), "{error}");
    }
}
