use super::*;
use crate::palette::{Marker, UNHIGHLIGHTED};

fn pale(marker: Marker) -> CurveStyle {
    CurveStyle { colour: UNHIGHLIGHTED, marker, ..CurveOrigin::Truth.style() }
}

/// Row of marks of these shapes, each with a number.
fn numbered(markers: &[Marker]) -> RowsColumn {
    let item =
        |&marker: &Marker| RowItem { number: Some("1.0 %".into()), ..RowItem::mark_below("", pale(marker), 1.0, None) };
    RowsColumn { rows: vec![markers.iter().map(item).collect()], ..RowsColumn::default() }
}

#[test]
fn numbers_are_dark_and_have_room_for_their_marks_where_these_differ() {
    let theme = Theme::screen();
    let widths = |markers: &[Marker]| number_widths(&numbered(markers), &theme);
    let [single, alike, both] =
        [&[Marker::Circle][..], &[Marker::Circle; 2], &[Marker::Circle, Marker::Star]].map(widths);
    assert_eq!(alike, [single[0]; 2]);
    assert_eq!(both, [single[0] + theme.small_font; 2]);
    let column = numbered(&[Marker::Star]);
    let [(number, style)] = &numbers(&column.rows[0], &theme)[..] else { panic!("one number") };
    assert_eq!((number.colour, *style), (INK, Some(&pale(Marker::Star))));
}

#[test]
fn two_ranges_of_a_row_do_not_overlap() {
    let theme = Theme::screen();
    let range = || RowItem { place: RowPlace::Below, ..RowItem::new("", RowKind::WideInterval(INK, [0.0, 1.0])) };
    let distance = |count: usize| {
        let column = RowsColumn { rows: vec![vec![range(); count]], ..RowsColumn::default() };
        line_distance(&NamedRows { columns: vec![column], ..NamedRows::default() }, &theme)
    };
    let height = range_stroke(INK, &theme).width;
    assert!(distance(2) > height && distance(1) < distance(2), "{} {height}", distance(2));
}
