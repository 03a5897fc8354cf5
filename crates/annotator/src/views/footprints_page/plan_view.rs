//! Where the plan is on the screen: zoom and pan. X runs to the right, Z down: the plan as seen from above.

use egui::{Pos2, Rect, Vec2, pos2};

/// Points per metre at most: a centimetre as large as a fingertip. And at least: ten kilometres in a window.
const ZOOM: [f64; 2] = [0.02, 3000.0];
/// Room around what is shown as a whole, points.
const MARGIN: f32 = 70.0;
/// What is shown is never taken for smaller than this, metres: a single print does not fill the window.
const LEAST_SHOWN_M: f64 = 1.0;
/// Farther from the origin nobody looks, metres.
const FARTHEST_M: f64 = 20_000.0;

/// The similarity from the plan (x, z in metres) to the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PlanView {
    /// Screen points per metre.
    pub(super) points_per_m: f64,
    /// What is in the middle of the screen.
    pub(super) middle_m: [f64; 2],
}

impl PlanView {
    /// The view that shows places as large as fits.
    pub(super) fn fit(places_m: impl Iterator<Item = [f64; 2]>, screen: Rect) -> Self {
        let (mut least, mut most) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for at_m in places_m.filter(|at_m| at_m.iter().all(|v| v.is_finite())) {
            for i in 0..2 {
                (least[i], most[i]) = (least[i].min(at_m[i]), most[i].max(at_m[i]));
            }
        }
        if least[0] > most[0] {
            (least, most) = ([-1.0; 2], [1.0; 2]);
        }
        let size = screen.shrink(MARGIN.min(screen.width() / 4.0).min(screen.height() / 4.0)).size();
        let extent = [0, 1].map(|i| (most[i] - least[i]).max(LEAST_SHOWN_M));
        let zoom = (f64::from(size.x) / extent[0]).min(f64::from(size.y) / extent[1]);
        let middle_m = [0, 1].map(|i| (least[i] + most[i]) / 2.0);
        Self { points_per_m: zoom, middle_m }.clamped()
    }

    /// A place on the screen.
    pub(super) fn screen(&self, rect: Rect, at_m: [f64; 2]) -> Pos2 {
        let [x, z] = [0, 1].map(|i| (at_m[i] - self.middle_m[i]) * self.points_per_m);
        rect.center() + Vec2::new(x as f32, z as f32)
    }

    /// The place under a point of the screen.
    pub(super) fn plan(&self, rect: Rect, at: Pos2) -> [f64; 2] {
        let from_middle = at - rect.center();
        [
            self.middle_m[0] + f64::from(from_middle.x) / self.points_per_m,
            self.middle_m[1] + f64::from(from_middle.y) / self.points_per_m,
        ]
    }

    /// Zoomed by a factor; what lies under `about` stays there.
    pub(super) fn zoomed(self, rect: Rect, factor: f64, about: Pos2) -> Self {
        let under_m = self.plan(rect, about);
        let zoomed = Self { points_per_m: self.points_per_m * factor, ..self }.clamped();
        let now_m = zoomed.plan(rect, about);
        let middle_m = [0, 1].map(|i| zoomed.middle_m[i] + under_m[i] - now_m[i]);
        Self { middle_m, ..zoomed }.clamped()
    }

    /// Moved by a distance on the screen, points.
    pub(super) fn panned(self, by: Vec2) -> Self {
        let by_m = [f64::from(by.x) / self.points_per_m, f64::from(by.y) / self.points_per_m];
        Self { middle_m: [0, 1].map(|i| self.middle_m[i] - by_m[i]), ..self }.clamped()
    }

    /// The part of the plan on the screen: least and greatest corner, metres.
    pub(super) fn seen(&self, rect: Rect) -> [[f64; 2]; 2] {
        [self.plan(rect, rect.min), self.plan(rect, rect.max)]
    }

    fn clamped(self) -> Self {
        let number = |value: f64, otherwise: f64| if value.is_finite() { value } else { otherwise };
        let points_per_m = number(self.points_per_m, 100.0).clamp(ZOOM[0], ZOOM[1]);
        let middle_m = self.middle_m.map(|at| number(at, 0.0).clamp(-FARTHEST_M, FARTHEST_M));
        Self { points_per_m, middle_m }
    }
}

/// The distance of lines, metres, that are at least so many points apart: 1, 2 or 5 times a power of ten.
pub(super) fn line_distance_m(points_per_m: f64, least_points: f64) -> f64 {
    let wanted = least_points / points_per_m;
    let power = 10.0_f64.powf(wanted.log10().floor());
    let factor = [1.0, 2.0, 5.0].into_iter().find(|factor| factor * power >= wanted).unwrap_or(10.0);
    factor * power
}

/// The plan on the screen in this frame.
pub(super) struct Canvas {
    pub(super) view: PlanView,
    pub(super) rect: Rect,
    pub(super) painter: egui::Painter,
}

impl Canvas {
    pub(super) fn screen(&self, at_m: [f64; 2]) -> Pos2 {
        self.view.screen(self.rect, at_m)
    }

    pub(super) fn plan(&self, at: Pos2) -> [f64; 2] {
        self.view.plan(self.rect, at)
    }

    /// Whether a place is on the screen, or nearly.
    pub(super) fn sees(&self, at: Pos2, margin: f32) -> bool {
        self.rect.expand(margin).contains(at)
    }

    /// A direction of the plan on the screen.
    pub(super) fn along(&self, [x, z]: [f64; 2]) -> Vec2 {
        Vec2::new(x as f32, z as f32)
    }
}

/// A place far outside the screen is drawn as well at its edge: painters do not like large numbers.
pub(super) fn tame(at: Pos2) -> Pos2 {
    const FAR: f32 = 30_000.0;
    pos2(at.x.clamp(-FAR, FAR), at.y.clamp(-FAR, FAR))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCREEN: Rect = Rect { min: pos2(100.0, 50.0), max: pos2(900.0, 650.0) };

    #[test]
    fn what_is_under_the_pointer_stays_there() {
        let view = PlanView::fit([[0.0, 0.0], [5.0, -2.0]].into_iter(), SCREEN);
        let pointer = pos2(333.0, 222.0);
        let under = view.plan(SCREEN, pointer);
        let zoomed = view.zoomed(SCREEN, 3.7, pointer).zoomed(SCREEN, 1e9, pointer);
        let now = zoomed.plan(SCREEN, pointer);
        assert!((now[0] - under[0]).hypot(now[1] - under[1]) < 1e-6);
        assert!(view.screen(SCREEN, under).distance(pointer) < 1e-3);
        let odd = view.zoomed(SCREEN, f64::NAN, pointer).panned(Vec2::splat(f32::INFINITY));
        assert!(odd.points_per_m.is_finite() && odd.middle_m.iter().all(|v| v.is_finite()));
    }

    #[test]
    fn lines_are_at_round_distances() {
        for (zoom, distance_m) in [(100.0, 0.5), (40.0, 1.0), (1.0, 50.0), (2000.0, 0.02)] {
            assert!((line_distance_m(zoom, 40.0) - distance_m).abs() < 1e-9, "{zoom}");
        }
        assert!(PlanView::fit(std::iter::empty(), SCREEN).points_per_m > 1.0);
    }
}
