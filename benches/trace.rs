//! Time to trace what a first-order response lacks, on one core: a simulated record and measured ones.
//! The pieces of work are defined in `kempf_benches::works`.

fn main() {
    kempf_benches::harness::run(&kempf_benches::works::tracing());
}
