use std::path::Path;

use std::sync::Arc;

use super::*;
use crate::design::{CellFacts, Design};
use crate::folder::ResultFolder;
use ::trace::Verdict;
use scenario::{MethodName, Words};

fn design() -> Design {
    let cell = |noise: f64, trial: &str| CellFacts {
        labels: vec![noise.to_string(), trial.to_owned()],
        values: vec![Some(noise), None],
        trials: 0..1,
        missing: Vec::new(),
        has_own_indices: false,
        is_nearest: false,
        bound_percent2: None,
    };
    let method = |label: &str| MethodName { label: label.into(), id: label.into() };
    Design {
        axes: vec!["noise [°]".into(), "trial".into()],
        methods: vec![method("output-error"), method("srivc")],
        predicts: false,
        draws: vec!["ship.first-order.K-per-s".into()],
        cells: vec![cell(0.1, "10/10"), cell(0.5, "10/10")],
        words: Words::default(),
    }
}

fn good(replicate: u64) -> StudyRow {
    StudyRow {
        cell: 1,
        replicate,
        method: 0,
        true_k_per_s: Some(0.1),
        true_t_s: Some(16.3),
        bound: Some([1e-4, 2e-2, 3e-6]),
        k_per_s: Some(0.1001 + replicate as f64 * 1e-9),
        k_ci95_per_s: Some([0.0999, 0.1003]),
        t_s: Some(16.31),
        rudder_bias_deg: Some(-0.2),
        rudder_bias_ci95_deg: Some([-0.3, -0.1]),
        heading_rmse_deg: Some(0.1),
        validation_rmse_deg: Some(0.2),
        evaluations: Some(90.0),
        stop: Some("converged"),
        drawn: Some([0.1].into()),
        ..StudyRow::default()
    }
}

fn failed(replicate: u64) -> StudyRow {
    StudyRow {
        cell: 1,
        replicate,
        method: 1,
        failure: Some("not-excited".into()),
        drawn: Some([0.1].into()),
        ..StudyRow::default()
    }
}

fn write(path: &Path, layout: &RowLayout, pieces: impl IntoIterator<Item = Vec<StudyRow>>) {
    let (folder, name) = (path.parent().expect("in a folder"), path.file_name().and_then(|name| name.to_str()));
    let folder = ResultFolder::hold(folder).expect("held");
    let mut writer = RowWriter::create(&folder, name.expect("a name"), layout).expect("created");
    pieces.into_iter().for_each(|rows| writer.push(rows).expect("written"));
    writer.finish().and_then(|(file, _)| file.put()).expect("finished");
}

fn read(path: &Path, layout: &RowLayout) -> Vec<StudyRow> {
    let mut rows = Vec::new();
    let reader = RowReader::open(path, layout).expect("opened");
    reader
        .for_each(|row| {
            rows.push(row);
            Ok(())
        })
        .expect("read");
    rows
}

#[test]
fn rows_come_back_as_they_went() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("rows.parquet");
    let layout = RowLayout::of(&design());
    let rows = vec![good(7), failed(7)];
    write(&path, &layout, [rows.clone()]);
    assert_eq!(read(&path, &layout), rows);
    assert!(!folder.path().join("rows.parquet.tmp").exists());
}

#[test]
fn traces_have_columns_of_their_own() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("rows.parquet");
    let mut design = design();
    design.methods[1].id = scenario::TRACE.into();
    let layout = RowLayout::of(&design);
    let effect = |id: &str, aliases: &[&str]| NamedEffect {
        id: id.into(),
        aliases: aliases.iter().map(|&alias| alias.into()).collect(),
    };
    let answer = |verdict: Verdict, named: Vec<NamedEffect>| {
        let answer = TraceAnswer {
            verdict,
            named,
            probabilities: vec![("speed_loss".into(), 0.25), ("wind_moment".into(), 1.0)],
            margin: Some(31.5),
            expected: None,
            band_fitted: Some(0.95),
            band_held_out: None,
        };
        StudyRow { method: 1, traced: Some(Box::new(answer)), ..good(7) }
    };
    let named = vec![effect("wind_moment", &["port_starboard_asymmetry"]), effect("speed_loss", &[])];
    let rows = vec![good(7), answer(Verdict::Traced, named), answer(Verdict::Clean, Vec::new())];
    write(&path, &layout, [rows.clone()]);
    assert_eq!(read(&path, &layout), rows);
    assert!(layout.names().any(|name| name == "trace_margin"));
}

#[test]
fn the_bytes_do_not_depend_on_the_pieces() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let layout = RowLayout::of(&design());
    let (one, many) = (folder.path().join("one.parquet"), folder.path().join("many.parquet"));
    // More than a row group, and more than a batch of the reader.
    let rows: Vec<StudyRow> = (0..35_000).flat_map(|replicate| [good(replicate), failed(replicate)]).collect();
    write(&one, &layout, [rows.clone()]);
    write(&many, &layout, rows.chunks(7919).map(<[StudyRow]>::to_vec));
    assert!(std::fs::read(&one).expect("there") == std::fs::read(&many).expect("there"));
    assert!(read(&many, &layout) == rows);
}

