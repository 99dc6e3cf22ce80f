//! Tracing what a first-order response lacks.

use identify::{Identifier, output_error};
use trace::candidates::{self, Sizes};
use trace::fit::Problem;
use trace::record::Record;
use trace::search::Search;
use trace::structure::Structure;
use trace::{Settings, trace};
use trial::Trial;

use crate::records::{damped_zig_zag, first_order_zig_zag, record};
use crate::work::{Group, Reach, Work};

/// Every candidate fitted on the base of a record, by output error.
fn all_candidates(trial: &Trial) -> usize {
    let method = output_error::Settings::default().build().expect("default settings are valid");
    let base = method.identify(std::slice::from_ref(trial)).expect("a zig-zag").response;
    let replay = identify::replay::replay(trial, &base).expect("finite");
    let initial = vec![replay.initial()];
    let record = Record::averaged(trial, base.T().abs());
    let problem = Problem::new(vec![record], base.inverse_T, base.K_over_T);
    let structure = Structure::base(1, false);
    let theta = [base.inverse_T, base.K_over_T, base.rudder_bias];
    let sizes = Sizes::of(&problem.records, base.inverse_T, &problem.replay(&structure, &theta, &initial));
    let candidates = candidates::all(&problem.records, &sizes);
    let thresholds = Settings::default().thresholds;
    let search = Search::new(&problem, &candidates, thresholds);
    let start = search.base(structure, &theta, &initial);
    search.try_all(&start, &start.plain, false).len()
}

/// All candidates, and whole traces, of a short record and a long one.
pub fn tracing() -> Group {
    let mut group = Group::new(
        "trace",
        "Records of 400 and of 20 000 rows half a second apart, on one core: every candidate fitted once on the base, and the \
         whole trace with its rounds, evidence and held-out errors.",
    );
    let clean = record(&first_order_zig_zag(400));
    let (damped, long) = (record(&damped_zig_zag(400)), record(&damped_zig_zag(20_000)));
    let candidates = |name: &str, trial: &Trial| {
        let trial = trial.clone();
        Work::new(name, move || all_candidates(&trial)).slow()
    };
    let whole = |name: &str, trial: Trial| {
        let settings = Settings::default();
        Work::new(name, move || trace(std::slice::from_ref(&trial), &[], &settings).is_ok()).slow()
    };
    group.alone(candidates("all candidates, 400 rows", &damped), Some(Reach::Time(0.05)));
    group.alone(candidates("all candidates, 20 000 rows", &long), Some(Reach::Time(2.0)));
    group.alone(whole("whole trace, clean, 400 rows", clean), None);
    group.alone(whole("whole trace, cubic damping, 400 rows", damped), None);
    group.alone(whole("whole trace, cubic damping, 20 000 rows", long), None);
    group
}
