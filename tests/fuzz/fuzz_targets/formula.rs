#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    kempf_tests::fuzz::targets::formula(data);
});
