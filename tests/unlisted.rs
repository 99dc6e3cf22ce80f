//! Ships that are on no list: what is simulated is what it is said to be, and single trials of it are traced. How often
//! a trace is right is a matter of `results/published/unlisted`.

use std::path::Path;

use kempf_tests::unlisted::judged::Judgement;
use kempf_tests::unlisted::truths::{self, Kind, Truth};
use kempf_tests::unlisted::{NOISES_DEG, page, records, run, square_to_first_order};
use ship::angle::{from_deg, to_deg};
use ship::dynamics::Dynamics;
use ship::replay::{Recorded, replay};
use ship::{Polyline, ResponseModel};
use simulate::StreamKey;

const KEY: StreamKey = StreamKey { seed: 3, cell: 0, replicate: 1 };

fn ship(name: &str) -> Truth {
    truths::all().into_iter().find(|truth| truth.name == name).expect("a ship of the list")
}

/// The code of its own integrates the equation of a first-order ship as the project does.
#[test]
fn a_ship_that_lacks_nothing_is_a_first_order_response() {
    let loud = &records::of(&ship("first order"), NOISES_DEG[0], KEY)[0];
    let response = ResponseModel::first_order().with(vec![1.0 / 16.3, 0.1 / 16.3, from_deg(0.5)]);
    let signal = Polyline::new(loud.time().to_vec(), loud.rudder().to_vec()).expect("rows are in order");
    let mut state = vec![0.0; response.dimension()];
    response.approach(0.0, 0.0, &mut state);
    let mut left = Vec::new();
    replay(&response, &Recorded::rudder(&signal), loud.time(), 0.05, &mut state, |row, motion| {
        left.push(to_deg(loud.heading()[row] - motion.heading));
    });
    // Nothing is left but the noise of the compass: neither more nor less of it, and none of it slow.
    let mean = left.iter().sum::<f64>() / left.len() as f64;
    let rms = (left.iter().map(|x| x * x).sum::<f64>() / left.len() as f64).sqrt();
    assert!((rms / NOISES_DEG[0] - 1.0).abs() < 0.15 && mean.abs() < 0.2 * NOISES_DEG[0], "{rms} deg, mean {mean} deg");
    assert!(to_deg(square_to_first_order(&ship("first order")).sqrt()) < 1e-4);
}

/// A zig-zag is one: the rudder goes from side to side at its rate, and the heading reaches either side.
#[test]
fn every_ship_is_steered_through_its_zig_zags() {
    for truth in truths::all() {
        // The rudder itself, not what its sensor makes of it.
        let truth = Truth { rudder_gain: |_| 1.0, ..truth.without_chance() };
        let records = records::of(&truth, NOISES_DEG[1], KEY);
        assert_eq!(records.len(), truth.zig_zags_deg.len());
        for (record, &angle) in records.iter().zip(truth.zig_zags_deg) {
            let rudder: Vec<f64> = record.rudder().iter().copied().map(to_deg).collect();
            let steps = rudder.windows(2).map(|pair| pair[1] - pair[0]);
            assert!(steps.clone().all(|step| step.abs() < 1e-9 || (step.abs() - 2.5).abs() < 1e-9), "{}", truth.name);
            let executes = rudder.windows(2).filter(|pair| pair[0].abs() > angle - 1e-9 && pair[1] != pair[0]).count();
            let most = record.heading().iter().copied().map(to_deg).fold(0.0, |most: f64, psi| most.max(psi.abs()));
            assert!(executes >= 3 && most > angle && most < 4.0 * angle, "{}: {executes}, {most} deg", truth.name);
        }
    }
}

/// What no record shows tells nothing about a trace.
#[test]
fn every_truth_is_seen_clearly() {
    for truth in truths::all().iter().filter(|truth| !matches!(truth.kind, Kind::Nothing { .. })) {
        let ratio = square_to_first_order(truth) / from_deg(NOISES_DEG[1]).powi(2);
        assert!(ratio > 50.0, "{}: likelihood ratio {ratio:.1}", truth.name);
    }
}

#[test]
fn one_of_each_kind_is_judged() {
    let some = ["damping of power 2.5", "bank", "two steps of the moment", "first order"].map(ship);
    let outcomes = run(&some, &NOISES_DEG[..1], 1);
    let judged: Vec<Judgement> = outcomes.iter().map(|outcome| outcome.judgement).collect();
    let wrong = |place: usize| format!("{}: {:?}", some[place].name, outcomes[place].answer);
    assert_eq!(judged[0], Judgement::Right, "{}", wrong(0));
    assert_eq!(judged[1], Judgement::Located, "{}", wrong(1));
    assert_eq!(judged[2], Judgement::Located, "{}", wrong(2));
    assert_eq!(judged[3], Judgement::Clean, "{}", wrong(3));
}

#[test]
fn any_number_of_threads_writes_the_same_page() {
    let some = ["damping of power 2.5", "first order"].map(ship);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        let outcomes = pool.install(|| run(&some, &NOISES_DEG[..1], 2));
        [page::csv(&some, &outcomes), page::markdown(&some, &outcomes)]
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn the_published_page_says_how_it_is_made() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../results/published/unlisted/README.md");
    let published = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let (_, rest) = published.split_once("```text\n").expect("a command");
    assert_eq!(rest.lines().next(), Some(page::COMMAND));
    let all = truths::all();
    let names: Vec<&str> = published.lines().filter_map(|line| Some(line.split('|').nth(1)?.trim())).collect();
    let rows = |truth: &&Truth| names.iter().filter(|name| **name == truth.name).count();
    let lacking: Vec<&str> =
        all.iter().filter(|truth| rows(truth) != 1 + NOISES_DEG.len()).map(|truth| truth.name).collect();
    assert!(lacking.is_empty(), "ships that the page does not have: {lacking:?}; run {}", page::COMMAND);
}
