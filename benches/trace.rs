//! Time to trace what a first-order response lacks, on one core: a record of 400 rows with nothing missing and with cubic
//! damping, all candidates on the base of it, and a record of 20 000 rows.

use std::hint::black_box;
use std::sync::Arc;

use criterion::{Criterion, criterion_group, criterion_main};
use identify::{Identifier, output_error};
use kempf_benches::{KEY, first_order_zig_zag};
use ship::effects::{Effect, NonlinearDamping};
use ship::{Response, ResponseModel};
use simulate::{Simulation, Vessel};
use trace::candidates::{self, Sizes};
use trace::fit::Problem;
use trace::record::Record;
use trace::search::Search;
use trace::structure::Structure;
use trace::{Settings, trace};
use trial::Trial;

fn with_damping(simulation: Simulation) -> Simulation {
    let effect: Arc<dyn Effect> = Arc::new(NonlinearDamping::Cubic);
    let ship: Response = ResponseModel::new(vec![effect]).with(vec![1.0 / 16.3, 0.1 / 16.3, 0.0, 80.0]);
    Simulation { vessel: Vessel::response(ship), ..simulation }
}

fn made(simulation: &Simulation) -> Trial {
    simulation.run(&KEY).expect("a regular trial").trial
}

/// Every candidate fitted on the base of a record, by output error.
fn all_candidates(trial: &Trial) -> usize {
    let method = output_error::Settings::default().build().expect("default settings are valid");
    let base = method.identify(std::slice::from_ref(trial)).expect("a zig-zag").response;
    let replay = identify::replay::replay(trial, &base).expect("finite");
    let initial = vec![[replay.heading[0], replay.yaw_rate[0]]];
    let record = Record::averaged(trial, base.T().abs());
    let problem = Problem::new(vec![record], base.inverse_T, base.K_over_T);
    let structure = Structure::base(1, false);
    let theta = [base.inverse_T, base.K_over_T, base.rudder_bias];
    let sizes = Sizes::of(&problem.records, base.inverse_T, &problem.replay(&structure, &theta, &initial));
    let candidates = candidates::all(&problem.records, &sizes);
    let thresholds = Settings::default().thresholds;
    let search = Search { problem: &problem, candidates: &candidates, thresholds };
    let start = search.base(structure, &theta, &initial);
    search.try_all(&start, &start.plain, false).len()
}

fn tracing(criterion: &mut Criterion) {
    let one_core = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool of one thread");
    let settings = Settings::default();
    let clean = made(&first_order_zig_zag(400));
    let damped = made(&with_damping(first_order_zig_zag(400)));
    let long = made(&with_damping(first_order_zig_zag(20_000)));
    let mut group = criterion.benchmark_group("trace, one core");
    group.sample_size(10);
    group.bench_function("all candidates, 400 rows", |bench| {
        bench.iter(|| one_core.install(|| all_candidates(black_box(&damped))));
    });
    for (name, trial) in [("clean, 400 rows", &clean), ("cubic damping, 400 rows", &damped)] {
        group.bench_function(name, |bench| {
            bench.iter(|| one_core.install(|| trace(std::slice::from_ref(black_box(trial)), &[], &settings)));
        });
    }
    group.bench_function("all candidates, 20 000 rows", |bench| {
        bench.iter(|| one_core.install(|| all_candidates(black_box(&long))));
    });
    group.bench_function("cubic damping, 20 000 rows", |bench| {
        bench.iter(|| one_core.install(|| trace(std::slice::from_ref(black_box(&long)), &[], &settings)));
    });
    group.finish();
}

criterion_group!(benches, tracing);
criterion_main!(benches);
