//! The boat of Fuzhou, whose headings were interpolated between packets: no noise of the trace describes them.

use document::trace::Verdict;
use kempf_tests::measured::sets::SETS;
use trace::Settings;

/// Structures that replay a record no nearer than the base, under a noise that does not describe what they leave, name
/// nothing, whatever their probability. On her turning circle they are worse than the base by two and a half.
#[test]
fn interpolated_headings_name_no_effect() {
    let set = SETS.iter().find(|set| set.folder == "usv_fuzhou").expect("a set");
    if !set.is_there() {
        return eprintln!("skipped: no measured records {}", set.folder);
    }
    let scratch = tempfile::tempdir().expect("a folder");
    let trial = set.read(set.records[0], scratch.path()).expect("a record");
    let analysis = trace::trace(&[trial], &[], &Settings::default()).expect("a base");
    let document = analysis.document;
    assert!(document.effects.is_empty(), "{:?}", document.effects);
    assert_eq!(document.verdict, Verdict::Unexplained);
    assert!(!document.noise[0].describes_what_is_left);
    // The rule has something to hold back: the search found effects.
    assert!(document.candidates.iter().any(|own| own.probability > 0.9), "{:?}", document.candidates);
    assert!(document.error.kept_base.is_some_and(|words| words.contains("no effect is named")));
}
