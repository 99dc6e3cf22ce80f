//! Time to identify K, T and δ_r from one record of 1201 rows by every method, beside the rivals.
//! The pieces of work are defined in `kempf_benches::works`.

fn main() {
    kempf_benches::harness::run(&kempf_benches::works::identification());
}
