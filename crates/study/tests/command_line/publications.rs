//! `study publish`: what is made, left, gone on with, refused, and what is said of it; and what is published of the
//! repository.

use std::fs;

use campaign::manifest::ProgramRevision;
use study::work::publication::{ProgramStamp, published_files};

use crate::desk::{Desk, interrupted, of_repository};

/// A study of some trials of each of its two cells.
fn study(replicates: u32, noise_deg: f64) -> String {
    format!(
        "question = \"How much?\"\nfinding = \"Little.\"\nseed = 3\nreplicates = {replicates}\noutput.figure = \"errors\"\n\
         output.figures = [\"errors\"]\nship.yukun = {{}}\nmanoeuvre.zig-zag = {{ rudder-deg = 10.0, heading-deg = 10.0 }}\n\
         recording = {{ sampling-s = 2.0, duration-s = 200.0 }}\n[[sweep]]\nname = \"noise\"\n\
         key = \"sensor.heading-noise-deg\"\nvalues = [{noise_deg}, 0.3]\n\
         [[identifier]]\nmethod.integral-least-squares = {{}}\n[[identifier]]\nmethod.least-squares = {{}}\n"
    )
}

const PLAN: &str = "scenarios = \"../scenarios\"\n\
    [[program]]\nname = \"other\"\nquestion = \"What else?\"\nfinding = \"This.\"\npage = \"README.md\"\n\
    commands = [[\"cp\", \"words.md\", \"{folder}/README.md\"], [\"cp\", \"words.md\", \"{folder}/left.json\"]]\n\
    [[program]]\nname = \"trials\"\nquestion = \"What is measured?\"\npage = \"README.md\"\nneeds-records = true\n\
    commands = [[\"cp\", \"{records}/a.md\", \"{folder}/README.md\"]]\n\
    [[check]]\nname = \"words\"\ncommand = [\"grep\", \"-q\", \"Little.\", \"results/README.md\"]\n";

/// A folder with two studies, two programs and a check.
fn desk() -> Desk {
    let desk = Desk::new();
    desk.file("scenarios/one.toml", study(20, 0.1));
    desk.file("scenarios/two.toml", study(5, 0.2));
    desk.file("results/publish.toml", PLAN);
    desk.file("words.md", "words\n");
    desk.file("records/a.md", "measured\n");
    desk
}

const WHOLE: [&str; 4] = ["publish", "--data", "records", "--quiet"];

/// What is said of a name.
fn said(desk: &Desk, name: &str) -> String {
    let text = desk.text("results/changes.txt");
    let place = text.find(&format!("{name}: ")).unwrap_or_else(|| panic!("nothing of {name}:\n{text}"));
    text[place..].lines().next().unwrap_or_default().to_owned()
}

#[cfg(unix)]
#[test]
fn all_is_made_once_and_what_changes_is_said() {
    let desk = desk();
    desk.run(&WHOLE).is_done();
    let page = desk.text("results/README.md");
    for part in
        ["[other](published/other/README.md)", "This.", "[one](published/one/report.md)", "published/two/hero.png"]
    {
        assert!(page.contains(part), "{part} is missing in\n{page}");
    }
    assert_eq!(desk.text("results/published/trials/README.md"), "measured\n");
    assert!(!desk.path("results/before").exists());
    let stamp = ProgramStamp::read(&desk.path("results/published/other")).expect("readable").expect("a stamp");
    assert_eq!(stamp.program, campaign::manifest::ProgramRevision::own());
    // A figure that no page shows any more, and one more run, which has nothing to do.
    let manifest = desk.bytes("results/published/one/manifest.toml");
    desk.run(&WHOLE).is_done();
    assert_eq!(["one", "two", "other", "trials"].map(|name| said(&desk, name).contains("there already")), [true; 4]);
    assert!(manifest == desk.bytes("results/published/one/manifest.toml"));
    // Other words keep the rows, another design does not.
    desk.file("scenarios/two.toml", study(5, 0.2).replace("Little.", "Little. Indeed."));
    desk.file("scenarios/one.toml", study(20, 2.0));
    desk.file("results/published/one/old.png", "a figure that no page shows");
    desk.run(&WHOLE).is_done();
    assert!(!desk.path("results/published/one/old.png").exists());
    assert!(said(&desk, "two").contains("made; 1 file changed; 0 of "), "{}", said(&desk, "two"));
    assert!(!said(&desk, "one").contains(" 0 of ") && said(&desk, "one").contains("moved beyond noise"));
    let moved = desk.text("results/changes.txt");
    assert!(moved.contains("summary.csv") && moved.contains("] → "), "{moved}");
}

