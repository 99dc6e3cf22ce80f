//! Time to simulate trials, beside the bare random numbers and a scalar integration. The pieces of work are defined in
//! `kempf_benches::works`.

fn main() {
    kempf_benches::harness::run(&kempf_benches::works::simulation());
}
