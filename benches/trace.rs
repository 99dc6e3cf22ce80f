//! Time to trace what a first-order response lacks, on one core: 400 rows and 20 000 rows.
//! The pieces of work are defined in `kempf_benches::works`.

fn main() {
    kempf_benches::harness::run(&kempf_benches::works::tracing());
}
