//! `study predict`: predicted manoeuvres of an identified ship. The crate [`mod@predict`] computes the prediction; this
//! module reads the models and makes texts, tables, figures and files.

use std::path::{Path, PathBuf};

use document::{Warning, Warnings};
use predict::PredictDocument;
use predict::turn::{self, Current};
use report::Theme;
use trial::file::display_path;
use trial::{Sidecar, Trial};

use crate::documents::{self, PREDICT_FILE, draws, folder_for};
use crate::options::{CommonOptions, PredictRequest};
use crate::records::read_for_replay;
use crate::screen::{self, CommandOutput};
use crate::views::page_files::write_page;
use crate::views::{predict_curves, predict_form, predict_page, predict_tables};
use crate::work::earlier_trials::EarlierModel;
use crate::work::predict::{PredictInput, StoredModel, predict};
use campaign::failure::Failure;
use campaign::folder::ResultFolder;

/// Name of the form of MSC/Circ.1053.
const FORM: &str = "trial-form.md";

/// Predicts, prints the results, writes `predict.json`, `report.md`, `report.html`, tables and figures.
///
/// Fails if a model or a record cannot be read, or as [`predict()`] does.
pub fn run(request: &PredictRequest, common: &CommonOptions) -> Result<(), Failure> {
    let theme = request.style.theme()?;
    if !request.ballast.is_empty() && request.replays.is_empty() {
        return Err(Failure::input(
            "--ballast is the model of the ship in her trial condition, but no trial is given; name the record to correct to full load \
             with --replay",
        ));
    }
    let place = folder_for(PREDICT_FILE, &common.out.clone().unwrap_or_else(|| default_folder(&request.models[0])))?;
    let mut warnings = Warnings::default();
    let mut read = |paths: &[PathBuf]| -> Result<Vec<StoredModel>, Failure> {
        paths.iter().map(|path| StoredModel::from_file(path, request, &mut warnings)).collect()
    };
    let (models, ballast) = (read(&request.models)?, read(&request.ballast)?);
    let current = request.current_from.as_ref();
    let current = current.map(|path| current_from(path, request, &mut warnings)).transpose()?;
    let records: Vec<Trial> = read_for_replay(&request.replays, &request.reading(), &mut warnings)?;
    let columns = request.columns.as_deref().filter(|path| records.is_empty() && path.is_file());
    let declared = columns.map(Sidecar::load).transpose().map_err(Failure::input)?;
    let file = columns.map(|path| path.display().to_string());
    let declared_conditions = file.as_deref().zip(declared.as_ref().map(|sidecar| &sidecar.conditions));
    let earlier = EarlierModel::from_files(&request.priors)?;
    let (models, earlier_models, ballast_models) = (&models, &earlier, &ballast);
    let input = PredictInput { models, earlier_models, ballast_models, records, current, declared_conditions };
    let predicted = predict(request, input, common.quiet, &mut warnings)?;
    let folder = ResultFolder::make(&place)?;
    let text = documents::write_with_curves(&folder, PREDICT_FILE, &predicted, &predicted.curves())?;
    if request.draws_file {
        draws::write_ships(&folder, &predicted)?;
    }
    write_results(&folder, &predicted, &text, theme.as_ref(), common, &warnings.ranked())
}

/// Writes the figures and the page of a prediction into a folder and prints it; `text` is that of `predict.json`.
///
/// Fails if a file cannot be written.
pub fn write_results(
    folder: &ResultFolder,
    predicted: &PredictDocument,
    text: &str,
    theme: Option<&Theme>,
    common: &CommonOptions,
    warnings: &[Warning],
) -> Result<(), Failure> {
    for (stem, table) in predict_curves::curve_tables(predicted) {
        folder.write(&format!("{stem}.csv"), table)?;
    }
    write_page(folder, predict_page::page(predicted), theme)?;
    let mut notes = format!("\nresults: {}", folder.path().join(PREDICT_FILE).display());
    if let (Some(form), Some(remarks)) = (&predicted.form, &predicted.form_remarks) {
        folder.write(FORM, predict_form::page(form, remarks).to_markdown())?;
        notes += &format!("\nform:    {}", folder.path().join(FORM).display());
    }
    let [before, behind] = [predict_page::text_above_table(predicted), predict_page::text_below_table(predicted)];
    let table = predict_tables::characteristics_table(predicted);
    let output = CommandOutput { texts_around_table: [&before, &behind], table: &table, notes: &notes, document: text };
    screen::print_output(common, &output, warnings)
}

/// Default folder of the results, named after the folder of the model, which has the name of its record; after the file
/// if the model has no folder.
fn default_folder(model: &Path) -> PathBuf {
    let model = display_path(model);
    let named = |path: &Path| path.file_name().map(|name| name.to_string_lossy().into_owned());
    let name =
        model.parent().and_then(named).or_else(|| model.file_stem().map(|stem| stem.to_string_lossy().into_owned()));
    let name = name.filter(|name| !name.is_empty()).unwrap_or_else(|| String::from("model"));
    PathBuf::from(format!("{name}-predict"))
}

/// Current estimated from a record. Fails if the record is no turn of 720° or more with positions.
fn current_from(path: &Path, request: &PredictRequest, warnings: &mut Warnings) -> Result<Current, Failure> {
    let records = read_for_replay(std::slice::from_ref(&path.to_owned()), &request.reading(), warnings)?;
    records.first().and_then(turn::estimated_current).ok_or_else(|| {
        Failure::input(format!(
            "--current-from {}: no current can be read from this record; give a circle of 720° or more with positions north_m and east_m",
            path.display()
        ))
    })
}
