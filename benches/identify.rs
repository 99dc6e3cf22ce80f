//! Time to identify K, T and δ_r from one record of 1201 rows, by method.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use identify::registry;
use kempf_benches::{KEY, first_order_zig_zag};

fn identify(criterion: &mut Criterion) {
    let trial = first_order_zig_zag(1201).run(&KEY).expect("a regular trial").trial;
    let trials = std::slice::from_ref(&trial);
    let mut group = criterion.benchmark_group("identify, 1201 rows");
    for settings in registry::defaults() {
        let method = settings.build().expect("default settings are valid");
        group.bench_function(method.id(), |bench| bench.iter(|| method.identify(black_box(trials))));
    }
    group.finish();
}

criterion_group!(benches, identify);
criterion_main!(benches);
