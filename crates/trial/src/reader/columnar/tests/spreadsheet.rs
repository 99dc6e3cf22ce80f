//! Spreadsheets, written by hand: a ZIP archive without compression, and its XML.

use super::*;

/// An archive of uncompressed files.
fn archive(files: &[(&str, String)]) -> Vec<u8> {
    let (mut bytes, mut list) = (Vec::new(), Vec::new());
    for (name, text) in files {
        let mut sum = flate2::Crc::new();
        sum.update(text.as_bytes());
        let begin = bytes.len() as u32;
        // Version, flags, method, time and date; sum, size packed, size; lengths of the name and of what follows it.
        let mut about = [20_u16, 0, 0, 0, 0x21].map(u16::to_le_bytes).concat();
        about.extend([sum.sum(), text.len() as u32, text.len() as u32].map(u32::to_le_bytes).concat());
        about.extend([name.len() as u16, 0].map(u16::to_le_bytes).concat());
        bytes.extend([b"PK\x03\x04", &about[..], name.as_bytes(), text.as_bytes()].concat());
        // Made by version; comment, disk, kind; rights and position.
        list.extend([b"PK\x01\x02\x14\x00", &about[..], &[0; 10], &begin.to_le_bytes(), name.as_bytes()].concat());
    }
    let begin = bytes.len() as u32;
    let count = (files.len() as u16).to_le_bytes();
    bytes.extend(&list);
    bytes.extend([b"PK\x05\x06\0\0\0\0".as_slice(), &count, &count].concat());
    bytes.extend([(list.len() as u32).to_le_bytes(), begin.to_le_bytes()].concat());
    bytes.extend([0, 0]);
    bytes
}

const MAIN: &str = "http://schemas.openxmlformats.org/spreadsheetml/2006/main";
const LINKS: &str = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";

/// A workbook of sheets, each with the XML of its rows. Style 1 is a date with time, style 2 a date, 3 a time.
fn book(sheets: &[String], is_1904: bool) -> Vec<u8> {
    let mut listed = String::new();
    let mut links = String::new();
    let mut files = Vec::new();
    let mut names = Vec::new();
    for (place, rows) in sheets.iter().enumerate() {
        let place = place + 1;
        listed += &format!("<sheet name=\"S{place}\" sheetId=\"{place}\" r:id=\"r{place}\"/>");
        links += &format!(
            "<Relationship Id=\"r{place}\" Type=\"{LINKS}/worksheet\" Target=\"worksheets/sheet{place}.xml\"/>"
        );
        let sheet = format!("<worksheet xmlns=\"{MAIN}\"><sheetData>{rows}</sheetData></worksheet>");
        names.push(format!("xl/worksheets/sheet{place}.xml"));
        files.push(sheet);
    }
    let package = "http://schemas.openxmlformats.org/package/2006/relationships";
    links += &format!("<Relationship Id=\"r0\" Type=\"{LINKS}/styles\" Target=\"styles.xml\"/>");
    let workbook = format!(
        "<workbook xmlns=\"{MAIN}\" xmlns:r=\"{LINKS}\"><workbookPr date1904=\"{}\"/>\
         <sheets>{listed}</sheets></workbook>",
        u8::from(is_1904)
    );
    let styles = [0, 22, 14, 21].map(|format| format!("<xf numFmtId=\"{format}\"/>")).concat();
    let root = format!("<Relationship Id=\"r1\" Type=\"{LINKS}/officeDocument\" Target=\"xl/workbook.xml\"/>");
    let mut all = vec![
        ("_rels/.rels", format!("<Relationships xmlns=\"{package}\">{root}</Relationships>")),
        ("xl/workbook.xml", workbook),
        ("xl/_rels/workbook.xml.rels", format!("<Relationships xmlns=\"{package}\">{links}</Relationships>")),
        ("xl/styles.xml", format!("<styleSheet xmlns=\"{MAIN}\"><cellXfs>{styles}</cellXfs></styleSheet>")),
    ];
    all.extend(names.iter().map(String::as_str).zip(files));
    archive(&all)
}

/// A row of cells: `s:` a text, `1:` to `3:` a number with this style, `b:` a boolean, `e:` an error, else a number.
fn row(place: usize, cells: &[String]) -> String {
    let cell = |(column, cell): (usize, &String)| {
        let at = format!("{}{place}", (b'A' + column as u8) as char);
        match cell.split_once(':') {
            Some(("s", words)) => format!("<c r=\"{at}\" t=\"inlineStr\"><is><t>{words}</t></is></c>"),
            Some((kind @ ("b" | "e"), value)) => format!("<c r=\"{at}\" t=\"{kind}\"><v>{value}</v></c>"),
            Some((style, value)) => format!("<c r=\"{at}\" s=\"{style}\"><v>{value}</v></c>"),
            None if cell.is_empty() => String::new(),
            None => format!("<c r=\"{at}\"><v>{cell}</v></c>"),
        }
    };
    format!("<row r=\"{place}\">{}</row>", cells.iter().enumerate().map(cell).collect::<String>())
}

