use ::trace::TraceVerdict;
use document::trace::Dependence;

use super::columns::{Access, RECORD_COLUMNS};
use super::*;
use crate::design::{CellFacts, Design};
use crate::scenario::{MethodName, MissingPhysics};

fn design() -> Design {
    let cell = |noise: f64, trial: &str| CellFacts {
        labels: vec![noise.to_string(), trial.to_owned()],
        values: vec![Some(noise), None],
        stored_replicates: 0..1,
        ..CellFacts::default()
    };
    let method = |label: &str| MethodName { label: label.into(), id: label.into() };
    Design {
        axes: vec!["noise [°]".into(), "trial".into()],
        methods: vec![method("output-error"), method("srivc")],
        drawn_keys: vec!["ship.first-order.K-per-s".into()],
        cells: vec![cell(0.1, "10/10"), cell(0.5, "10/10")],
        ..Design::default()
    }
}

fn good(replicate: u64) -> StudyRow {
    StudyRow {
        cell: 1,
        replicate,
        method: 0,
        true_k_per_s: Some(0.1),
        true_t_s: Some(16.3),
        cramer_rao_sd: Some([1e-4, 2e-2, 3e-6]),
        k_per_s: Some(0.1001 + replicate as f64 * 1e-9),
        k_ci95_per_s: Some([0.0999, 0.1003]),
        t_s: Some(16.31),
        rudder_bias_deg: Some(-0.2),
        rudder_bias_ci95_deg: Some([-0.3, -0.1]),
        heading_rmse_deg: Some(0.1),
        validation_rmse_deg: Some(0.2),
        evaluations: Some(90.0),
        stop_reason: Some("converged"),
        drawn_values: Some([0.1].into()),
        ..StudyRow::default()
    }
}

fn failed(replicate: u64) -> StudyRow {
    StudyRow {
        cell: 1,
        replicate,
        method: 1,
        failure: Some("not-excited".into()),
        drawn_values: Some([0.1].into()),
        ..StudyRow::default()
    }
}

/// The label of the second block of the second cell.
fn label() -> BlockLabel {
    BlockLabel { design: "d".into(), seed: 1, program: "p".into(), cell: 1, block: 1 }
}

/// Trials of the second block, from its first on.
fn trials(count: u64) -> Vec<StudyRow> {
    (256..256 + count).flat_map(|replicate| [good(replicate), failed(replicate)]).collect()
}

fn written(rows: &[StudyRow], layout: &RowLayout) -> Vec<u8> {
    encode(rows, &label(), layout).expect("plain values")
}

/// Parameters of effects are read as written, and belong to the named effects.
#[test]
fn sizes_of_effects_belong_to_the_effects_named() {
    let size = |symbol: &str, value, sd| EffectParameterValue { symbol: symbol.into(), value, sd };
    let effect = |id: &str, parameters| NamedEffect { id: id.into(), parameters, ..NamedEffect::default() };
    let named = vec![
        effect("speed_loss", vec![size("m_a", 0.1 + 0.2, Some(1e-17)), size("e_n′", -0.0, None)]),
        effect("wind_moment", Vec::new()),
    ];
    let row = |named| StudyRow {
        traced: Some(Box::new(TraceRow { named_effects: named, ..TraceRow::default() })),
        ..good(0)
    };
    let [.., column] = &RECORD_COLUMNS;
    let Access::Text(get, set) = column.access else { panic!("{} is a text", column.name) };
    for named in [named, Vec::new()] {
        let whole = row(named.clone());
        let text = get(&whole).expect("a trace has sizes").into_owned();
        let without = named.iter().map(|effect| NamedEffect { parameters: Vec::new(), ..effect.clone() }).collect();
        let mut read = row(without);
        assert_eq!(set(&mut read, &text), Ok(()));
        assert_eq!(read, whole);
    }
    let mut unread = row(vec![effect("speed_loss", Vec::new())]);
    for text in ["m_a=1+e=2", "m_a", "m_a=x", "m_a=1±x"] {
        assert!(set(&mut unread, text).is_err(), "{text}");
    }
}

/// Results of a trace and predicted characteristics are read as written.
#[test]
fn traces_and_predictions_have_columns_of_their_own() {
    let mut design = Design { predicts: true, ..design() };
    design.methods[1].id = crate::scenario::TRACE_ID.into();
    design.cells[1].physics = Some(MissingPhysics::Nothing { disturbed: false });
    let layout = RowLayout::from_design(&design);
    let effect = |id: &str, aliases: &[&str], time_s| NamedEffect {
        id: id.into(),
        aliases: aliases.iter().map(|&alias| alias.into()).collect(),
        time_s,
        parameters: Vec::new(),
    };
    let (depends_on, form, alternatives) =
        (Dependence::YawRate, "moment with r|r|".into(), vec!["a".into(), "b".into()]);
    let moment = LocatedMoment { depends_on, form, from_s: Some(1.0 / 3.0), until_s: None, alternatives };
    let answer = |verdict: TraceVerdict, named: Vec<NamedEffect>| {
        let answer = TraceRow {
            verdict,
            named_effects: named,
            located_moments: vec![moment.clone(); 2],
            probabilities: vec![("speed_loss".into(), 0.25), ("wind_moment".into(), 1.0)],
            evidence_margin: Some(31.5),
            expected_2_ln_lambda: None,
            fitted_band_coverage: Some(0.95),
            validation_band_coverage: None,
        };
        StudyRow { method: 1, traced: Some(Box::new(answer)), ..good(256) }
    };
    let named = vec![effect("wind_moment", &["port_starboard_asymmetry"], Some(-0.1)), effect("speed_loss", &[], None)];
    let name = "zig-zag 20/20 first_overshoot_deg";
    let figure = |truth| PredictedCharacteristic { name: name.into(), truth, median: 1.0 / 3.0, ci90: [-0.1, 1e-17] };
    let predicts = StudyRow { predictions: Some([figure(0.1), figure(7.0)].into()), ..good(256) };
    let none =
        StudyRow { replicate: 257, predictions: Some(Box::default()), ..answer(TraceVerdict::Clean, Vec::new()) };
    let rows = vec![predicts, answer(TraceVerdict::Traced, named), good(257), none];
    assert_eq!(decode(written(&rows, &layout), &label(), &layout), Ok(rows));
    assert_eq!(layout.names().filter(|name| ["trace_margin", "predicted"].contains(&name.as_str())).count(), 2);
    // Without stated physics no column contains located moments.
    design.cells[1].physics = None;
    assert_eq!(RowLayout::from_design(&design).names().count(), layout.names().count() - LOCATED_COLUMNS.len());
}

