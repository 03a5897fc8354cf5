//! Where the plate is on the screen: zoom and pan.

use egui::{Pos2, Rect, Vec2, pos2};

/// Points per plate px at most: a pixel of the scan as large as a fingertip.
const MOST_ZOOM: f64 = 64.0;
/// The whole plate is shown at this share of its fitted size at least.
const LEAST_SHARE_OF_FIT: f64 = 0.25;

/// The similarity from plate px to screen points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewTransform {
    /// Screen points per plate px, positive.
    pub zoom: f64,
    /// Where the plate's origin is on the screen, points.
    pub origin: [f64; 2],
}

impl ViewTransform {
    /// The view that shows a rectangle of the plate (least and greatest corner, px) as large as fits into a rectangle
    /// of the screen, in its middle. A rectangle without area gives one point per px.
    pub fn fit([min, max]: [[f64; 2]; 2], screen: Rect) -> Self {
        let [width, height] = [max[0] - min[0], max[1] - min[1]];
        let zoom = (f64::from(screen.width()) / width).min(f64::from(screen.height()) / height);
        let zoom = if zoom.is_finite() && zoom > 0.0 { zoom.min(MOST_ZOOM) } else { 1.0 };
        let middle = [(min[0] + max[0]) / 2.0, (min[1] + max[1]) / 2.0];
        Self { zoom, origin: [0.0, 0.0] }.with_at(middle, screen.center())
    }

    /// The view that shows a whole picture.
    pub fn fit_whole(size_px: [u32; 2], screen: Rect) -> Self {
        Self::fit([[0.0, 0.0], size_px.map(f64::from)], screen)
    }

    /// A plate point on the screen, points.
    pub fn screen_from_plate(&self, at_px: [f64; 2]) -> Pos2 {
        let [x, y] = self.place(at_px);
        pos2(x as f32, y as f32)
    }

    /// A screen point on the plate, px.
    pub fn plate_from_screen(&self, at: Pos2) -> [f64; 2] {
        [(f64::from(at.x) - self.origin[0]) / self.zoom, (f64::from(at.y) - self.origin[1]) / self.zoom]
    }

    /// The same in full precision.
    pub(super) fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.origin[0] + self.zoom * x, self.origin[1] + self.zoom * y]
    }

    /// The same zoom, moved so that a plate point lies at a screen point.
    pub fn with_at(self, at_px: [f64; 2], screen: Pos2) -> Self {
        let origin = [f64::from(screen.x) - self.zoom * at_px[0], f64::from(screen.y) - self.zoom * at_px[1]];
        Self { origin, ..self }
    }

    /// Zoomed by a factor; what lies under `about` stays there.
    pub fn zoomed(self, factor: f64, about: Pos2) -> Self {
        if !(factor.is_finite() && factor > 0.0) {
            return self;
        }
        let under = self.plate_from_screen(about);
        Self { zoom: (self.zoom * factor).min(MOST_ZOOM), ..self }.with_at(under, about)
    }

    /// Moved by a distance on the screen, points.
    pub fn panned(self, by: Vec2) -> Self {
        Self { origin: [self.origin[0] + f64::from(by.x), self.origin[1] + f64::from(by.y)], ..self }
    }

    /// The nearest view from which a person finds back: the screen's middle lies on the picture, and the zoom is
    /// between a quarter of the fitted one and 64 points per px. A view that is no number becomes the fitted one.
    pub fn clamped(self, size_px: [u32; 2], screen: Rect) -> Self {
        let fitted = Self::fit_whole(size_px, screen);
        if !(self.zoom.is_finite() && self.zoom > 0.0 && self.origin.iter().all(|v| v.is_finite())) {
            return fitted;
        }
        let middle = self.plate_from_screen(screen.center());
        let inside = [0, 1].map(|i| middle[i].clamp(0.0, f64::from(size_px[i])));
        let zoom = self.zoom.clamp(fitted.zoom * LEAST_SHARE_OF_FIT, MOST_ZOOM);
        if inside == middle && zoom == self.zoom {
            return self;
        }
        Self { zoom, ..self }.with_at(inside, screen.center())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCREEN: Rect = Rect { min: pos2(100.0, 50.0), max: pos2(900.0, 650.0) };

    fn near(a: [f64; 2], b: [f64; 2], tolerance: f64) -> bool {
        (a[0] - b[0]).hypot(a[1] - b[1]) <= tolerance
    }

    #[test]
    fn there_and_back_is_the_same_point() {
        let view = ViewTransform { zoom: 0.37, origin: [-812.25, 44.5] };
        for at in [[0.5, 0.5], [8000.25, 12.0], [3.0, 5999.5]] {
            assert!(near(view.plate_from_screen(view.screen_from_plate(at)), at, 1e-3));
        }
    }

    #[test]
    fn what_is_under_the_pointer_stays_there() {
        let (view, pointer) = (ViewTransform::fit_whole([8000, 6000], SCREEN), pos2(333.0, 222.0));
        let under = view.plate_from_screen(pointer);
        let zoomed = view.zoomed(3.7, pointer).zoomed(1e9, pointer);
        assert_eq!(zoomed.zoom, MOST_ZOOM);
        assert!(near(zoomed.plate_from_screen(pointer), under, 1e-6));
        assert_eq!(view.zoomed(f64::NAN, pointer), view);
    }

    #[test]
    fn a_fitted_picture_touches_the_screen_and_is_in_its_middle() {
        let view = ViewTransform::fit_whole([4000, 1000], SCREEN);
        assert!((view.zoom - 0.2).abs() < 1e-12);
        assert_eq!(view.screen_from_plate([2000.0, 500.0]), SCREEN.center());
        for odd in [[0, 0], [0, 5]] {
            assert!(ViewTransform::fit_whole(odd, SCREEN).zoom > 0.0);
        }
    }

    #[test]
    fn no_gesture_loses_the_picture() {
        let view = ViewTransform::fit_whole([4000, 3000], SCREEN);
        assert_eq!(view.clamped([4000, 3000], SCREEN), view);
        let lost = view.panned(Vec2::new(1e5, -1e5)).zoomed(1e-9, SCREEN.center());
        let found = lost.clamped([4000, 3000], SCREEN);
        let middle = found.plate_from_screen(SCREEN.center());
        assert!((0.0..=4000.0).contains(&middle[0]) && (0.0..=3000.0).contains(&middle[1]));
        assert!((found.zoom / view.zoom - LEAST_SHARE_OF_FIT).abs() < 1e-12);
        let nowhere = ViewTransform { zoom: f64::NAN, origin: [0.0, f64::INFINITY] };
        assert_eq!(nowhere.clamped([4000, 3000], SCREEN), view);
    }
}
