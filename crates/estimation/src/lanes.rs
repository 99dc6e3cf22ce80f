//! Vector arithmetic. A [`Kernel`] is a loop over arrays of independent numbers; [`run`] has it compiled for every
//! instruction set of the family of processors and picks the widest that the machine has when the program runs.
//!
//! The bits do not depend on the choice: every lane does the operations of the source in their order, additions across
//! lanes are written out, and a compiler that honours IEEE 754 neither reorders nor fuses them. A machine without wide
//! registers takes the same steps with narrow ones. [`on_every_instruction_set`] is for the tests that prove it.

use pulp::Arch;
/// Loop over lanes: `call` has to be `#[inline(always)]`, or it stays compiled for the narrowest registers.
pub use pulp::NullaryFnOnce as Kernel;

/// Runs a kernel with the widest registers of this machine.
#[inline]
pub fn run<K: Kernel>(kernel: K) -> K::Output {
    Arch::new().dispatch(kernel)
}

/// Name of the widest instruction set of this machine.
pub fn instruction_set() -> &'static str {
    struct Nothing;
    impl Kernel for Nothing {
        type Output = ();

        fn call(self) {}
    }
    // The widest comes last.
    on_every_instruction_set(|| Nothing)
        .into_iter()
        .filter(|(name, ())| *name != "chosen")
        .map(|(name, ())| name)
        .next_back()
        .unwrap_or("plain")
}

/// Outputs of a kernel as plain code and with every instruction set of this machine, with the name of each.
pub fn on_every_instruction_set<K: Kernel>(kernel: impl Fn() -> K) -> Vec<(&'static str, K::Output)> {
    #[cfg_attr(not(target_arch = "x86_64"), expect(unused_mut, reason = "only one family has several sets"))]
    let mut outputs = vec![("plain", kernel().call()), ("chosen", run(kernel()))];
    #[cfg(target_arch = "x86_64")]
    {
        use pulp::x86::{V3, V4};
        outputs.extend(V3::try_new().map(|set| ("x86-64-v3", set.vectorize(kernel()))));
        outputs.extend(V4::try_new().map(|set| ("x86-64-v4", set.vectorize(kernel()))));
    }
    outputs
}
