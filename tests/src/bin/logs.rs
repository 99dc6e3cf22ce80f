//! Writes the stored logs to `tests/logs`; see [`kempf_tests::logs`].

use std::fs;
use std::io;

use kempf_tests::logs;

fn main() -> io::Result<()> {
    let folder = logs::folder();
    fs::create_dir_all(&folder)?;
    for file in logs::all().iter().filter(|file| file.kept) {
        fs::write(folder.join(file.name), &file.bytes)?;
    }
    fs::write(folder.join("README.md"), logs::page())
}
