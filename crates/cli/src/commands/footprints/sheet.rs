//! A sheet of paper: areas, lines, dots and words, drawn as SVG or as pixels.

use std::path::Path;

use anyhow::bail;
use image::RgbImage;
use muybridge_capture::write_atomically;

use super::super::canvas::write_few_colors;
use super::{pixels, svg};

/// Red, green and blue.
pub(super) type Color = [u8; 3];

/// Paper, ink, and ink of lesser things.
pub(super) const PAPER: Color = [252, 251, 248];
pub(super) const INK: Color = [38, 36, 34];
pub(super) const MUTED: Color = [112, 106, 98];
pub(super) const RULE: Color = [226, 221, 211];

/// Sizes of words, px.
pub(super) const TITLE_PX: f64 = 19.0;
pub(super) const TEXT_PX: f64 = 14.0;
pub(super) const SMALL_PX: f64 = 12.0;

/// Which end of a line of words is at its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// Something drawn. Places are px from the left and from the top.
#[derive(Clone, Debug)]
pub(super) enum Mark {
    /// A filled polygon.
    Area { points: Vec<[f64; 2]>, color: Color, opacity: f64 },
    /// A line through points.
    Line { points: Vec<[f64; 2]>, color: Color, width: f64 },
    /// A filled circle.
    Dot { at: [f64; 2], radius: f64, color: Color },
    /// Words; `at` is on their base line.
    Text { at: [f64; 2], text: String, color: Color, size: f64, anchor: Anchor },
    /// Pixels; only on sheets of pixels.
    Picture { at: [f64; 2], picture: RgbImage },
}

/// A sheet under way: what is drawn later covers what was drawn before.
#[derive(Clone, Debug)]
pub(super) struct Sheet {
    /// Width and height, px.
    pub(super) size: [f64; 2],
    pub(super) marks: Vec<Mark>,
}

impl Sheet {
    pub(super) fn new(size: [f64; 2]) -> Self {
        Self { size: size.map(f64::ceil), marks: Vec::new() }
    }

    pub(super) fn area(&mut self, points: Vec<[f64; 2]>, color: Color, opacity: f64) {
        self.marks.push(Mark::Area { points, color, opacity });
    }

    pub(super) fn rectangle(&mut self, [left, top]: [f64; 2], [width, height]: [f64; 2], color: Color) {
        let (right, bottom) = (left + width, top + height);
        self.area(vec![[left, top], [right, top], [right, bottom], [left, bottom]], color, 1.0);
    }

    pub(super) fn line(&mut self, points: Vec<[f64; 2]>, color: Color, width: f64) {
        self.marks.push(Mark::Line { points, color, width });
    }

    pub(super) fn dot(&mut self, at: [f64; 2], radius: f64, color: Color) {
        self.marks.push(Mark::Dot { at, radius, color });
    }

    pub(super) fn text(&mut self, at: [f64; 2], text: &str, color: Color, size: f64, anchor: Anchor) {
        self.marks.push(Mark::Text { at, text: text.into(), color, size, anchor });
    }

    pub(super) fn picture(&mut self, at: [f64; 2], picture: RgbImage) {
        self.marks.push(Mark::Picture { at, picture });
    }

    /// Puts another sheet below this one.
    pub(super) fn append(&mut self, below: Self) {
        let top = self.size[1];
        let lower = |[x, y]: [f64; 2]| [x, y + top];
        self.marks.extend(below.marks.into_iter().map(|mark| mark.moved(&lower)));
        self.size = [self.size[0].max(below.size[0]), top + below.size[1]];
    }

    /// Writes it: SVG or PNG by the ending of the file's name.
    pub(super) fn write(&self, path: &Path) -> anyhow::Result<()> {
        let ending = path.extension().and_then(|ending| ending.to_str()).map(str::to_ascii_lowercase);
        match ending.as_deref() {
            Some("svg") if self.marks.iter().any(|mark| matches!(mark, Mark::Picture { .. })) => {
                bail!("{}: this picture is made of pixels; give it a name that ends in .png", path.display())
            }
            Some("svg") => Ok(write_atomically(path, svg::text(self).as_bytes())?),
            Some("png") => write_few_colors(path, &pixels::picture(self)),
            _ => bail!("{}: give the picture a name that ends in .png or .svg", path.display()),
        }
    }
}

impl Mark {
    fn moved(self, to: &impl Fn([f64; 2]) -> [f64; 2]) -> Self {
        let all = |points: Vec<[f64; 2]>| points.into_iter().map(to).collect();
        match self {
            Self::Area { points, color, opacity } => Self::Area { points: all(points), color, opacity },
            Self::Line { points, color, width } => Self::Line { points: all(points), color, width },
            Self::Dot { at, radius, color } => Self::Dot { at: to(at), radius, color },
            Self::Text { at, text, color, size, anchor } => {
                Self::Text { at: to(at), text, color, size, anchor }
            }
            Self::Picture { at, picture } => Self::Picture { at: to(at), picture },
        }
    }
}
