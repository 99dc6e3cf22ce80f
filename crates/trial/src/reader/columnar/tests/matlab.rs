//! MATLAB files, written byte by byte.

use super::*;

/// A data element, filled up to eight bytes.
fn element(kind: u32, data: &[u8], big: bool) -> Vec<u8> {
    let word = |value: u32| if big { value.to_be_bytes() } else { value.to_le_bytes() };
    let mut bytes = [word(kind), word(data.len() as u32)].concat();
    bytes.extend(data);
    bytes.resize(bytes.len().next_multiple_of(8), 0);
    bytes
}

/// A variable of a class: its size, and its numbers as they are stored.
fn variable(name: &str, size: [u32; 2], class: u32, stored: u32, numbers: &[u8], big: bool) -> Vec<u8> {
    let words = |values: [u32; 2]| values.map(|value| if big { value.to_be_bytes() } else { value.to_le_bytes() });
    let parts = [
        element(6, &words([class, 0]).concat(), big),
        element(5, &words(size).concat(), big),
        element(1, name.as_bytes(), big),
        element(stored, numbers, big),
    ];
    element(14, &parts.concat(), big)
}

fn doubles(name: &str, size: [u32; 2], values: &[f64], big: bool) -> Vec<u8> {
    let bytes: Vec<u8> =
        values.iter().flat_map(|value| if big { value.to_be_bytes() } else { value.to_le_bytes() }).collect();
    variable(name, size, 6, 9, &bytes, big)
}

fn head(big: bool) -> Vec<u8> {
    let mut head = b"MATLAB 5.0 MAT-file, Platform: GLNXA64, Created on: Fri Nov 20 14:03:05 2026".to_vec();
    head.resize(124, b' ');
    head.extend(if big { *b"\x01\x00MI" } else { *b"\x00\x01IM" });
    head
}

/// A variable packed as by `save -v7`.
fn compressed(variable: &[u8]) -> Vec<u8> {
    let mut packed = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
    packed.write_all(variable).expect("memory takes all");
    let packed = packed.finish().expect("memory takes all");
    let mut bytes = [15_u32.to_le_bytes(), (packed.len() as u32).to_le_bytes()].concat();
    bytes.extend(packed);
    bytes
}

fn plain(rows: usize, big: bool) -> Vec<Vec<u8>> {
    let [time, heading, rudder] = columns().map(|values| values[..rows].to_vec());
    let n = rows as u32;
    let heading = doubles("heading_deg", [1, n], &heading, big);
    vec![doubles("t_s", [n, 1], &time, big), heading, doubles("rudder_deg", [n, 1], &rudder, big)]
}

#[test]
fn vectors_are_columns_in_either_order_of_bytes_and_packed() {
    for big in [false, true] {
        assert_plain(&[head(big), plain(240, big).concat()].concat());
    }
    let packed: Vec<u8> = plain(240, false).iter().flat_map(|variable| compressed(variable)).collect();
    assert_plain(&[head(false), packed].concat());
}

#[test]
fn other_variables_are_left_out() {
    let text = variable("ship", [1, 4], 4, 16, b"Esso", false);
    let mut variables = vec![
        doubles("mass", [1, 1], &[5.0], false),
        text.clone(),
        compressed(&text),
        doubles("table", [300, 2], &[1.0; 600], false),
        variable("", [1, 4], 9, 2, b"keep", false),
    ];
    variables.extend(plain(240, false));
    assert_plain(&[head(false), variables.concat()].concat());
    let nothing = [head(false), variables[..3].concat(), doubles("cube", [1, 1], &[2.0], false)].concat();
    let parts = ["a MATLAB file without a table", "mass (1x1)", "cube (1x1)", "ship (text)"];
    assert_refused(parse(&nothing), &parts);
}

/// A cell array is no column: the name of a channel is refused; next to the same channel it is omitted.
#[test]
fn cell_arrays_are_named() {
    let cell = |name: &str| variable(name, [240, 1], 1, 14, &element(14, &[0; 64], false), false);
    let [time, heading, rudder] = &plain(240, false)[..] else { panic!("three variables") };
    for cell in [cell("rudder_deg"), compressed(&cell("rudder_deg"))] {
        let file = [&head(false), time, heading, &cell].map(Vec::as_slice).concat();
        assert_refused(parse(&file), &["column rudder_deg is a cell array", "cell2mat(rudder_deg)"]);
    }
    let (head, other, note) = (head(false), cell("heading_rad"), cell("note"));
    let beside = [&head, time, &other, heading, &note, rudder];
    assert_plain(&beside.map(Vec::as_slice).concat());
    assert_refused(parse([head, note].concat().as_slice()), &["without a table", "note (a cell array)"]);
}

/// A variable of level 4: its digits, size, whether it is complex, and its numbers.
fn variable4(name: &str, digits: u32, size: [u32; 2], complex: bool, numbers: &[u8], big: bool) -> Vec<u8> {
    let word = |value: u32| if big { value.to_be_bytes() } else { value.to_le_bytes() };
    let digits = digits + if big { 1000 } else { 0 };
    let head = [digits, size[0], size[1], u32::from(complex), name.len() as u32 + 1].map(word).concat();
    [&head, name.as_bytes(), &[0], numbers].concat()
}

