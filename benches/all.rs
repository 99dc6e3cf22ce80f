//! Measures every piece of work with criterion; its filters and options work as usual (`cargo bench -p kempf-benches --
//! identify`). The pieces are defined in `kempf_benches::works`, `ratios` makes their tables. `cargo test` makes one
//! pass of all but the slow ones.

use criterion::Criterion;
use kempf_benches::works;

/// Samples of work that takes long.
const FEW_SAMPLES: usize = 10;

fn main() {
    // As the program does.
    estimation::memory::keep_freed_memory();
    let mut criterion = Criterion::default().configure_from_args();
    let is_measured = std::env::args().any(|argument| argument == "--bench");
    for group in works::all() {
        let works = group.rows.into_iter().map(|row| row.work);
        for work in works.filter(|work| is_measured || !work.is_slow) {
            let mut benches = criterion.benchmark_group(group.name);
            if work.is_slow {
                benches.sample_size(FEW_SAMPLES);
            }
            benches.bench_function(&work.name, |bencher| bencher.iter_custom(|goes| work.time(goes)));
            benches.finish();
        }
    }
    criterion.final_summary();
}
