//! Rules that every page has to keep.

use roxmltree::{Document, Node};

fn number(node: Node<'_, '_>, name: &str) -> f64 {
    node.attribute(name).map_or(0.0, |value| value.parse().unwrap())
}

/// Part of the page that a text takes: left, top, right, bottom, by a usual width of its letters.
fn text_box(node: Node<'_, '_>) -> [f64; 4] {
    let (x, y, size) = (number(node, "x"), number(node, "y"), number(node, "font-size"));
    let em = |letter: char| match letter {
        'a'..='z' | 'A'..='Z' | '0'..='9' => 0.55,
        letter if letter.is_ascii() => 0.28,
        letter if letter < '\u{1100}' => 0.5,
        _ => 1.0,
    };
    let width = node.text().unwrap().chars().map(em).sum::<f64>() * size;
    let left = match node.attribute("text-anchor") {
        Some("end") => x - width,
        Some("middle") => x - width / 2.0,
        _ => x,
    };
    [left, y - 0.7 * size, left + width, y]
}

fn text_boxes(page: &Document<'_>) -> Vec<([f64; 4], String)> {
    let texts = page.descendants().filter(|node| node.has_tag_name("text"));
    texts.map(|node| (text_box(node), node.text().unwrap().to_owned())).collect()
}

/// Proves that all that is drawn lies within the margins, and that no text covers another.
pub(in crate::ui) fn check(svg: &str) {
    let page = Document::parse(svg).unwrap();
    let root = page.root_element();
    assert_eq!(root.attribute("viewBox"), Some("0 0 595 842"));
    assert_eq!(root.attribute("width").zip(root.attribute("height")), Some(("210mm", "297mm")));
    // Half of what a printer leaves white.
    let is_within = |[left, top, right, bottom]: [f64; 4]| {
        left >= 24.0 && top >= 24.0 && right <= 571.0 && bottom <= 818.0
    };
    for node in page.descendants().filter(Node::is_element) {
        let (x, y) = (number(node, "x"), number(node, "y"));
        let (cx, cy, r) = (number(node, "cx"), number(node, "cy"), number(node, "r"));
        let bounds = match node.tag_name().name() {
            "rect" if node.attribute("x").is_some() => {
                [x, y, x + number(node, "width"), y + number(node, "height")]
            }
            "circle" => [cx - r, cy - r, cx + r, cy + r],
            "line" => ["x1", "y1", "x2", "y2"].map(|name| number(node, name)),
            "polyline" => {
                let points = node.attribute("points").unwrap().split([' ', ',']);
                let points: Vec<f64> = points.map(|value| value.parse().unwrap()).collect();
                let along = |first: usize| points.iter().skip(first).step_by(2).copied();
                let least = |first| along(first).fold(f64::MAX, f64::min);
                let greatest = |first| along(first).fold(f64::MIN, f64::max);
                [least(0), least(1), greatest(0), greatest(1)]
            }
            "text" => {
                assert!(number(node, "font-size") >= 6.5, "{node:?}");
                text_box(node)
            }
            _ => continue,
        };
        assert!(is_within(bounds), "{node:?} {bounds:?} {:?}", node.text());
    }
    let boxes = text_boxes(&page);
    for (index, (a, said)) in boxes.iter().enumerate() {
        for (b, other) in &boxes[index + 1..] {
            let covers = a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];
            assert!(!covers, "{said:?} {a:?} and {other:?} {b:?}");
        }
    }
}
