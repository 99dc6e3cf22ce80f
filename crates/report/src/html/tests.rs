use std::collections::HashSet;

use super::*;

const PAGE: &str = "# A study\n\n**What?** See <b>x</b> and [other](other.md), [bad](javascript:run).\n\n## First & last\n\n\
                    | method | error |\n|---|---:|\n| `a` | 0.12 ± 0.03 |\n| <script>b</script> | – |\n\n## First & last\n\n\
                    ![A curve of ψ](curve.png)\n\n*A curve of ψ*\n\n![A cloud](cloud.png)\n\nWords.\n\n![Gone](gone.png)\n";

fn images(stem: &str) -> FigureFiles {
    let svg = |shapes: &str| {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"72.000pt\" height=\"36.000pt\" viewBox=\"0 0 9 9\">{shapes}</svg>\n"
        )
    };
    match stem {
        "curve" => FigureFiles { svg: Some(svg("<path/>")), png: None },
        "cloud" => FigureFiles { svg: Some(svg(&"<circle/>".repeat(40_000))), png: Some(b"pixels".to_vec()) },
        "huge" => FigureFiles { svg: None, png: Some(vec![0; 1_000_000]) },
        _ => FigureFiles::default(),
    }
}

fn made(markdown: &str) -> String {
    page(markdown, &["Last"], &images).expect("a page")
}

#[test]
fn a_page_needs_no_other_file() {
    let page = made(PAGE);
    for resource in ["src=\"http", "@import", "url(", "<link", "http://", "https://", "src=\"//"] {
        assert!(!page.contains(resource), "{resource}");
    }
    assert_eq!(page.matches(" src=").count(), 1);
    assert!(page.contains("src=\"data:image/png;base64,cGl4ZWxz\""), "many shapes become pixels");
    assert_eq!(page, made(PAGE));
}

#[test]
fn words_of_others_are_shown_and_not_obeyed() {
    let page = made(PAGE);
    assert!(page.contains("&lt;b&gt;x&lt;/b&gt;") && page.contains("&lt;script&gt;b&lt;/script&gt;"));
    assert!(!page.contains("javascript:") && page.contains("<a href=\"other.md\">other</a>"));
    assert_eq!(made("# a</title><script>alert(1)</script>\n").matches("<script>").count(), 1, "its own");
}

#[test]
fn every_name_is_given_once() {
    let page = made(PAGE);
    let ids: Vec<&str> = page.split(" id=\"").skip(1).filter_map(|tail| tail.split('"').next()).collect();
    assert_eq!(ids.iter().collect::<HashSet<_>>().len(), ids.len(), "{ids:?}");
    assert!(ids.contains(&"first---last") && ids.contains(&"first---last-2"));
}

#[test]
fn figures_stand_with_their_caption_once() {
    let page = made(PAGE);
    assert_eq!(page.matches(">A curve of ψ</figcaption>").count(), 1);
    assert_eq!(page.matches("A curve of ψ").count(), 1, "neither beside it nor as the name of the image");
    assert!(!page.contains("<em>A curve of ψ</em>") && page.contains("<p>Words.</p>"));
    assert!(page.contains("<svg viewBox=\"0 0 9 9\"") && !page.contains("xmlns"));
    assert!(page.contains("<a href=\"gone.png\">Gone</a>"));
}

#[test]
fn tables_have_heads_for_columns_and_rows() {
    let page = made(PAGE);
    assert!(page.contains("<th scope=\"col\">method</th><th scope=\"col\" class=\"right\">error</th>"), "{page}");
    assert!(page.contains("<th scope=\"row\"><code>a</code></th><td class=\"right\">0.12 ± 0.03</td>"), "{page}");
}

#[test]
fn a_page_can_be_mailed() {
    let page = made(&"![One of many](huge.png)\n\n".repeat(5));
    assert!(page.len() < 2_000_000, "{}", page.len());
    assert_eq!(page.matches("<figure>").count(), 1);
    assert_eq!(page.matches("<a href=\"huge.png\">One of many</a>").count(), 4);
}

#[test]
fn a_part_that_is_folded_ends_with_the_next_part() {
    let page = made("# A study\n\n## First\n\nOne.\n\n## Last\n\nTwo.\n\n### Below\n\nThree.\n\n## Behind\n\nFour.\n");
    let part = page.split("<details>\n<summary>").last().and_then(|tail| tail.split("</details>").next());
    let part = part.expect("a folded part");
    assert!(part.starts_with("<h2 id=\"last\">Last</h2></summary>") && part.contains("Three."), "{page}");
    assert!(!part.contains("One.") && !part.contains("Four."), "{page}");
    let last = made("# A study\n\n## Last\n\nTwo.\n");
    assert_eq!(last.matches("<details>").count(), last.matches("</details>").count());
}