fn sheet(header: [&str; 3], first: usize, count: usize, time: impl Fn(f64) -> String) -> String {
    let mut text = row(first, &header.map(|name| format!("s:{name}")));
    for (place, [t, psi, delta]) in rows().into_iter().take(count).enumerate() {
        text += &row(first + 1 + place, &[time(t), psi.to_string(), delta.to_string()]);
    }
    text
}

fn text(bytes: Vec<u8>) -> String {
    let mut text = String::new();
    crate::reader::columnar::BinaryFormat::Spreadsheet
        .read_as_text(bytes)
        .expect("a book")
        .read_to_string(&mut text)
        .expect("UTF-8");
    text
}

const HEADER: [&str; 3] = ["t_s", "heading_deg", "rudder_deg"];

#[test]
fn a_sheet_gives_the_record_of_its_csv() {
    assert_plain(&book(&[sheet(HEADER, 1, 240, |t| t.to_string())], false));
    // Ship and trial are above the table, and an unrelated sheet precedes it.
    let about = row(1, &["s:Ship".to_owned(), "s:Esso Osaka".to_owned()]);
    let table = format!("{about}{}", sheet(HEADER, 9, 240, |t| t.to_string()));
    let reading = assert_plain(&book(&[about.clone(), table], false));
    assert!(reading.warnings.iter().any(|warning| warning.text.contains("skipped")), "{:?}", reading.warnings);
    assert_refused(parse(&book(&[about], false)), &["run"]);
}

#[test]
fn stamps_of_both_calendars_are_those_of_the_csv() {
    let begin = 46_346.0 + (14.0 * 3600.0 + 3.0 * 60.0 + 5.0) / 86_400.0; // 2026-11-20T14:03:05
    let stamps = |t: f64| format!("2026-11-20T14:{:02}:{:02}", 3 + (5 + t as u32) / 60, (5 + t as u32) % 60);
    let lines = rows().iter().map(|[t, psi, delta]| format!("{},{psi},{delta}\n", stamps(*t))).collect::<String>();
    let csv = parse(format!("time,heading_deg,rudder_deg\n{lines}").as_bytes()).expect("stamps");
    for (is_1904, shift) in [(false, 0.0), (true, 1462.0)] {
        let serial = |t: f64| format!("1:{}", begin - shift + t / 86_400.0);
        let bytes = book(&[sheet(["time", "heading_deg", "rudder_deg"], 1, 240, serial)], is_1904);
        assert_same(&parse(&bytes).unwrap_or_else(|error| panic!("{error}")), &csv);
    }
}

#[test]
fn values_of_every_kind_are_written_as_text() {
    let cells = |cells: &[&str]| cells.iter().map(|&cell| cell.to_owned()).collect::<Vec<_>>();
    let rows = [
        row(1, &cells(&["s:# a remark"])),
        row(3, &cells(&["s:t_s", "s:heading_deg", "s:on", "s:date", "s:at", "s:time", "s:wrong"])),
        row(4, &cells(&["0.1", "", "b:1", "2:46346", "3:0.5", "1:46346"])),
        row(5, &cells(&["1e-7", "s:x", "b:0", "2:1", "3:0", "1:46346.25", "e:#N/A"])),
    ];
    let expected = "# a remark\t\t\t\t\t\t\n\nt_s\theading_deg\ton\tdate\tat\ttime\twrong\n\
                    0.1\t\t1\t2026-11-20\t12:00:00\t2026-11-20T00:00:00\t\n\
                    1e-7\tx\t0\t1900-01-01\t00:00:00\t2026-11-20T06:00:00\t\n";
    assert_eq!(text(book(&[rows.concat()], false)), expected);
}

#[test]
fn damaged_books_and_other_archives_are_told() {
    assert_sound(&book(&[sheet(HEADER, 1, 8, |t| t.to_string())], false), "(ZIP)");
    assert_refused(parse(&archive(&[("notes.txt", "nothing".to_owned())])), &["archive (ZIP) without", "CSV"]);
    let astray = [row(4, &["1".to_owned()]), row(2, &["1".to_owned()])].concat();
    assert_refused(parse(&book(&[astray], false)), &["a spreadsheet", "row 2 has no place"]);
}
