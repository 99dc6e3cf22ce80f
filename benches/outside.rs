//! Time to ask an outside estimator about a record of 270 rows, without what it computes.
//! The pieces of work are defined in `kempf_benches::works`.

fn main() {
    kempf_benches::harness::run(&kempf_benches::works::outside(env!("CARGO_BIN_EXE_echo")));
}
