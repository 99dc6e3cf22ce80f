use rayon::prelude::*;
use std::collections::BTreeMap;
use std::time::Instant;
use study::plan::Task;
use study::scenario::Scenario;

fn main() {
    let path = std::env::args().nth(1).unwrap();
    let verbose = std::env::args().nth(2).is_some();
    let scenario = Scenario::read(std::path::Path::new(&path), None).map_err(|e| e.to_string()).unwrap();
    for (number, cell) in scenario.cells.iter().enumerate() {
        let start = Instant::now();
        let results: Vec<_> = (0..scenario.replicates)
            .into_par_iter()
            .map(|replicate| {
                let simulated = study::engine::simulate(&scenario, Task { cell: number, replicate }).unwrap();
                let begin = Instant::now();
                let settings = trace::Settings { discovery: false, ..Default::default() };
                let result = trace::trace(std::slice::from_ref(&simulated.trial), &[], &settings);
                (result, begin.elapsed())
            })
            .collect();
        let mut counts: BTreeMap<String, usize> = BTreeMap::new();
        let (mut before, mut after, mut time) = (0.0, 0.0, 0.0);
        for (result, elapsed) in &results {
            time += elapsed.as_secs_f64();
            let name = match result {
                Err(error) => format!("ERR {error}"),
                Ok(analysis) => {
                    before += analysis.identification[0].before.errors.heading;
                    after += analysis.identification[0].after.errors.heading;
                    let all: Vec<String> = analysis
                        .effects
                        .iter()
                        .map(|e| {
                            let mut group: Vec<String> = e.aliases.iter().map(|(a, f)| format!("{a}:{f}")).collect();
                            group.truncate(4);
                            if verbose {
                                format!("{}:{} [{}] {:.0} ({})", e.id, e.form, e.parameters.iter().map(|p| format!("{}={:.3e}±{:.1e}", p.symbol, p.value, p.sd.unwrap_or(f64::NAN))).collect::<Vec<_>>().join(" "), e.evidence.gain, group.join(","))
                            } else {
                                format!("{}:{}", e.id, e.form)
                            }
                        })
                        .collect();
                    format!("{} {} {:?}", analysis.verdict.as_str(), all.join(" + "), analysis.refused)
                }
            };
            *counts.entry(name).or_default() += 1;
        }
        let n = results.len() as f64;
        println!(
            "== {:?}  before {:.3} after {:.3} deg; {:.1} ms per trace; wall {:.1} s",
            cell.labels,
            (before / n).to_degrees(),
            (after / n).to_degrees(),
            1e3 * time / n,
            start.elapsed().as_secs_f64()
        );
        let mut list: Vec<_> = counts.into_iter().collect();
        list.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        for (name, count) in list.iter().take(8) {
            println!("   {count:4} {name}");
        }
    }
}
