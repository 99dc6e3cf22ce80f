//! Time of studies: trials on one core and on all, resolving scenarios, drawing figures.
//! The pieces of work are defined in `kempf_benches::works`.

fn main() {
    kempf_benches::harness::run(&kempf_benches::works::studies());
}