#[test]
fn files_of_level_4_are_read_as_those_of_level_5() {
    let doubles = |name: &str, size: [u32; 2], values: &[f64], big: bool| {
        let bytes: Vec<u8> =
            values.iter().flat_map(|value| if big { value.to_be_bytes() } else { value.to_le_bytes() }).collect();
        variable4(name, 0, size, false, &bytes, big)
    };
    let [time, heading, rudder] = columns();
    let mut file = Vec::new();
    for big in [false, true] {
        file = [
            doubles("t_s", [240, 1], &time, big),
            variable4("ship", 51, [1, 4], false, b"Esso", big),
            variable4("waves", 0, [240, 1], true, &[0; 3840], big),
            variable4("map", 2, [240, 3], false, &[0; 5760], big),
            doubles("heading_deg", [1, 240], &heading, big),
            doubles("rudder_deg", [240, 1], &rudder, big),
        ]
        .concat();
        assert_plain(&file);
    }
    assert_refused(parse(&file[..file.len() - 9]), &["a MATLAB file", "last variable is incomplete"]);
    assert_refused(parse([file, vec![1; 40]].concat().as_slice()), &["a MATLAB file", "contradicts itself"]);
    let small = [
        variable4("a", 20, [2, 1], false, &[0xff, 0xff, 0xff, 0xff, 1, 0, 0, 0], false),
        variable4("b", 10, [1, 2], false, &[0.1_f32, f32::NAN].map(f32::to_le_bytes).concat(), false),
        variable4("c", 50, [2, 1], false, &[3, 255], false),
    ];
    let mut text = String::new();
    let kind = crate::reader::columnar::BinaryFormat::detect(&small.concat()).expect("a MATLAB file");
    kind.read_as_text(small.concat()).expect("a table").read_to_string(&mut text).expect("UTF-8");
    assert_eq!(text, "a\tb\tc\n-1\t0.1\t3\n1\t\t255\n");
    let small = small.concat();
    for index in 0..small.len() {
        for change in [0xff, 1 << (index % 8)] {
            let mut bytes = small.clone();
            bytes[index] ^= change;
            let _ = (parse(&bytes), parse(&small[..index]));
        }
    }
    // Other bytes are not a file of level 4: a text, UTF-16, other numbers.
    for other in [&b"t_s,heading_deg,rudder_deg\n"[..], b"t\0_\0s\0", &[0; 64], &[0x35, 0, 0, 0, 1, 0, 0, 0]] {
        assert_eq!(crate::reader::columnar::BinaryFormat::detect(other), None);
    }
}

#[test]
fn matrices_and_numbers_of_every_kind_are_columns() {
    // Short names and few numbers are in the tag of their element.
    let short = |kind: u32, data: &[u8]| {
        let mut bytes = (((data.len() as u32) << 16) | kind).to_le_bytes().to_vec();
        bytes.extend(data);
        bytes.resize(8, 0);
        bytes
    };
    let size = [2_u32.to_le_bytes(), 1_u32.to_le_bytes()].concat();
    let flags = [6_u32.to_le_bytes(), [0; 4]].concat();
    let parts = [element(6, &flags, false), element(5, &size, false), short(1, b"b"), short(2, &[3, 255])].concat();
    let singles = [0.1_f32, f32::NAN].map(f32::to_le_bytes).concat();
    let file = [
        head(false),
        doubles("a", [2, 3], &[1.5, f64::NAN, 3.0, 4.0, 5.0, 6.0], false),
        element(14, &parts, false),
        variable("c", [2, 1], 8, 1, &[0xff, 1], false),
        variable("d", [1, 2], 7, 7, &singles, false),
    ]
    .concat();
    let mut text = String::new();
    crate::reader::columnar::BinaryFormat::Matlab
        .read_as_text(file)
        .expect("a table")
        .read_to_string(&mut text)
        .expect("UTF-8");
    assert_eq!(text, "a_1\ta_2\ta_3\tb\tc\td\n1.5\t3.0\t5.0\t3\t-1\t0.1\n\t4.0\t6.0\t255\t1\t\n");
}

#[test]
fn damaged_files_are_told() {
    let plain = plain(30, false);
    let packed: Vec<u8> = plain.iter().flat_map(|variable| compressed(variable)).collect();
    for file in [[head(false), plain.concat()].concat(), [head(false), packed].concat()] {
        let mut bytes = file.clone();
        for index in 0..file.len() {
            for change in [0xff, 1 << (index % 8)] {
                bytes[index] ^= change;
                let _ = parse(&bytes);
                bytes[index] = file[index];
            }
        }
        for end in (10..file.len()).step_by(7) {
            let _ = parse(&file[..end]).expect_err("it is cut short");
        }
        assert_refused(parse(&file[..file.len() - 9]), &["a MATLAB file", "damaged"]);
        assert_refused(parse(&file[..100]), &["a MATLAB file", "head is incomplete"]);
    }
}
