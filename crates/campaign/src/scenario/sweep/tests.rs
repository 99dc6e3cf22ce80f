use super::*;

fn axis(text: &str) -> Result<SweepAxis, KeyFault> {
    toml::from_str::<AxisWire>(text).expect("well formed").resolve(0)
}

#[test]
fn ranges_hit_both_ends() {
    let log = axis("key = \"a.b\"\nlog = { from = 0.01, to = 1.0, points = 3 }").expect("valid");
    let values: Vec<f64> = log.points.iter().filter_map(|point| point.value).collect();
    assert!((values[1] - 0.1).abs() < 1e-12 && (values[2] - 1.0).abs() < 1e-12, "{values:?}");
    assert_eq!(log.points[1].label, "0.1");
    assert!(axis("key = \"a\"\nlog = { from = 0.0, to = 1.0, points = 3 }").is_err());
    assert!(axis("key = \"a\"").is_err());
    assert!(axis("key = \"a\"\nlinear = { from = 0.0, to = 1.0, points = 1000000000000000 }").is_err());
    assert!(axis("key = \"seed\"\nvalues = [1, 2]").is_err(), "a seed is not part of the design");
}

#[test]
fn labels_have_few_digits_whatever_the_size() {
    let sizes = axis("key = \"a\"\nvalues = [1e308, -2.34567e-30, 1e-12, 0.1, 12345.6, 0]").expect("six values");
    let labels: Vec<&str> = sizes.points.iter().map(|point| point.label.as_str()).collect();
    assert_eq!(labels, ["1e308", "-2.346e-30", "1e-12", "0.1", "12346", "0"]);
    let refused = SweepSetting {
        key: KeyPath::from_dotted("a"),
        value: Value::Float(1e308),
        key_place: KeyPath::default(),
        value_place: KeyPath::default(),
    }
    .attributed(KeyFault::value(KeyPath::from_dotted("a"), "`b` is wrong", "", ""), None);
    assert_eq!(refused.problem, "the sweep sets `a` to 1e308: `b` is wrong");
}

#[test]
fn points_can_be_told_apart() {
    let near = axis("key = \"a\"\nvalues = [1.00001, 1.00002]").expect("two values");
    assert_eq!([&near.points[0].label, &near.points[1].label], ["1.00001", "1.00002"]);
    assert!(axis("key = \"a\"\nvalues = [1, 1.0]").is_err(), "the same value twice");
    let once = axis("key = \"a\"\nvalues = [1]").expect("one value");
    assert!(combine_points(&[once.clone(), once]).is_err(), "the same key twice");
}

#[test]
fn cells_are_the_product_in_order() {
    let two = axis("key = \"x\"\nvalues = [1, 2]").expect("valid");
    let named = axis("name = \"trial\"\npoints = [{ label = \"p\", set = { \"m.r\" = 10, \"m.h\" = 20 } }, { label = \"q\", set = {} }]")
        .expect("valid");
    let axes = [two, named];
    let cells = combine_points(&axes).expect("few");
    let labels: Vec<Vec<&str>> =
        cells.iter().map(|cell| cell.iter().map(|point| point.label.as_str()).collect()).collect();
    assert_eq!(labels, [["1", "p"], ["1", "q"], ["2", "p"], ["2", "q"]]);
}

#[test]
fn sets_keys_in_tables_and_arrays() {
    let mut document: Table = "x = 1\n[[identifier]]\nsrivc = {}".parse().expect("well formed");
    let mut set = |key: &str, value: Value| super::set_key(&mut document, &KeyPath::from_dotted(key), value);
    set("sensor.noise", Value::Float(0.5)).expect("makes the table");
    set("identifier.0.srivc.n", Value::Integer(3)).expect("indexes the array");
    assert!(set("x.y", Value::Integer(1)).is_err());
    assert!(set("identifier.4.x", Value::Integer(1)).is_err());
    assert_eq!(document["sensor"]["noise"].as_float(), Some(0.5));
    assert_eq!(document["identifier"][0]["srivc"]["n"].as_integer(), Some(3));
}
