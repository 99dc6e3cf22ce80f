//! Time to simulate one trial: closed form, Runge–Kutta and a hull.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use kempf_benches::{KEY, first_order_zig_zag};
use ship::ships;
use simulate::{Simulation, Solver, Vessel};

fn simulate(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("simulate");
    for rows in [271, 1201] {
        let closed_form = first_order_zig_zag(rows);
        let integrated = Simulation { solver: Solver::RungeKutta(0.1), ..closed_form.clone() };
        group.bench_function(format!("first order, closed form, {rows} rows"), |bench| {
            bench.iter(|| black_box(&closed_form).run(&KEY));
        });
        group.bench_function(format!("first order, Runge-Kutta 0.1 s, {rows} rows"), |bench| {
            bench.iter(|| black_box(&integrated).run(&KEY));
        });
    }
    let kvlcc2 = ships::find("kvlcc2").expect("a ship of the registry");
    let hull = Simulation { vessel: Vessel::ship(&kvlcc2), ..first_order_zig_zag(1201) };
    group.bench_function("KVLCC2, 1201 rows", |bench| bench.iter(|| black_box(&hull).run(&KEY)));
    group.finish();
}

criterion_group!(benches, simulate);
criterion_main!(benches);