#[test]
fn a_block_is_read_as_it_was_written() {
    let layout = RowLayout::from_design(&design());
    for count in [0, 1, 100, 256] {
        let rows = trials(count);
        assert_eq!(decode(written(&rows, &layout), &label(), &layout), Ok(rows));
    }
    let whole = trials(3);
    let not_whole = [&whole[1..], &whole[..5], &[&whole[2..], &whole[..2]].concat(), &trials(257)[..]];
    for rows in not_whole {
        let damage = decode(written(rows, &layout), &label(), &layout).expect_err("not whole trials in their order");
        assert!(matches!(damage, BlockFileError::Changed(_)), "{damage:?}");
    }
}

#[test]
fn blocks_of_something_else_are_told_from_damaged_ones() {
    let layout = RowLayout::from_design(&design());
    let bytes = written(&trials(2), &layout);
    let labels = [
        BlockLabel { design: "e".into(), ..label() },
        BlockLabel { seed: 2, ..label() },
        BlockLabel { program: "q".into(), ..label() },
        BlockLabel { cell: 0, ..label() },
        BlockLabel { block: 0, ..label() },
    ];
    for label_of_other in labels {
        assert_eq!(decode(bytes.clone(), &label_of_other, &layout), Err(BlockFileError::OtherBlock(label())));
    }
    let other_axis = Design { axes: vec!["sampling [s]".into(), "trial".into()], ..design() };
    let other_method = Design { methods: design().methods.split_off(1), ..design() };
    for other in [other_axis, other_method] {
        let damage = decode(bytes.clone(), &label(), &RowLayout::from_design(&other)).expect_err("other columns");
        assert!(matches!(damage, BlockFileError::Changed(_)), "{damage:?}");
    }
}

/// Any changed or missing byte is found, unless it carries no content.
#[test]
fn a_damaged_block_never_gives_other_rows() {
    let layout = RowLayout::from_design(&design());
    let rows = trials(4);
    let bytes = written(&rows, &layout);
    let mut detected = 0;
    for place in 0..bytes.len() {
        let mut damaged = bytes.clone();
        damaged[place] ^= 1 << (place % 8);
        let cut = bytes[..place].to_vec();
        assert!(decode(cut, &label(), &layout).is_err(), "cut at {place}");
        match decode(damaged, &label(), &layout) {
            Ok(read) => assert!(read == rows, "byte {place}"),
            Err(BlockFileError::OtherBlock(other)) => panic!("byte {place}: {other:?}"),
            Err(BlockFileError::Changed(_)) => detected += 1,
        }
    }
    assert!(3 * detected > bytes.len(), "{detected} of {}", bytes.len());
}

#[test]
fn axes_and_draws_are_columns() {
    let names: Vec<String> = RowLayout::from_design(&design()).names().collect();
    assert_eq!(names[..COMMON_COLUMNS.len()], COMMON_COLUMNS.map(|column| column.name));
    assert_eq!(names[COMMON_COLUMNS.len()..], ["axis.noise [°]", "axis.trial", "draw.ship.first-order.K-per-s"]);
}

#[test]
fn errors_are_relative_to_the_truth() {
    let row = StudyRow {
        k_per_s: Some(0.11),
        t_s: Some(-16.3),
        true_k_per_s: Some(0.1),
        true_t_s: Some(16.3),
        ..StudyRow::default()
    };
    let near = |error: Option<f64>, expected: f64| (error.expect("a truth") - expected).abs() < 1e-12;
    assert!(row.errors().into_iter().zip([0.1, -2.0, -2.1]).all(|(error, expected)| near(error, expected)));
    assert_eq!(StudyRow { true_k_per_s: None, ..row.clone() }.errors()[0], None);
    assert_eq!(StudyRow { t_s: Some(0.0), ..row }.errors()[2], None, "an infinite error is none");
}

#[test]
fn every_column_is_documented() {
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/src/reference/results.md"))
        .expect("the page is there");
    for RowColumn { name, meaning, .. } in
        COMMON_COLUMNS.iter().chain(&BASE_COLUMNS).chain(&TRACE_COLUMNS).chain(&RECORD_COLUMNS).chain(&PREDICT_COLUMNS)
    {
        let meaning = meaning.replace('|', "\\|");
        assert!(page.contains(&format!("| `{name}` | {meaning} |")), "{name}: {meaning}");
    }
}
