//! A sheet as SVG.

use std::fmt::Write as _;

use super::sheet::{Anchor, Color, Mark, PAPER, Sheet};

/// The text of a sheet.
pub(super) fn text(sheet: &Sheet) -> String {
    let [width, height] = sheet.size;
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"sans-serif\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"{}\"/>\n",
        hex(PAPER)
    );
    for mark in &sheet.marks {
        // Writing to a string cannot fail.
        let _ = write_mark(&mut out, mark);
    }
    out.push_str("</svg>\n");
    out
}

fn write_mark(out: &mut String, mark: &Mark) -> std::fmt::Result {
    match mark {
        Mark::Area { points, color, opacity } => {
            let see_through =
                if *opacity < 1.0 { format!(" fill-opacity=\"{opacity:.2}\"") } else { String::new() };
            writeln!(out, "<polygon points=\"{}\" fill=\"{}\"{see_through}/>", list(points), hex(*color))
        }
        Mark::Line { points, color, width } => writeln!(
            out,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{width:.2}\" stroke-linecap=\"round\" \
             stroke-linejoin=\"round\"/>",
            list(points),
            hex(*color)
        ),
        Mark::Dot { at: [x, y], radius, color } => {
            writeln!(out, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{radius:.2}\" fill=\"{}\"/>", hex(*color))
        }
        Mark::Text { at: [x, y], text, color, size, anchor } => {
            let anchor = match anchor {
                Anchor::Start => "start",
                Anchor::Middle => "middle",
                Anchor::End => "end",
            };
            writeln!(
                out,
                "<text x=\"{x:.2}\" y=\"{y:.2}\" font-size=\"{size}\" fill=\"{}\" text-anchor=\"{anchor}\">{}</text>",
                hex(*color),
                escaped(text)
            )
        }
        Mark::Picture { .. } => Ok(()),
    }
}

fn list(points: &[[f64; 2]]) -> String {
    let words: Vec<String> = points.iter().map(|[x, y]| format!("{x:.2},{y:.2}")).collect();
    words.join(" ")
}

fn hex([r, g, b]: Color) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Words of a track's author: what XML would take for its own is written otherwise, and what it has no place for is left out.
fn escaped(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars().filter(|c| !c.is_control()) {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            other => out.push(other),
        }
    }
    out
}
