//! scratch
use std::sync::Arc;
use std::time::Instant;
use ship::effects::*;
use ship::replay::*;
use ship::dynamics::Dynamics;
use ship::{Polyline, ResponseModel, Real, Tangent};
fn time<R: Real>(model: &ResponseModel, p: &[R], rudder: &Polyline, times: &[f64]) -> f64 {
    let mut best = f64::MAX;
    let response = model.clone().with(p.to_vec());
    for _ in 0..200 {
        let now = Instant::now();
        let mut state = vec![R::from(0.0); response.dimension()];
        let rec = Recorded::rudder(rudder);
        response.approach(R::from(0.0), R::from(0.0), &mut state);
        let mut out = vec![R::from(0.0); times.len()];
        replay_states(&response, &rec, times, 1.0, &mut state, |k, s, _| out[k] = s[0]);
        std::hint::black_box(out);
        best = best.min(now.elapsed().as_nanos() as f64);
    }
    best / times.len() as f64
}
fn main() {
    let times: Vec<f64> = (0..400).map(|k| 0.5 * k as f64).collect();
    let rudder = Polyline::new(times.clone(), times.iter().map(|t| 0.17 * (0.1 * t).sin()).collect()).unwrap();
    let mut lists: Vec<(String, Vec<Arc<dyn Effect>>)> = vec![("base".into(), vec![])];
    for e in all() { lists.push((e.form().to_string(), vec![e])); }
    lists.push(("two".into(), vec![Arc::new(SecondOrder), Arc::new(NonlinearDamping::Cubic)]));
    for (name, list) in lists {
        let mut p = vec![0.04, 0.0032, 0.01];
        p.extend(list.iter().flat_map(|e| e.parameters().iter().map(|p| p.typical)));
        let model = ResponseModel::new(list);
        let t: Vec<Tangent> = p.iter().enumerate().map(|(k, &x)| Tangent::variable(x, k % 4)).collect();
        println!("{name:20} {:6.1} ns/row  tangent {:6.1} ns/row", time(&model, &p, &rudder, &times), time(&model, &t, &rudder, &times));
    }
}