#[test]
fn rows_of_another_study_are_refused() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("rows.parquet");
    write(&path, &RowLayout::of(&design()), [vec![good(0)]]);
    let refused = |design: &Design| {
        let layout = RowLayout::of(design);
        let mut reader = RowReader::open(&path, &layout)?;
        reader.next_rows().map(drop)
    };
    let other_axis = Design { axes: vec!["sampling [s]".into(), "trial".into()], ..design() };
    let message = refused(&other_axis).expect_err("another axis").message;
    assert!(message.contains("rows.parquet") && message.contains("axis.sampling [s]"), "{message}");
    let other_method = Design { methods: design().methods.split_off(1), ..design() };
    let message = refused(&other_method).expect_err("another method").message;
    assert!(message.contains("output-error"), "{message}");
    std::fs::write(&path, "no Parquet").expect("written");
    assert!(refused(&design()).is_err());
}

#[test]
fn axes_and_draws_are_columns() {
    let names: Vec<String> = RowLayout::of(&design()).names().collect();
    assert_eq!(names[..COLUMNS.len()], COLUMNS.map(|column| column.name));
    assert_eq!(names[COLUMNS.len()..], ["axis.noise [°]", "axis.trial", "draw.ship.first-order.K-per-s"]);
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
    let near = |found: Option<f64>, expected: f64| (found.expect("a truth") - expected).abs() < 1e-12;
    assert!(row.errors().into_iter().zip([0.1, -2.0, -2.1]).all(|(found, expected)| near(found, expected)));
    assert_eq!(StudyRow { true_k_per_s: None, ..row.clone() }.errors()[0], None);
    assert_eq!(StudyRow { t_s: Some(0.0), ..row }.errors()[2], None, "an infinite error is none");
}

#[test]
fn every_column_is_documented() {
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/src/reference/results.md"))
        .expect("the page is there");
    for RowColumn { name, meaning, .. } in
        COLUMNS.iter().chain(&OWN_COLUMNS).chain(&TRACE_COLUMNS).chain(&PREDICT_COLUMNS)
    {
        let meaning = meaning.replace('|', "\\|");
        assert!(page.contains(&format!("| `{name}` | {meaning} |")), "{name}: {meaning}");
    }
}

/// A study that predicts has one column more, and reads from it what was written.
#[test]
fn predictions_are_stored_and_read_again() {
    let design = Design { predicts: true, ..design() };
    let figure = |truth: f64| PredictedFigure {
        name: "zig-zag 20/20 first_overshoot_deg".into(),
        truth,
        median: 1.0 / 3.0,
        ci90: [-0.1, 1e-17],
    };
    let own = StudyRow { predicted: Some([figure(0.1), figure(7.0)].into()), ..good(0) };
    let none = StudyRow { predicted: Some(Box::default()), ..good(1) };
    let layout = RowLayout::of(&design);
    let columns: Vec<_> = layout.take(&[own.clone(), none.clone()]).collect();
    assert_eq!(layout.put(columns, 2).expect("what was written"), [own, none]);
    assert_eq!(layout.names().filter(|name| name == "predicted").count(), 1);
}

/// 10⁹ trials of seven methods are 106 812 groups of rows, more than a signed number of 16 bits holds.
#[test]
fn a_file_may_have_more_groups_than_sixteen_bits_count() {
    use parquet::data_type::Int64Type;
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::file::writer::SerializedFileWriter;
    use parquet::schema::parser::parse_message_type;

    const GROUPS: i64 = 40_000;
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("groups.parquet");
    let schema = Arc::new(parse_message_type("message rows { required int64 number; }").expect("a schema"));
    let file = std::fs::File::create(&path).expect("a file");
    let mut file = SerializedFileWriter::new(file, schema, Arc::default()).expect("a writer");
    for number in 0..GROUPS {
        let mut group = file.next_row_group().expect("one more group");
        let mut column = group.next_column().expect("a column").expect("one column");
        column.typed::<Int64Type>().write_batch(&[number], None, None).expect("one number");
        column.close().expect("a column");
        group.close().expect("a group");
    }
    file.close().expect("a file");
    let file = SerializedFileReader::new(std::fs::File::open(&path).expect("a file")).expect("readable");
    assert_eq!((file.num_row_groups() as i64, file.metadata().file_metadata().num_rows()), (GROUPS, GROUPS));
    let last = file.get_row_iter(None).expect("rows").last().expect("a row").expect("readable");
    assert_eq!(last.get_column_iter().next().map(|(_, field)| field.to_string()), Some((GROUPS - 1).to_string()));
}
