//! Vector arithmetic. A [`Kernel`] is a loop over arrays of independent numbers; [`run_kernel`] compiles it for every
//! instruction set of the processor family and selects the widest one of the machine at run time.
//!
//! The results do not depend on the selection, to the last bit: every lane executes the operations of the source in
//! their order, additions across lanes are explicit, and a compiler that conforms to IEEE 754 neither reorders nor
//! fuses them. A machine without wide registers executes the same operations with narrow registers.
//! [`on_every_instruction_set`] serves the tests of this property.

use pulp::Arch;
/// Loop over lanes: `call` must be `#[inline(always)]`; otherwise it is compiled for the narrowest registers.
pub use pulp::NullaryFnOnce as Kernel;

/// Output of a kernel, run with the widest instruction set of this machine.
#[inline]
pub fn run_kernel<K: Kernel>(kernel: K) -> K::Output {
    Arch::new().dispatch(kernel)
}

/// Name of the widest x86-64 instruction set of this machine that kernels are compiled for; `plain` without one.
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

/// Outputs of a kernel as plain code and with every instruction set of this machine, each with its name.
pub fn on_every_instruction_set<K: Kernel>(kernel: impl Fn() -> K) -> Vec<(&'static str, K::Output)> {
    #[cfg_attr(not(target_arch = "x86_64"), expect(unused_mut, reason = "only one family has several sets"))]
    let mut outputs = vec![("plain", kernel().call()), ("chosen", run_kernel(kernel()))];
    #[cfg(target_arch = "x86_64")]
    {
        use pulp::x86::{V3, V4};
        outputs.extend(V3::try_new().map(|set| ("x86-64-v3", set.vectorize(kernel()))));
        outputs.extend(V4::try_new().map(|set| ("x86-64-v4", set.vectorize(kernel()))));
    }
    outputs
}
