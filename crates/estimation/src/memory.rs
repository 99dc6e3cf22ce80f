//! Memory of a process.

/// Size of the block that is allocated and freed, bytes; the GNU allocator ignores blocks above 32 MiB.
const BLOCK: usize = 16 << 20;

/// Keeps freed memory in the process, so that work space that is freed and allocated again costs no page faults.
///
/// The GNU allocator returns freed memory to the system above twice the size of the largest mapped block that was freed
/// (mallopt(3), `M_MMAP_THRESHOLD`). One block, which is never written, raises that limit from 128 KiB to 32 MiB. Other
/// allocators are unaffected. For the main function of a program.
pub fn keep_freed_memory() {
    drop(std::hint::black_box(Vec::<u8>::with_capacity(BLOCK)));
}

#[cfg(all(test, target_os = "linux", target_env = "gnu"))]
mod tests {
    use super::*;

    /// Page faults of this thread without access to a disk.
    fn page_faults() -> u64 {
        let status = std::fs::read_to_string("/proc/thread-self/stat").expect("the status of a thread");
        // The name of the program, in brackets, is field 2; the faults are field 10.
        let (_, fields) = status.rsplit_once(')').expect("a name in brackets");
        fields.split_whitespace().nth(7).and_then(|field| field.parse().ok()).expect("a number of faults")
    }

    /// Four blocks of 25 pages each, 50 times.
    #[test]
    fn blocks_that_are_freed_and_allocated_again_cost_no_page_faults() {
        keep_freed_memory();
        let before = page_faults();
        for _ in 0..50 {
            std::hint::black_box([(); 4].map(|()| vec![1_u8; 100 << 10]));
        }
        let faults = page_faults() - before;
        assert!(faults < 10 * 4 * 25, "{faults}");
    }
}
