//! The motion in three dimensions: moments side by side, and all of the way in one picture.

use image::imageops;
use muybridge_footprints::Support;

use super::sheet::{Anchor, INK, MUTED, SMALL_PX, Sheet, TITLE_PX};
use super::shot::Photographer;
use super::supports::{color, legend};
use super::unrolled::Unrolled;
use super::walk::Walk;

/// Room for the title, under each picture, and between them, px.
const TITLE_ROOM_PX: f64 = 40.0;
const CAPTION_PX: f64 = 26.0;
const GAP_PX: f64 = 8.0;
/// Pictures in a row.
const COLUMNS: u32 = 6;
/// Height of a picture for each px of its width: one of many, and of the whole way.
const CELL: f64 = 1.0;
const WIDE: f64 = 0.46;
/// Figures on the whole way are at least so many of their lengths apart, and at most so many.
const APART: f64 = 0.7;
const MOST_FIGURES: usize = 30;

/// Moments of a motion side by side, on a sheet of a width, px.
pub(super) fn strip(walk: &Walk, title: &str, width_px: f64, moments: u32) -> Sheet {
    let way = Unrolled::of(walk);
    let photographer = Photographer::new(walk, &way);
    let columns = COLUMNS.min(moments.max(1));
    let cell = (width_px - GAP_PX) / f64::from(columns) - GAP_PX;
    let size = [cell as u32, (CELL * cell) as u32];
    let row_px = f64::from(size[1]) + CAPTION_PX + GAP_PX;
    let rows = moments.div_ceil(columns);
    let mut sheet = Sheet::new([width_px, TITLE_ROOM_PX + f64::from(rows) * row_px]);
    draw_title(&mut sheet, title, "moments");
    let supports = walk.motion.placed.supports();
    for i in 0..moments {
        let time_s = walk.motion.duration_s() * f64::from(i) / f64::from((moments - 1).max(1));
        let picture = photographer.shoot(&photographer.along(time_s, size, true), &[time_s], size);
        let left = (GAP_PX + f64::from(i % columns) * (cell + GAP_PX)).round();
        let top = (TITLE_ROOM_PX + f64::from(i / columns) * row_px).round();
        sheet.picture([left, top], picture);
        let down = Support::at(&supports, time_s).map_or(&[][..], |support| &support.down);
        let feet: Vec<&str> = down.iter().map(|foot| foot.abbreviation()).collect();
        let words = if feet.is_empty() { "flight".to_string() } else { feet.join(" ") };
        let base = top + f64::from(size[1]) + 17.0;
        sheet.rectangle([left + 2.0, base - 10.0], [10.0, 10.0], color(down));
        sheet.text([left + 18.0, base], &words, INK, SMALL_PX, Anchor::Start);
        let right = left + f64::from(size[0]);
        sheet.text([right - 2.0, base], &format!("{time_s:.2} s"), MUTED, SMALL_PX, Anchor::End);
    }
    sheet
}

/// The whole way with figures on it, on a sheet of a width, px.
pub(super) fn scene(walk: &Walk, title: &str, width_px: f64) -> Sheet {
    let way = Unrolled::of(walk);
    let photographer = Photographer::new(walk, &way);
    let size = [(width_px - 2.0 * GAP_PX) as u32, (WIDE * width_px) as u32];
    let moments = way.moments(APART * photographer.length_m(), MOST_FIGURES);
    let picture = photographer.shoot(&photographer.whole(&moments, size), &moments, size);
    let mut sheet = Sheet::new([width_px, TITLE_ROOM_PX + f64::from(size[1]) + CAPTION_PX + GAP_PX]);
    draw_title(&mut sheet, title, "figures at equal distances");
    let mut x = GAP_PX + 8.0;
    sheet.picture([GAP_PX, TITLE_ROOM_PX], imageops::crop_imm(&picture, 0, 0, size[0], size[1]).to_image());
    let base = TITLE_ROOM_PX + f64::from(size[1]) + 20.0;
    for (color, words) in legend(&walk.motion.placed.supports()) {
        sheet.rectangle([x, base - 10.0], [18.0, 10.0], color);
        sheet.text([x + 24.0, base], &words, MUTED, SMALL_PX, Anchor::Start);
        x += 50.0 + 6.9 * words.chars().count() as f64;
    }
    sheet
}

fn draw_title(sheet: &mut Sheet, title: &str, about: &str) {
    sheet.text([GAP_PX + 8.0, 26.0], title, INK, TITLE_PX, Anchor::Start);
    let right = sheet.size[0] - GAP_PX - 8.0;
    sheet.text([right, 26.0], about, MUTED, SMALL_PX, Anchor::End);
}
