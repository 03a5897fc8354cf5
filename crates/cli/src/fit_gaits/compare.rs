//! Two captures of one gait side by side, at the tail of the table.

use muybridge_core::Database;
use muybridge_fitting::pipeline::PlateFit;
use muybridge_fitting::report::captures::{CaptureComparison, compare_captures};

/// The comparisons of all gaits with two or more captures; nothing where there is none.
pub(super) fn text(fits: &[PlateFit], database: &Database) -> String {
    compare_captures(fits, database).iter().map(comparison).collect()
}

/// One gait: a heading, and a line per quantity in columns that line up.
fn comparison(comparison: &CaptureComparison) -> String {
    let mut rows = vec![[&["".to_string()][..], &comparison.captures, &["apart".to_string()]].concat()];
    rows.extend(comparison.quantities.iter().map(|quantity| {
        [&[quantity.name.clone()][..], &quantity.values, std::slice::from_ref(&quantity.apart)].concat()
    }));
    let columns = comparison.captures.len() + 2;
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).map(|(cell, width)| format!("{cell:<width$}"));
        format!("  {}\n", cells.collect::<Vec<_>>().join("  ").trim_end())
    };
    let lines: String = rows.iter().map(line).collect();
    format!(
        "captures of one gait compared, {} (apart: greatest less least, of their mean):\n{lines}",
        comparison.gait
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use muybridge_core::Gait;
    use muybridge_fitting::report::captures::ComparedQuantity;

    #[test]
    fn columns_line_up_and_words_have_nothing_apart() {
        let quantity = |name: &str, values: [&str; 2], apart: &str| ComparedQuantity {
            name: name.into(),
            values: values.map(String::from).to_vec(),
            apart: apart.into(),
        };
        let compared = CaptureComparison {
            gait: Gait::Gallop,
            captures: vec!["daisy".into(), "sallie-gardner".into()],
            quantities: vec![
                quantity("speed, m/s", ["11.19", "16.09"], "36 %"),
                quantity("speed is", ["INFERRED", "stated"], ""),
            ],
        };
        let text = comparison(&compared);
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[0].contains("gallop"));
        assert_eq!(lines[1], "              daisy     sallie-gardner  apart");
        assert_eq!(lines[2], "  speed, m/s  11.19     16.09           36 %");
        assert_eq!(lines[3], "  speed is    INFERRED  stated");
    }
}
