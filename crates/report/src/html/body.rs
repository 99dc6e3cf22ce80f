//! Conversion of Markdown to the body of a page: headings with names to link to, tables that can be read row by row,
//! figures in place of images.

use std::collections::HashSet;

use pulldown_cmark::{Alignment, CowStr, Event, HeadingLevel, Options, Parser, Tag, TagEnd, html};

use super::escape::escaped;
use super::figures::{FigureFiles, SizeBudget};

/// Heading that can be linked to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct PageHeading {
    pub level: u8,
    pub id: String,
    pub text: String,
}

/// Body of a page as HTML, and its headings in order.
pub(super) struct Body {
    pub html: String,
    pub headings: Vec<PageHeading>,
}

/// Beginnings of permitted addresses on the web; a link with any other scheme leads to `#`.
const LINKS: [&str; 3] = ["https://", "http://", "mailto:"];

/// State of the conversion of a page, which is read from top to bottom.
struct BodyReader<'a, 'm> {
    images: &'a dyn Fn(&str) -> FigureFiles,
    /// Titles of the parts that are closed at first.
    folded: &'a [&'a str],
    /// Whether a folded part is being read, and whether its heading is being read.
    fold: (bool, bool),
    /// Remaining size for figures.
    room: SizeBudget,
    out: Vec<Event<'m>>,
    headings: Vec<PageHeading>,
    /// Ids that are already in the page.
    ids: HashSet<String>,
    /// Text of the latest section heading.
    section: String,
    /// Alignments of the columns of the latest table.
    alignments: Vec<Alignment>,
    /// Number of the next cell, and whether it is in a table head.
    cell: (usize, bool),
    /// Closing tag of the cell.
    cell_end: &'static str,
}

/// Body of a page, from its Markdown. `folded` are the titles of the parts that are closed at first; `images` finds the
/// files of a figure by its stem.
pub(super) fn from_markdown(markdown: &str, folded: &[&str], images: &dyn Fn(&str) -> FigureFiles) -> Body {
    let events: Vec<Event> =
        Parser::new_ext(markdown, Options::ENABLE_TABLES | Options::ENABLE_STRIKETHROUGH).collect();
    let mut reader = BodyReader {
        images,
        folded,
        fold: (false, false),
        room: SizeBudget::new(),
        out: Vec::with_capacity(events.len()),
        headings: Vec::new(),
        ids: HashSet::from(["report".to_owned(), "contents".to_owned()]),
        section: String::from("Table"),
        alignments: Vec::new(),
        cell: (0, false),
        cell_end: "",
    };
    reader.read(events);
    let mut text = String::new();
    html::push_html(&mut text, reader.out.into_iter());
    Body { html: text, headings: reader.headings }
}

/// Text of the element that begins at the event `start`, and the index of the event after it.
fn plain_text(events: &[Event], start: usize) -> (String, usize) {
    let (mut depth, mut text) = (0_usize, String::new());
    for (place, event) in events.iter().enumerate().skip(start) {
        match event {
            Event::Start(_) => depth += 1,
            Event::End(_) => depth -= 1,
            Event::Text(part) | Event::Code(part) | Event::InlineHtml(part) => text += part,
            Event::SoftBreak | Event::HardBreak => text.push(' '),
            _ => {}
        }
        if depth == 0 {
            return (text, place + 1);
        }
    }
    (text, events.len())
}

/// Text of a paragraph of emphasis alone that begins at the event `place`, and the index of the event after it; `None`
/// if no such paragraph begins there.
fn emphasis(events: &[Event], place: usize) -> Option<(String, usize)> {
    let is_begun = matches!(events.get(place)?, Event::Start(Tag::Paragraph))
        && matches!(events.get(place + 1)?, Event::Start(Tag::Emphasis));
    let (text, behind) = is_begun.then(|| plain_text(events, place + 1))?;
    matches!(events.get(behind)?, Event::End(TagEnd::Paragraph)).then_some((text, behind + 1))
}

