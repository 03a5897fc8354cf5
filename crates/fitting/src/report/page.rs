//! The page around the report: escaping, tables, the style sheet.

use std::fmt::Write as _;

use super::plot::Ink;

/// Text made safe for HTML, in content and in quoted attributes.
pub(super) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            // Control characters have no place in a page, and some end its parsing.
            c if c.is_control() && c != '\n' => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}

/// `value ± sd` with the same decimals.
pub(super) fn plus_minus(value: f64, sd: f64, decimals: usize) -> String {
    format!("{value:.decimals$}&#8239;±&#8239;{sd:.decimals$}")
}

/// Value and spread of a quantity of any size: two digits of the spread, at most four decimals.
pub(super) fn plus_minus_fitting(value: f64, sd: f64) -> String {
    let smaller = if sd > 0.0 { sd } else { value.abs() * 1e-3 };
    let decimals = if smaller > 0.0 { (1.0 - smaller.log10().floor()).clamp(0.0, 4.0) as usize } else { 2 };
    plus_minus(value, sd, decimals)
}

/// A signed number with a true minus sign.
pub(super) fn signed(value: f64, decimals: usize) -> String {
    let text = format!("{value:+.decimals$}");
    text.replace('-', "\u{2212}")
}

/// A number with a true minus sign.
pub(super) fn number(value: f64, decimals: usize) -> String {
    // Adding zero turns a negative zero into a plain one.
    format!("{:.decimals$}", value + 0.0).replace('-', "\u{2212}")
}

/// A table from rows of ready HTML cells; the first cell of a row is its head.
pub(super) fn table(class: &str, head: &[&str], rows: &[Vec<String>]) -> String {
    let mut html = format!("<div class=\"scroll\"><table class=\"{class}\"><thead><tr>");
    for cell in head {
        let _ = write!(html, "<th scope=\"col\">{cell}</th>");
    }
    html.push_str("</tr></thead><tbody>\n");
    for row in rows {
        html.push_str("<tr>");
        for (column, cell) in row.iter().enumerate() {
            let _ = match column {
                0 => write!(html, "<th scope=\"row\">{cell}</th>"),
                _ => write!(html, "<td>{cell}</td>"),
            };
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</tbody></table></div>\n");
    html
}

/// A figure with its caption in ready HTML.
pub(super) fn figure(pictures: &str, caption: &str) -> String {
    format!("<figure>{pictures}<figcaption>{caption}</figcaption></figure>\n")
}

/// A bullet list of ready HTML items; nothing without items.
pub(super) fn list(class: &str, items: &[String]) -> String {
    if items.is_empty() {
        return String::new();
    }
    let items: String = items.iter().map(|item| format!("<li>{item}</li>")).collect();
    format!("<ul class=\"{class}\">{items}</ul>\n")
}

/// The whole document.
pub(super) fn document(title: &str, body: &str) -> String {
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\
         <meta name=\"color-scheme\" content=\"light dark\"/>\
         <title>{}</title><style>\n{}</style></head>\n<body><main>\n{body}</main></body></html>\n",
        escape(title),
        style_sheet()
    )
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02X}{g:02X}{b:02X}")
}

/// Inks as variables, their dark values on a dark screen only (paper is always light), and the rules.
fn style_sheet() -> String {
    let mut css = String::from(":root { color-scheme: light dark;");
    for ink in Ink::ALL {
        let _ = write!(css, " --{}: {};", ink.name(), hex(ink.light()));
    }
    css.push_str(" }\n@media screen and (prefers-color-scheme: dark) {\n:root {");
    for ink in Ink::ALL {
        let _ = write!(css, " --{}: {};", ink.name(), hex(ink.dark()));
    }
    css.push_str(" }\n");
    // The pictures carry the light colours, so that they stay legible when taken out of the page.
    for ink in Ink::ALL {
        let (light, name) = (hex(ink.light()), ink.name());
        let _ = writeln!(css, "svg [fill=\"{light}\"] {{ fill: var(--{name}); }}");
        let _ = writeln!(css, "svg [stroke=\"{light}\"] {{ stroke: var(--{name}); }}");
    }
    css.push_str("}\n");
    css.push_str(include_str!("report.css"));
    css
}