#[cfg(unix)]
#[test]
fn what_is_missing_or_fails_is_said_and_the_rest_is_made() {
    let desk = desk();
    desk.file("scenarios/two.toml", "question = 1\n");
    desk.file(
        "results/publish.toml",
        PLAN.replace("\"cp\", \"words.md\", \"{folder}/left", "\"false\", \"{folder}/left"),
    );
    let run = desk.run(&["publish", "--quiet"]);
    assert_eq!(run.code, Some(1), "{}", run.err);
    for part in
        ["two: ", "other: `false results/scratch/other/left.json` failed", "trials: it needs the measured records"]
    {
        assert!(run.err.contains(part), "{part}: {}", run.err);
    }
    assert!(said(&desk, "one").contains("made") && said(&desk, "words").contains("made"), "the rest was made");
    assert!(desk.path("results/before").is_dir(), "until all is whole, it is what changes are held against");
    assert!(!desk.path("results/published/other").exists(), "what failed takes no place");
    // The check fails.
    desk.file("scenarios/two.toml", study(5, 0.2).replace("Little.", "Much."));
    desk.file("scenarios/one.toml", study(20, 0.1).replace("Little.", "Much."));
    desk.file("results/publish.toml", PLAN);
    desk.run(&WHOLE).is_refused(1, &["not whole", "words: `grep -q Little. results/README.md` failed"]);
    for (arguments, said) in [
        (&["publish", "--only", "twos"][..], "did you mean `two`"),
        (&["publish", "scenarios"], "there is no publish.toml"),
        (&["publish", "--seed", "3"], "neither --seed nor --out"),
    ] {
        desk.run(arguments).is_refused(2, &[said]);
    }
    desk.file("results/publish.toml", "scenarios = \"../scenarios\"\nprogramme = 1\n");
    desk.run(&["publish"]).is_refused(2, &["results/publish.toml", "unknown field `programme`"]);
}

#[cfg(unix)]
#[test]
fn a_publication_that_was_stopped_goes_on() {
    let desk = desk();
    desk.file("scenarios/two.toml", study(10_000, 0.2));
    let begun = desk.path("results/published/two/unfinished/manifest.toml");
    let run = desk.start_until(&WHOLE, || begun.exists());
    std::thread::sleep(std::time::Duration::from_millis(500));
    let (run, _) = interrupted(run);
    assert!(run.code == Some(1) && run.err.contains("the same command goes on from there"), "{}", run.err);
    assert!(!desk.path("results/published/two/report.md").exists());
    let one = desk.bytes("results/published/one/manifest.toml");
    let run = desk.run(&["publish", "--data", "records"]);
    assert!(run.is_done().err.contains("going on after"), "{}", run.err);
    assert!(one == desk.bytes("results/published/one/manifest.toml"), "what was made is left");
    assert!(said(&desk, "one").contains("there already") && said(&desk, "two").contains("made"));
    desk.run(&["publish", "--only", "other", "--restart"]).is_done();
    assert!(said(&desk, "other").contains("made; 0 files") || !said(&desk, "other").contains("files changed"));
}

/// Published results are those of the scenarios as they are, and the page over them is what the command makes.
#[test]
fn published_results_belong_to_the_scenarios() {
    let desk = Desk::new();
    let results = of_repository("results");
    for entry in fs::read_dir(of_repository("scenarios")).expect("the folder is there") {
        let path = entry.expect("readable").path();
        let Some(name) = path.file_name().and_then(|name| name.to_str()?.strip_suffix(".toml")) else { continue };
        let manifest = results.join("published").join(name).join("manifest.toml");
        let manifest = fs::read_to_string(&manifest).unwrap_or_else(|error| panic!("{name}: {error}"));
        let manifest: toml::Table = manifest.parse().expect("it is TOML");
        let scenario = fs::read_to_string(&path).expect("it was just listed");
        assert!(manifest["scenario"].as_str() == Some(&scenario), "{name} was changed after its results were made");
    }
    fs::create_dir(desk.path("page")).expect("a new folder");
    desk.run(&["overview", &results.display().to_string(), "--out", "page", "--quiet"]).is_done();
    let made = fs::read_to_string(results.join("README.md")).expect("there is a page");
    assert!(made.as_bytes() == desk.bytes("page/README.md"), "run `study overview results` again");
}

/// The program that made each folder of the published results.
fn programs() -> Vec<(String, Option<ProgramRevision>)> {
    let published = of_repository("results/published");
    let names = campaign::disk::names(&published).expect("the folder is there");
    let program = |name: &String| {
        let folder = published.join(name);
        let manifest = campaign::manifest::Manifest::read(&folder.join("manifest.toml")).expect("a manifest, or none");
        let stamp = ProgramStamp::read(&folder).expect("a stamp, or none").map(|stamp| stamp.program);
        manifest.map(|manifest| manifest.program()).or(stamp)
    };
    names.iter().map(|name| (name.clone(), program(name))).collect()
}

/// Every folder was made by one version and a revision of it whose source is in the repository.
#[test]
fn published_results_are_of_one_version() {
    let programs = programs();
    let (_, first) = &programs[0];
    let version = first.as_ref().map(|first| &first.version);
    let is_clean =
        |own: &ProgramRevision| Some(&own.version) == version && !own.git_dirty && own.git_revision.is_some();
    let others: Vec<_> = programs.iter().filter(|(_, program)| !program.as_ref().is_some_and(is_clean)).collect();
    assert!(others.is_empty(), "not made by {first:?}; run `study publish`: {others:?}");
}

/// A clone is small.
#[test]
fn published_results_have_little_more_than_ten_megabytes() {
    let published = of_repository("results/published");
    let size = |file| fs::metadata(published.join(file)).expect("it was just listed").len();
    let total: u64 = published_files(&published).expect("the folder is there").iter().map(size).sum();
    assert!(total > 1_000_000 && total <= 10_200_000, "{total} bytes");
}
