//! The contact sheet: all panels at once.

use egui::{Rect, Ui, pos2, vec2};

use crate::app::PageContext;
use crate::session::{Page, Session};
use crate::views::play_page;
use crate::views::strip::thumbnail;

/// Space below each photograph for its number, screen points.
const CAPTION: f32 = 16.0;

/// All panels as large as they fit.
pub fn show(ui: &mut Ui, session: &mut Session, _page: &mut PageContext<'_>) {
    ui.painter().rect_filled(ui.max_rect(), 0.0, ui.visuals().panel_fill);
    let all = ui.available_rect_before_wrap().shrink(6.0);
    let numbers = session.panel_numbers();
    let Some(first) = session.place_of(*numbers.first().unwrap_or(&1)) else { return };
    let [a, b, _, d] = first.quad_px;
    let aspect = ((b[0] - a[0]) / (d[1] - a[1])).clamp(0.2, 5.0) as f32;
    let (columns, width) = best_grid(numbers.len(), aspect, all);
    for (at, number) in numbers.iter().enumerate() {
        let (row, column) = (at / columns, at % columns);
        let height = width / aspect + CAPTION;
        let corner = pos2(all.left() + column as f32 * width, all.top() + row as f32 * height);
        let rect = Rect::from_min_size(corner, vec2(width, height)).shrink(3.0);
        thumbnail(ui, session, *number, rect);
        if session.page == Page::Play && session.panel == *number {
            let photograph = Rect::from_min_max(rect.min, rect.max - vec2(0.0, CAPTION));
            play_page::draw_on_sheet(ui.painter(), session, photograph);
        }
    }
}

/// Number of columns with which the photographs are largest, and the width of one.
fn best_grid(count: usize, aspect: f32, all: Rect) -> (usize, f32) {
    let width_of = |columns: usize| {
        let rows = count.div_ceil(columns) as f32;
        (all.width() / columns as f32).min((all.height() / rows - CAPTION) * aspect)
    };
    let best = (1..=count.max(1)).max_by(|a, b| width_of(*a).total_cmp(&width_of(*b))).unwrap_or(1);
    (best, width_of(best).max(8.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_photograph_fits_on_the_sheet() {
        let all = Rect::from_min_size(pos2(0.0, 0.0), vec2(900.0, 500.0));
        for count in [1, 8, 12, 24] {
            let (columns, width) = best_grid(count, 1.5, all);
            let rows = count.div_ceil(columns) as f32;
            assert!(columns as f32 * width <= 900.1 && rows * (width / 1.5 + CAPTION) <= 500.1);
        }
        assert_eq!(best_grid(12, 1.5, all).0, 4);
    }
}
