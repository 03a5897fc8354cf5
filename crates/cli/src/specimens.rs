//! The specimen plates: known motions of the fitting crate, drawn by the imaging crate; and the ones the repository keeps.

use muybridge_core::Gait;
use muybridge_fitting::synthetic::{Posed, SyntheticStride};
use muybridge_imaging::specimen::{Hurdle, PosedHorse, Specimen, SpecimenMotion, SpecimenStyle, draw};

/// Panels of a specimen unless something else is asked for: what most of Muybridge's plates have.
pub const PANELS: usize = 12;
/// Seed of the specimens that the repository keeps.
pub const KEPT_SEED: u64 = 1;

/// A motion with known truth, ready to be drawn.
pub fn motion(gait: Gait, seed: u64, panels: usize) -> SpecimenMotion {
    let stride = SyntheticStride::of_gait(gait, seed, panels);
    SpecimenMotion {
        gait,
        facing: stride.facing,
        withers_height_m: f64::from(stride.horse.withers_height_m),
        speed_m_s: stride.speed_m_s,
        closes_after_panels: (gait != Gait::Leap).then_some(panels as f64),
        poses: (0..panels).map(|panel| posed(stride.posed(panel))).collect(),
        hurdle: stride.hurdle.map(|hurdle| Hurdle { x_m: hurdle.x_m, height_m: hurdle.height_m }),
    }
}

fn posed(Posed { time_s, bones, croup, dock, down }: Posed) -> PosedHorse {
    PosedHorse { time_s, bones, croup, dock, down }
}

/// The look of the plate kept for a gait: the card of 1878, the plates of 1887 and a dark wall, the fast gaits ridden.
pub fn style(gait: Gait, seed: u64, panels: usize) -> SpecimenStyle {
    let base = match gait {
        Gait::Walk => SpecimenStyle::dark_wall(),
        Gait::Trot | Gait::Canter | Gait::Leap => SpecimenStyle::animal_locomotion(),
        Gait::Amble | Gait::Rack | Gait::Gallop => SpecimenStyle::default(),
    };
    let rider = matches!(gait, Gait::Canter | Gait::Gallop | Gait::Leap);
    SpecimenStyle { seed, rider, rows: (panels as u32).div_ceil(base.columns), ..base }
}

/// The plate kept for a gait.
pub fn kept(gait: Gait) -> Specimen {
    draw(&motion(gait, KEPT_SEED, PANELS), &style(gait, KEPT_SEED, PANELS))
}

/// A plate as it may come: any gait, any look, as many poses as it has panels.
pub fn random(seed: u64) -> Specimen {
    let style = SpecimenStyle::random(seed);
    let gait = Gait::ALL[(seed % Gait::ALL.len() as u64) as usize];
    // A stride of fewer than six panels is none that anybody photographed; the rest of the poses is not shown.
    let panels = ((style.columns * style.rows) as usize).max(6);
    draw(&motion(gait, seed, panels), &style)
}