impl<'m> BodyReader<'_, 'm> {
    fn read(&mut self, events: Vec<Event<'m>>) {
        let mut place = 0;
        while place < events.len() {
            if let Some(behind) = self.figure(&events, place) {
                place = behind;
                continue;
            }
            match &events[place] {
                Event::Start(Tag::Heading { level, .. }) => self.heading(*level, plain_text(&events, place).0),
                // A name for several rows is written once, so an empty cell below it is not the head of its row.
                Event::Start(Tag::TableCell) => {
                    self.begin_cell(matches!(events.get(place + 1), Some(Event::End(TagEnd::TableCell))));
                }
                event => self.event(event.clone()),
            }
            place += 1;
        }
        self.end_fold();
    }

    /// Ends the folded part that is being read, if there is one.
    fn end_fold(&mut self) {
        if std::mem::take(&mut self.fold).0 {
            self.html("</details>\n");
        }
    }

    fn html(&mut self, html: impl Into<CowStr<'m>>) {
        self.out.push(Event::Html(html.into()));
    }

    /// Writes the figure of a paragraph that is only an image, with the emphasised paragraph after it as its caption.
    /// Returns the index of the event after it; `None` if no such paragraph, of a PNG next to the page, begins at
    /// `place`.
    fn figure(&mut self, events: &[Event], place: usize) -> Option<usize> {
        let (Event::Start(Tag::Paragraph), Event::Start(Tag::Image { dest_url, .. })) =
            (&events[place], events.get(place + 1)?)
        else {
            return None;
        };
        let stem = dest_url.strip_suffix(".png").filter(|stem| !stem.contains(['/', '\\', ':']))?;
        let (name, behind) = plain_text(events, place + 1);
        if !matches!(events.get(behind)?, Event::End(TagEnd::Paragraph)) {
            return None;
        }
        let next = behind + 1;
        let (caption, end) = emphasis(events, next).unwrap_or_else(|| (name.clone(), next));
        let images = (self.images)(stem);
        let figure = self.room.figure(dest_url, [&name, &caption], &images);
        self.html(figure);
        Some(end)
    }

    fn heading(&mut self, level: HeadingLevel, text: String) {
        let slug: String = text.to_lowercase().chars().map(|c| if c.is_alphanumeric() { c } else { '-' }).collect();
        let slug = match slug.trim_matches('-') {
            "" => "section",
            slug => slug,
        };
        let mut id = slug.to_owned();
        let mut number = 2;
        while !self.ids.insert(id.clone()) {
            id = format!("{slug}-{number}");
            number += 1;
        }
        let level = level as u8;
        let is_folded = level == 2 && self.folded.contains(&text.as_str());
        if level <= 2 {
            self.end_fold();
            self.fold = (is_folded, is_folded);
        }
        let open = if is_folded { "<details>\n<summary>" } else { "" };
        self.html(format!("{open}<h{level} id=\"{}\">", escaped(&id)));
        self.section = text.clone();
        self.headings.push(PageHeading { level, id, text });
    }

    fn begin_cell(&mut self, is_empty: bool) {
        let class = match self.alignments.get(self.cell.0) {
            Some(Alignment::Right) => " class=\"right\"",
            Some(Alignment::Center) => " class=\"centre\"",
            _ => "",
        };
        let (tag, end) = match self.cell {
            _ if is_empty => ("td", "</td>"),
            (_, true) => ("th scope=\"col\"", "</th>"),
            (0, false) => ("th scope=\"row\"", "</th>"),
            _ => ("td", "</td>"),
        };
        self.cell_end = end;
        self.html(format!("<{tag}{class}>"));
    }

    fn event(&mut self, event: Event<'m>) {
        match event {
            Event::End(TagEnd::Heading(level)) => {
                let close = if std::mem::take(&mut self.fold.1) { "</summary>" } else { "" };
                self.html(format!("</h{}>{close}\n", level as u8));
            }
            Event::Start(Tag::Table(alignments)) => {
                self.alignments = alignments;
                let section = escaped(&self.section);
                self.html(format!(
                    "<div class=\"table\" role=\"group\" tabindex=\"0\" aria-label=\"Table: {section}\">\n<table>\n"
                ));
            }
            Event::End(TagEnd::Table) => self.html("</tbody>\n</table>\n</div>\n"),
            Event::Start(Tag::TableHead) => {
                self.cell = (0, true);
                self.html("<thead>\n<tr>");
            }
            Event::End(TagEnd::TableHead) => self.html("</tr>\n</thead>\n<tbody>\n"),
            Event::Start(Tag::TableRow) => {
                self.cell = (0, false);
                self.html("<tr>");
            }
            Event::End(TagEnd::TableRow) => self.html("</tr>\n"),
            Event::End(TagEnd::TableCell) => {
                self.cell.0 += 1;
                self.html(self.cell_end);
            }
            // Shown as text, not interpreted.
            Event::Html(text) | Event::InlineHtml(text) => self.out.push(Event::Text(text)),
            // An image in a line of words: no file is loaded for it.
            Event::Start(Tag::Image { dest_url, .. }) => self.html(format!("<a href=\"{}\">", target(&dest_url))),
            Event::End(TagEnd::Image) => self.html("</a>"),
            Event::Start(Tag::Link { dest_url, .. }) => self.html(format!("<a href=\"{}\">", target(&dest_url))),
            Event::End(TagEnd::Link) => self.html("</a>"),
            event => self.out.push(event),
        }
    }
}

/// Target of a link: an address on the web, or a path, which has no colon; `#` for any other, such as a script.
fn target(url: &str) -> String {
    let is_link = LINKS.iter().any(|link| url.starts_with(link));
    if is_link || !url.contains(':') { escaped(url) } else { String::from("#") }
}
