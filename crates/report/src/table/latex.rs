//! A table in LaTeX with the rules of `booktabs`. The characters this program writes (Greek, signs, sub- and
//! superscripts) become mathematics, so the result compiles without a Unicode engine.

use super::content::Table;
use super::width::Alignment;
use crate::printable::escaped;

impl Table {
    /// As LaTeX for the `booktabs` package, every character escaped or translated to mathematics.
    pub fn to_latex(&self) -> String {
        render(self)
    }
}

fn render(table: &Table) -> String {
    let mut out = String::from("\\begin{table}\n  \\centering\n");
    if let Some(title) = &table.title {
        out.push_str(&format!("  \\caption{{{}}}\n", escape(title)));
    }
    let spec: String = table.columns.iter().map(|c| if c.alignment == Alignment::Left { 'l' } else { 'r' }).collect();
    out.push_str(&format!("  \\begin{{tabular}}{{{spec}}}\n    \\toprule\n"));
    let heads: Vec<String> = table.columns.iter().map(|column| escape(&column.head())).collect();
    out.push_str(&format!("    {} \\\\\n    \\midrule\n", heads.join(" & ")));
    for row in &table.rows {
        let cells: Vec<String> = table.cells(row).map(|c| c.map_or_else(|| "--".into(), escape)).collect();
        let cells = cells.join(" & ");
        // A bracket or a star behind the end of the row before would belong to that.
        let guard = if cells.starts_with(['[', '*', '(']) { "{}" } else { "" };
        out.push_str(&format!("    {guard}{cells} \\\\\n"));
    }
    out.push_str("    \\bottomrule\n  \\end{tabular}\n\\end{table}\n");
    out
}

const GREEK: [(char, &str); 18] = [
    ('α', "alpha"),
    ('β', "beta"),
    ('γ', "gamma"),
    ('δ', "delta"),
    ('ε', "varepsilon"),
    ('ζ', "zeta"),
    ('θ', "theta"),
    ('λ', "lambda"),
    ('μ', "mu"),
    ('ν', "nu"),
    ('ρ', "rho"),
    ('σ', "sigma"),
    ('τ', "tau"),
    ('φ', "varphi"),
    ('χ', "chi"),
    ('ψ', "psi"),
    ('ω', "omega"),
    ('Δ', "Delta"),
];

fn escape(text: &str) -> String {
    let text = escaped(text);
    let mut out = String::with_capacity(text.len() + 8);
    let mut chars = text.chars().peekable();
    while let Some(c) = chars.next() {
        if let Some(plain) = script(c) {
            // A run of scripts of one kind becomes one group: 10⁻³ is $10^{-3}$.
            let mut run = String::from(plain.1);
            while let Some(next) = chars.peek().copied().and_then(script).filter(|next| next.0 == plain.0) {
                run.push(next.1);
                chars.next();
            }
            out.push_str(&format!("${}{{{run}}}$", plain.0));
            continue;
        }
        match c {
            '&' | '%' | '$' | '#' | '_' | '{' | '}' => {
                out.push('\\');
                out.push(c);
            }
            '\\' => out.push_str("\\textbackslash{}"),
            '~' => out.push_str("\\textasciitilde{}"),
            '^' => out.push_str("\\textasciicircum{}"),
            '<' => out.push_str("$<$"),
            '>' => out.push_str("$>$"),
            '|' => out.push_str("$|$"),
            '−' => out.push_str("$-$"),
            '±' => out.push_str("$\\pm$"),
            '×' => out.push_str("$\\times$"),
            '°' => out.push_str("$^\\circ$"),
            '–' => out.push_str("--"),
            _ => match GREEK.iter().find(|(letter, _)| *letter == c) {
                Some((_, name)) => out.push_str(&format!("$\\{name}$")),
                None => out.push(c),
            },
        }
    }
    out
}

/// `^` or `_` with the plain character of a super- or subscript.
fn script(c: char) -> Option<(char, char)> {
    const SUPER: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻";
    const SUB: &str = "₀₁₂₃₄₅₆₇₈₉₊₋";
    const PLAIN: &str = "0123456789+-";
    let find = |set: &str| set.chars().position(|s| s == c).and_then(|i| PLAIN.chars().nth(i));
    find(SUPER).map(|p| ('^', p)).or_else(|| find(SUB).map(|p| ('_', p)))
}
