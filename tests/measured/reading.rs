//! Measured trials as they are downloaded, where they are there: read through their sidecars they agree with their tidy
//! twins.

use std::path::{Path, PathBuf};

use document::Warning;
use kempf_tests::measured;
use ship::angle::from_deg;

use trial::{Channel, Columns, ReadRecord, Trial, plausibility, read, read_with_sidecar};

fn measured_sidecar(stem: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/measured").join(format!("{stem}.trial.toml"))
}

/// Maximum difference of a channel of `raw` from `tidy` at the times of `tidy` that lie in `raw`, and how many were
/// compared.
fn difference(raw: &Trial, tidy: &Trial, channel: Channel, tolerance_s: f64) -> (f64, usize) {
    let (mut largest, mut compared) = (0.0_f64, 0);
    let (found, expected) = (raw.channel(channel).expect("described"), tidy.channel(channel).expect("a column"));
    // Headings may differ by whole turns.
    let whole = |angle: f64| {
        if channel == Channel::Heading { (angle / std::f64::consts::TAU).round() * std::f64::consts::TAU } else { 0.0 }
    };
    for (row, &time) in tidy.time().iter().enumerate() {
        let after = raw.time().partition_point(|&t| t < time - tolerance_s);
        if after < raw.len() && (raw.time()[after] - time).abs() <= tolerance_s {
            let error = found[after] - expected[row];
            largest = largest.max((error - whole(error)).abs());
            compared += 1;
        }
    }
    (largest, compared)
}

/// `true` if the reader says of a record what is to be said: two antennas, as on the Esso Osaka, sometimes give the
/// same heading ten times and then another one, or jump; and there the order of the rudder was recorded for its angle.
fn are_expected(warnings: &[Warning], of_antennas: bool) -> bool {
    let of_esso = ["the heading is frozen", "the heading jumps", "the rudder jumps within a row"];
    warnings.iter().all(|warning| of_antennas && of_esso.iter().any(|begin| warning.text.starts_with(begin)))
}

#[test]
fn raw_files_agree_with_their_tidy_twins() {
    let data = measured::folder();
    if !data.is_dir() {
        return eprintln!("skipped: no measured trials in {}", data.display());
    }
    // Tidy values are rounded to five digits after the point, half a unit is 5e-6 (deg, deg/s, m, 1/s). The rebuilt
    // times of MARIN differ by at most 1 ms, from the digits of the step.
    let rounding = from_deg(5.1e-6);
    let cases = [
        ("HSVA_CPMC_KVLCC2_Z_20_10_S", "dat", "kvlcc2_hsva/zigzag_20_10_s.csv", 1901),
        ("MARIN_FREE_KVLCC2_zz_20_m", "dat", "kvlcc2_marin/zigzag_20.csv", 1121),
        ("esso_osaka_zigzag_31-Jul-2020_13_57_45", "csv", "esso_osaka/zigzag_13_57_45.csv", 817),
    ];
    for (stem, extension, twin, rows) in cases {
        let raw =
            read_with_sidecar(&data.join("raw").join(format!("{stem}.{extension}")), Some(&measured_sidecar(stem)));
        let raw = raw.unwrap_or_else(|error| panic!("{error}"));
        assert!(are_expected(&raw.warnings, stem.starts_with("esso")), "{stem}: {:?}", raw.warnings);
        let tidy = read(&data.join(twin)).unwrap_or_else(|error| panic!("{error}")).trial;
        for channel in [Channel::Heading, Channel::Rudder, Channel::YawRate, Channel::North, Channel::PropellerRate] {
            let (error, compared) = difference(&raw.trial, &tidy, channel, 1e-3);
            let allowed =
                if channel == Channel::North || channel == Channel::PropellerRate { 5.1e-6 } else { rounding };
            assert!(error <= allowed, "{stem} {channel:?}: {error:e}");
            assert_eq!(compared, rows, "{stem} {channel:?}");
        }
        assert!(raw.trial.particulars().is_some());
    }
    let stem = "esso_osaka_zigzag_31-Jul-2020_13_57_45";
    let raw = read_with_sidecar(&data.join(format!("raw/{stem}.csv")), Some(&measured_sidecar(stem)))
        .expect("read above")
        .trial;
    let tidy = read(&data.join("esso_osaka/zigzag_13_57_45.csv")).expect("read above").trial;
    for channel in
        [Channel::Speed, Channel::Sway, Channel::WindRelativeSpeed, Channel::WindRelativeFrom, Channel::WindTrueFrom]
    {
        let (error, _) = difference(&raw, &tidy, channel, 1e-6);
        assert!(error < 5.1e-6, "{channel:?}: {error:e}");
    }
}

#[test]
fn every_tidy_file_is_plausible_and_no_flipped_one_is() {
    let data = measured::folder();
    if !data.is_dir() {
        return eprintln!("skipped: no measured trials in {}", data.display());
    }
    let mut zig_zags = 0;
    for folder in ["kvlcc2_hsva", "kvlcc2_marin", "esso_osaka"] {
        for entry in std::fs::read_dir(data.join(folder)).expect("the folder of measured trials is complete") {
            let path = entry.expect("a readable folder").path();
            let stem = path.file_stem().and_then(|stem| stem.to_str()).expect("plain names").to_owned();
            let ReadRecord { trial, warnings } = read(&path).unwrap_or_else(|error| panic!("{error}"));
            let of_antennas = folder == "esso_osaka";
            assert!(are_expected(&warnings, of_antennas), "{stem}: {warnings:?}");
            let own = if folder == "esso_osaka" { stem.as_str() } else { folder };
            let sidecar = measured_sidecar(own);
            // Circles are not part of what is published.
            if stem.starts_with("zigzag") || sidecar.exists() {
                let described = read_with_sidecar(&path, Some(&sidecar)).unwrap_or_else(|error| panic!("{error}"));
                assert!(are_expected(&described.warnings, of_antennas), "{stem}: {:?}", described.warnings);
                assert!(described.trial.particulars().is_some());
            }

            let changed = |channel: Channel, factor: f64| {
                let mut channels: std::collections::BTreeMap<_, _> =
                    trial.channels().map(|(channel, values)| (channel, values.to_vec())).collect();
                channels.insert(Channel::Rudder, trial.rudder().to_vec());
                channels.get_mut(&channel).expect("every set has it").iter_mut().for_each(|value| *value *= factor);
                let columns = Columns { time: trial.time().to_vec(), channels, unknown_columns: Vec::new() };
                plausibility::check_plausibility(
                    &Trial::new(stem.clone(), trial.origin().clone(), columns).expect("complete"),
                )
            };
            let flipped = changed(Channel::Rudder, -1.0);
            if stem.starts_with("zigzag") {
                zig_zags += 1;
                assert!(
                    matches!(flipped, Err(plausibility::Implausibility::RudderFlipped { .. })),
                    "{stem} {flipped:?}"
                );
            } else {
                assert!(
                    flipped.expect("a turning circle alone is no proof")[0].text.contains("looks flipped"),
                    "{stem}"
                );
            }
            for (channel, factor) in [
                (Channel::YawRate, -1.0),
                (Channel::YawRate, 57.3),
                (Channel::YawRate, 1.0 / 57.3),
                (Channel::Rudder, 57.3),
                (Channel::Rudder, 1.0 / 57.3),
                (Channel::Heading, -1.0),
                (Channel::Heading, 57.3),
                (Channel::Heading, 1.0 / 57.3),
            ] {
                assert!(changed(channel, factor).is_err(), "{stem} {channel:?} times {factor} passes");
            }
        }
    }
    assert!(zig_zags >= 13, "{zig_zags}");
}
