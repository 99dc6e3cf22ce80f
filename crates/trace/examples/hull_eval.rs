use kempf_trace as trace;
use std::path::Path;
use trial::reader::read_with;
fn main() {
    let dir = "/work/shared/data/";
    let side = std::env::args().nth(2).unwrap_or("/work/main/scenarios/measured".into());
    let read = |set: &str, file: &str, side_name: &str| {
        read_with(
            Path::new(&format!("{dir}{set}/{file}.csv")),
            Some(Path::new(&format!("{side}/{side_name}.trial.toml"))),
        )
        .unwrap_or_else(|e| panic!("{file}: {e}"))
        .trial
    };
    let hsva: Vec<_> = ["20_10_s", "10_10_s", "15_05", "20_05", "30_05", "35_05", "10_05", "05_01"]
        .iter()
        .map(|n| read("kvlcc2_hsva", &format!("zigzag_{n}"), "kvlcc2_hsva"))
        .collect();
    let marin: Vec<_> = ["zigzag_20", "zigzag_-20", "zigzag_10", "turning_35"]
        .iter()
        .map(|n| read("kvlcc2_marin", n, "kvlcc2_marin"))
        .collect();
    let esso: Vec<_> = ["zigzag_13_04_24", "zigzag_13_14_21", "zigzag_13_42_53", "zigzag_13_57_45", "zigzag_14_10_05"]
        .iter()
        .map(|n| read("esso_osaka", n, n))
        .collect();
    let which = std::env::args().nth(1).unwrap_or("all".into());
    let run = |label: &str, fitted: &[trial::Trial], held: &[trial::Trial]| {
        let t0 = std::time::Instant::now();
        let settings = trace::Settings { hulls: std::env::var("NO_HULLS").is_err(), ..trace::Settings::default() };
        let a = match trace::trace(fitted, held, &settings) {
            Ok(a) => a,
            Err(e) => {
                println!("{label}: {e}");
                return;
            }
        };
        let pooled = |all: &[trace::comparison::RecordComparison]| -> String {
            let mut out = String::new();
            for k in 0..3 {
                let of = |e: &trace::replay_errors::ReplayErrors| {
                    if k == 0 { e.heading } else { e.horizon[k - 1].unwrap_or(f64::NAN) }
                };
                let (mut x, mut y, mut g) = (0.0, 0.0, 0.0);
                for one in all {
                    let (b, c) = (of(&one.before.errors), of(&one.after.errors));
                    x += c * c * one.after.errors.rows as f64;
                    y += b * b * one.after.errors.rows as f64;
                    g += (c / b).ln();
                }
                out += &format!("{:.2} (geo {:.2}) ", (x / y as f64).sqrt(), (g / all.len() as f64).exp());
            }
            out
        };
        println!(
            "{label}: {:.1}s hulls {:?} fitted {} HELD {}",
            t0.elapsed().as_secs_f64(),
            a.hulls.iter().map(|h| h.form.as_str()).collect::<Vec<_>>(),
            pooled(&a.identification),
            pooled(&a.validation)
        );
        if std::env::var("SPEED").is_ok() {
            use ship::{Dynamics, Replayable};
            for h in &a.hulls {
                let ship = h.ship::<f64>();
                print!("   {}:", h.form.as_str());
                for trial in held {
                    let rec = trace::record::PreparedRecord::whole(trial);
                    let rd = rec.recorded(&ship);
                    let mut st = vec![0.0; 4];
                    ship.enter(rec.heading[0], 0.0, &rd.input(rec.time[0], 0.0), &mut st);
                    let n = rec.time.len();
                    let sp = rec.speed.as_ref().unwrap();
                    let sw = rec.sway.as_ref().unwrap();
                    let (mut e, mut f) = (0.0, 0.0);
                    let u0 = ship.speed;
                    ship::replay::replay_states(
                        &ship,
                        &rd,
                        &rec.time,
                        |_, _| ship.largest_step(),
                        &mut st,
                        |i, s, _| {
                            e += ((s[2].hypot(s[3]) - sp.at(rec.time[i])) / u0).powi(2);
                            f += ((s[3] - sw.at(rec.time[i])) / u0).powi(2);
                        },
                    );
                    print!(
                        " {} {:.3}/{:.3} end {:.2}/{:.2}",
                        trial.name(),
                        (e / n as f64).sqrt(),
                        (f / n as f64).sqrt(),
                        st[2].hypot(st[3]) / u0,
                        sp.at(rec.time[n - 1]) / u0
                    );
                }
                println!();
            }
        }
        if std::env::var("SHOW").is_ok() {
            for h in &a.hulls {
                for (c, v) in h.expected.iter().zip(h.values.iter()) {
                    print!(" {}={:.3}({:+.1})", c.key, v, (v - c.mean) / c.sd);
                }
                println!(
                    " J={:.1} {:?}",
                    h.objective,
                    h.records.iter().map(|r| (r.whole.to_degrees(), r.window.to_degrees())).collect::<Vec<_>>()
                );
            }
            for one in &a.validation {
                let (b, c) = (&one.before.errors, &one.after.errors);
                println!(
                    "   {:20} {:.2} -> {:.2} | {:?} -> {:?}",
                    one.name,
                    b.heading.to_degrees(),
                    c.heading.to_degrees(),
                    b.horizon.map(|x| (x.unwrap_or(f64::NAN).to_degrees() * 100.0).round() / 100.0),
                    c.horizon.map(|x| (x.unwrap_or(f64::NAN).to_degrees() * 100.0).round() / 100.0)
                );
            }
        }
    };
    let is = |x: &str| which == "all" || which == x;
    if is("hsva") {
        run("HSVA 20/10 -> 7", &hsva[..1], &hsva[1..]);
        run("HSVA three -> 5", &hsva[..3], &hsva[3..]);
    }
    if is("marin") {
        run("MARIN ±20 -> 10", &marin[..2], &marin[2..3]);
        run("MARIN ±20 -> circle", &marin[..2], &marin[3..]);
    }
    if is("esso") {
        run("Esso three -> two", &esso[..3], &esso[3..]);
        run("Esso five", &esso[..5], &[]);
    }
    if is("single") {
        for i in 0..8 {
            let held: Vec<_> = (0..8).filter(|j| *j != i).map(|j| hsva[j].clone()).collect();
            run(&format!("single {}", hsva[i].name()), &hsva[i..=i], &held);
        }
    }
}
