//! Time to predict a manoeuvre from a thousand drawn ships, on one core.
//! The pieces of work are defined in `kempf_benches::works`.

fn main() {
    kempf_benches::harness::run(&kempf_benches::works::prediction());
}
