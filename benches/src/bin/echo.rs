//! An outside estimator that does nothing but answer: what is left of its time is that of asking it.

use std::io::{self, BufRead, Write};

fn main() -> io::Result<()> {
    let (mut input, mut output) = (io::stdin().lock(), io::stdout().lock());
    let mut line = Vec::new();
    while input.read_until(b'\n', &mut line)? > 0 {
        // A question begins with its number: {"trial":17,…
        let end = line.iter().position(|byte| *byte == b',').unwrap_or(line.len());
        output.write_all(&line[..end])?;
        output.write_all(b",\"K_per_s\":0.08,\"T_s\":25.0,\"delta_r_rad\":0.0}\n")?;
        output.flush()?;
        line.clear();
    }
    Ok(())
}
