//! Test that `pdflatex` compiles all tables; skipped without `pdflatex`.

use std::fs;
use std::path::Path;
use std::process::Command;

use kempf_report::{Table, TableHead};

/// Maximum length by which a box may exceed the width of the text, points.
const OVERFULL: f64 = 5.0;

/// Characters that occur in tables of this program, and others.
const CHARACTERS: &str = "δ−²°ψ₀₁Σ–±ᵀ₂⁻σₖθ³τ√₃∂φ·′ξ¹…∫π½×ωνₙρΔ⁴β≤∞λ⁰≥⁵ᵢₚ₋₊ζγΦⱼχε₉⁹⁶ηΩº→₅₄μ¼ℓₘₒₑ⁷ᵏακ船µ≈∬∓∇←€ₛₐ⁸‖ᵖΓ鄱★●◆▼▲■™\
                          ₈₇₆ⁿ⁺›‹‰•‡†„”“‚’‘—ṙᵗΛʰƒ″∝≠ψ̇K̂K̃K̄r̈\u{a0}\u{2009}";
const LETTERS: &str = "éÄÅäöüßøåâáŸÿŽžŠšŒœÆæÇçĆćČčĎďĚěŁłŃńŇňŐőŘřŚśŞşŤťŮůŰűŹźŻż";

fn tables() -> Vec<Table> {
    // A caption breaks at spaces alone.
    let words = |text: &str| {
        text.split_inclusive(['·', '°', 'Δ', 'λ', 'ᵢ', '→', 'ᵏ', '≈', 'Γ', '◆', '▲', '■', 'ⁿ', '•', '—', '″', 'ÿ', 'Ě'])
            .collect::<Vec<_>>()
            .join(" ")
    };
    let mut characters = Table::new(TableHead::default().texts(["character"]).numbers(["K̂ of √T′"]).unit("1/s"))
        .titled(format!("{} & {} \\ ~^_#$%{{}}<>|\"'`", words(CHARACTERS), words(LETTERS)))
        .labelled("characters");
    for c in LETTERS.chars() {
        characters.push([format!("[{c}] * ψ̇"), "0.1003 ± 0.0007".to_owned()]);
    }
    let mut marks = Table::new(TableHead::default().texts(["mark"]).counts(["n"]));
    for c in CHARACTERS.chars().chain((32..127).map(char::from)) {
        marks.push([format!("{c}"), "12".to_owned()]);
    }
    let mut head = TableHead::default().texts(["trial", "method"]).counts(["failed"]);
    for index in ["K", "T", "K/T"] {
        head = head.numbers([format!("{index} median")]).unit("%").texts(["95 %"]);
        head = head.numbers([format!("{index} coverage")]).unit("%").numbers(["sd/bound"]);
    }
    let row = |number: usize| {
        let name = ["output-error", "characteristic-points", "integral-least-squares"][number % 3];
        let mut cells: Vec<String> = ["10/10", name, "0/1000"].map(str::to_owned).into();
        for _ in 0..3 {
            cells.extend(["−0.25 ± 0.12", "[−0.0143, 0.1470]", "–", "(1.234 ± 0.021)×10⁻¹²"].map(str::to_owned));
        }
        cells
    };
    let wide = |rows: usize| {
        let mut table = Table::new(head.clone()).titled(format!("Errors of K and T in {rows} rows")).labelled("wide");
        (0..rows).for_each(|number| table.push(row(number)));
        table
    };
    let mut prose = Table::new(TableHead::default().texts(["key", "meaning", "where"]));
    let sentence = "what a ship is asked to do in words, which may well be many of them and never end, as here";
    (0..30).for_each(|number| prose.push([format!("key{number}"), sentence.repeat(number % 4), sentence.into()]));
    let mut few = prose.clone();
    few.rows.truncate(4);
    let mut plain = Table::new(TableHead::default().numbers(["value"]).counts(["count"]).numbers(["words"]));
    plain.push(["1e5", "123456", "n/a"]);
    plain.push(["[1, 2]", "–", "no number"]);
    vec![
        characters,
        marks,
        wide(3),
        wide(10),
        wide(400),
        prose,
        few,
        plain,
        Table::new(TableHead::default().texts(["a"])),
        Table::default(),
    ]
}

#[test]
fn tables_compile_and_stay_within_the_text() {
    if Command::new("pdflatex").arg("--version").output().is_err() {
        eprintln!("skipped: there is no pdflatex");
        return;
    }
    let dir = std::env::temp_dir().join(format!("report-latex-{}", std::process::id()));
    fs::create_dir_all(&dir).unwrap();
    for (number, table) in tables().iter().enumerate() {
        compile(&dir, &format!("table{number}"), &table.to_latex());
    }
    fs::remove_dir_all(&dir).unwrap();
}

fn compile(dir: &Path, name: &str, table: &str) {
    let packages = table.lines().next().and_then(|line| Some(line.split_once("% Needs ")?.1.trim_end_matches('.')));
    let document = format!(
        "\\documentclass[a4paper]{{article}}\n{}\n\\begin{{document}}\n{table}.\n\\end{{document}}\n",
        packages.unwrap_or_default()
    );
    fs::write(dir.join(format!("{name}.tex")), document).unwrap();
    // The column widths of a long table are final only after the second pass.
    for _ in 0..2 {
        let run = Command::new("pdflatex")
            .args(["-interaction=nonstopmode", "-halt-on-error", name])
            .current_dir(dir)
            .output()
            .unwrap();
        assert!(run.status.success(), "{name}: {}", String::from_utf8_lossy(&run.stdout));
    }
    let log = String::from_utf8_lossy(&fs::read(dir.join(format!("{name}.log"))).unwrap()).into_owned();
    let too_wide = |line: &&str| {
        let size = line.strip_prefix("Overfull \\hbox (").and_then(|rest| rest.split_once("pt too wide"));
        size.is_some_and(|(size, _)| size.parse::<f64>().is_ok_and(|size| size > OVERFULL))
    };
    let wide: Vec<&str> = log.lines().filter(too_wide).collect();
    // A table over pages is as wide as its columns.
    assert!(wide.is_empty() || table.contains("longtable"), "{name}: {wide:?}");
    assert!(!log.contains("Missing character"), "{name}: {log}");
}
