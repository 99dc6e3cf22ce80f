use super::*;

const GOOD: &str = r#"
name = "own"
reference = "output-error"
[[measured]]
name = "tanker"
title = "A tanker"
download = "nowhere"
licence = "none"
cite = "nobody"
tasks.identify = ["a"]
tasks.other-side = [{ fit = ["a"], score = ["b"] }]
[[measured.record]]
name = "a"
manoeuvre = { zig-zag = { rudder-deg = 20.0, heading-deg = 20.0, first = "starboard" } }
copies = [{ file = "a.csv", sha256 = "0123456789012345678901234567890123456789012345678901234567890123" }]
[[measured.record]]
name = "b"
manoeuvre = { zig-zag = { rudder-deg = 20.0, heading-deg = 20.0, first = "port" } }
copies = [{ file = "b.csv", sha256 = "0123456789012345678901234567890123456789012345678901234567890123" }]
"#;

fn parse(text: &str) -> Result<Definition, Failure> {
    Definition::parse(Path::new("own.toml"), text, None, &|_, name| Err(format!("there is no {name}")))
}

#[test]
fn what_is_wrong_is_told_with_line_and_place() {
    let good = parse(GOOD).unwrap_or_else(|failure| panic!("{failure}"));
    assert_eq!(good.sets[0].questions.len(), 2);
    for (right, wrong, line, said) in [
        ("title =", "titel =", "own.toml:6:1", "unknown field `titel`"),
        ("score = [\"b\"]", "score = [\"c\"]", "own.toml:11:45", "there is no record \"c\""),
        ("score = [\"b\"]", "score = [\"a\"]", "own.toml:11:45", "the same angles to the other side first"),
        ("{ fit = [\"a\"], score", "{ score", "own.toml:11:", "is not whole"),
        ("name = \"b\"", "name = \"a\"", "own.toml:17:8", "two records are called \"a\""),
        ("name = \"tanker\"", "name = \"\"", "own.toml:5:8", "a set is called"),
        ("tasks.identify", "tasks.indices", "own.toml:10:", "only simulated ships have it"),
        ("sha256 = \"0123", "sha256 = \"z123", "own.toml:15:", "expected 64 hexadecimal digits"),
        ("first = \"port\"", "first = \"aft\"", "own.toml:18:", "unknown variant `aft`"),
        ("file = \"a.csv\"", "file = \"a.csv\", sidecar = \"x\"", "own.toml:15:", "there is no x"),
        ("\nname = \"own\"", "\nname = \"o/n\"", "own.toml:2:8", "the name of a file"),
    ] {
        assert!(GOOD.contains(right), "{right}");
        let error = parse(&GOOD.replacen(right, wrong, 1)).err().expect(wrong).to_string();
        assert!(error.contains(line) && error.contains(said), "{wrong}:\n{error}");
    }
    let nothing = parse("name = \"own\"\nreference = \"a\"").err().expect("no set").to_string();
    assert!(nothing.contains("own.toml") && nothing.contains("no set is defined"), "{nothing}");
}

#[test]
fn tasks_are_what_they_say() {
    let zig_zag = |rudder| Manoeuvre::zig_zag(rudder, 0.3);
    let [one, mirrored, small] = [zig_zag(0.3), zig_zag(0.3).to(trial::Side::Port), zig_zag(0.2)];
    let circle = Manoeuvre::turning_circle(0.6);
    let is_that = |task, fitted: &[&Manoeuvre], scored: &Manoeuvre| {
        is_that(task, &fitted.iter().map(|&one| one.clone()).collect::<Vec<_>>(), scored)
    };
    assert!(
        is_that(BenchTask::OtherSide, &[&one], &mirrored).is_ok()
            && is_that(BenchTask::OtherSide, &[&one], &small).is_err()
    );
    assert!(is_that(BenchTask::OtherAmplitude, &[&one, &mirrored], &small).is_ok());
    assert!(is_that(BenchTask::OtherAmplitude, &[&one, &small], &mirrored).is_err());
    assert!(
        is_that(BenchTask::Circle, &[&one], &circle).is_ok()
            && is_that(BenchTask::Circle, &[&circle], &circle).is_err()
    );
}

#[test]
fn sets_and_tasks_can_be_left_out() {
    let some = |sets: &[&str], tasks: &[BenchTask]| {
        let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
        Definition::published(None).unwrap_or_else(|failure| panic!("{failure}")).only(&sets, tasks)
    };
    let hulls = some(&["hulls"], &[BenchTask::Circle]).unwrap_or_else(|failure| panic!("{failure}"));
    assert_eq!(hulls.sets.iter().map(|set| set.questions.len()).collect::<Vec<_>>(), [1, 1, 1]);
    let unknown = some(&["hull"], &[]).err().expect("no such set").to_string();
    assert!(unknown.contains("--set hull") && unknown.contains("did you mean `hulls`"), "{unknown}");
    assert!(some(&["missing"], &[BenchTask::Circle]).is_err());
}
