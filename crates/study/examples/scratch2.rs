use study::plan::Task;
use study::scenario::Scenario;
use trace::candidates::{self, Sizes};
use trace::fit::Problem;
use trace::noise::Colour;
use trace::record::Record;
use trace::search::{Search, Thresholds};
use trace::structure::Structure;
use identify::Identifier;
fn main() {
    let path = std::env::args().nth(1).unwrap();
    let cell: usize = std::env::args().nth(2).unwrap().parse().unwrap();
    let replicate: u64 = std::env::args().nth(3).unwrap().parse().unwrap();
    let scenario = Scenario::read(std::path::Path::new(&path), None).map_err(|e| e.to_string()).unwrap();
    let trial = study::engine::simulate(&scenario, Task { cell, replicate }).unwrap().trial;
    let base = identify::output_error::Settings::default().build().unwrap().identify(std::slice::from_ref(&trial)).unwrap();
    let replay = identify::replay::replay(&trial, &base.response).unwrap();
    let initial = vec![[replay.heading[0], replay.yaw_rate[0]]];
    let problem = Problem::new(vec![Record::averaged(&trial, base.response.T().abs())], base.response.inverse_T, base.response.K_over_T);
    let structure = Structure::base(1, false);
    let theta = vec![base.response.inverse_T, base.response.K_over_T, base.response.rudder_bias];
    let headings = problem.replay(&structure, &theta, &initial);
    let sizes = Sizes::of(&problem.records, base.response.inverse_T, &headings);
    let list = candidates::all(&problem.records, &sizes);
    let search = Search { problem: &problem, candidates: &list, thresholds: Thresholds { gain: 10.0, false_discovery: 0.01, most_terms: 4 } };
    let plain = problem.fit(&structure, &theta, &initial, &Colour::WHITE);
    println!("plain bic {:.1} rss {:.4e} replays {}", plain.bic, plain.rss, plain.replays);
    let linear = problem.linear(&structure, &plain.theta, &plain.initial, &problem.entries(&structure));
    for kind in [trace::noise::Moment::White, trace::noise::Moment::Walk] {
        for e in (-3..14).step_by(1) {
            let colour = Colour { moment: Some((kind, 10f64.powi(e))), waves: None };
            let (rss, lv) = linear.projected(&problem.whiteners(&colour));
            print!(" {:.1}", trace::fit::deviance(rss, lv, problem.observations() as f64));
        }
        println!();
        let (c, d) = problem.best_moment(&linear, kind, None);
        println!("  best {c:?} {d:.1}");
        let fit = problem.fit(&structure, &plain.theta, &plain.initial, &c);
        println!("  refit {:.1} theta {:?}", fit.deviance, fit.theta);
    }
    let start = search.base(structure, &theta, &initial);
    println!("base: plain {:.1} judged {:.1} {:?}", start.plain.bic, start.judged.bic, start.judged.colour);
    let first = search.try_all(&start, &start.plain, false);
    if std::env::args().nth(4).is_some() { for tried in &first {
        println!("  {} {:?} gain {:.1} p {:.1e} theta {:?}", tried.fit.replays, list[tried.place].term.name(), tried.evidence.gain, tried.evidence.p_value, &tried.fit.theta[3..]);
    }}
    let model = search.run(&start, &first);
    println!("final plain {:.1} judged {:.1} {:?}", model.plain.bic, model.judged.bic, model.judged.colour);
    for (place, (e, less)) in search.tested(&model, true).into_iter().enumerate() {
        let under = problem.fit(&model.structure, &model.plain.theta, &model.plain.initial, &less.judged.colour);
        let lm = less.judged.deviance - under.deviance;
        println!("   {:?} LM {lm:.1}", model.structure.terms[place].name());
        println!("  gain {:.1} p {:.1e}; without: plain {:.1} judged {:.1} {:?}", e.gain, e.p_value, less.plain.bic, less.judged.bic, less.judged.colour);
    }
}
