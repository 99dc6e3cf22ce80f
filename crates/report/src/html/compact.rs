//! A drawing in fewer bytes: lines of one stroke that follow each other become one path, dots of one size and colour a
//! path of round points. What is seen is the same; a page carries several times as many figures.

use std::fmt::Write as _;

/// The elements of a drawing of this crate, compacted line by line; lines of another form stay as they are.
pub(super) fn compacted(elements: &str) -> String {
    let mut out = String::with_capacity(elements.len() / 2);
    let mut path = Path::default();
    for line in elements.lines() {
        match polyline(line).or_else(|| disc(line)) {
            Some((style, data)) => {
                if style != path.style {
                    path.put(&mut out);
                    path.style = style;
                }
                path.data += &data;
            }
            None => {
                path.put(&mut out);
                out.extend([line, "\n"]);
            }
        }
    }
    path.put(&mut out);
    out
}

/// Lines or dots of one style.
#[derive(Default)]
struct Path {
    style: String,
    data: String,
}

impl Path {
    fn put(&mut self, out: &mut String) {
        if !self.data.is_empty() {
            let _ = writeln!(out, "<path {} d=\"{}\"/>", self.style, self.data);
        }
        *self = Self::default();
    }
}

/// Style and data of an opaque line; where ink adds up, elements stay apart.
fn polyline(line: &str) -> Option<(String, String)> {
    let (style, points) = line.strip_prefix("<polyline ")?.strip_suffix("\"/>")?.split_once(" points=\"")?;
    if style.contains("opacity") {
        return None;
    }
    let mut data = String::new();
    let mut last: Option<(i64, i64)> = None;
    for point in points.split_whitespace() {
        let (x, y) = point.split_once(',')?;
        let (x, y): (i64, i64) = (x.parse().ok()?, y.parse().ok()?);
        let _ = match last {
            None => write!(data, "M{x} {y}l"),
            Some((before_x, before_y)) => write!(data, "{} {} ", x - before_x, y - before_y),
        };
        last = Some((x, y));
    }
    Some((style.to_owned(), data.trim_end().to_owned()))
}

/// Style and data of an opaque disc.
fn disc(line: &str) -> Option<(String, String)> {
    let rest = line.strip_prefix("<circle cx=\"")?;
    let (x, rest) = rest.split_once("\" cy=\"")?;
    let (y, rest) = rest.split_once("\" r=\"")?;
    let (radius, rest) = rest.split_once("\" fill=\"")?;
    let colour = rest.strip_suffix("\" stroke=\"none\" stroke-width=\"1\"/>")?;
    let width = 2 * radius.parse::<u32>().ok()?;
    let style = format!("stroke=\"{colour}\" stroke-width=\"{width}\" stroke-linecap=\"round\"");
    Some((style, format!("M{x} {y}h0")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_follows_each_other_in_one_style_is_one_path() {
        let line = |style: &str, points: &str| format!("<polyline fill=\"none\" {style} points=\"{points} \"/>\n");
        let dot = "<circle cx=\"3\" cy=\"4\" r=\"5\" fill=\"#111111\" stroke=\"none\" stroke-width=\"1\"/>\n";
        let drawn = line("stroke=\"#111111\"", "1,2 4,6 3,6")
            + &line("stroke=\"#111111\"", "9,9 9,0")
            + &line("stroke-opacity=\"0.5\"", "1,1 2,2")
            + dot
            + dot;
        assert_eq!(
            compacted(&drawn),
            "<path fill=\"none\" stroke=\"#111111\" d=\"M1 2l3 4 -1 0M9 9l0 -9\"/>\n\
             <polyline fill=\"none\" stroke-opacity=\"0.5\" points=\"1,1 2,2 \"/>\n\
             <path stroke=\"#111111\" stroke-width=\"10\" stroke-linecap=\"round\" d=\"M3 4h0M3 4h0\"/>\n"
        );
        assert_eq!(compacted("<text>\na < b\n</text>\n"), "<text>\na < b\n</text>\n");
    }
}
