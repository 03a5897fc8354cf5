//! Brightness, contrast and gamma: what a dark photograph needs to be read.

use egui::Color32;

/// How the tones of the photographs are shown. The files are never changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adjustment {
    /// Added to every tone, -1 (all black) to 1 (all white); 0 leaves them.
    pub brightness: f32,
    /// Slope of the tones about middle grey, [`Self::CONTRAST`]; 1 leaves them.
    pub contrast: f32,
    /// Tones to the power of one over this, [`Self::GAMMA`]; 1 leaves them, more lifts the shadows.
    pub gamma: f32,
}

impl Default for Adjustment {
    fn default() -> Self {
        Self { brightness: 0.0, contrast: 1.0, gamma: 1.0 }
    }
}

impl Adjustment {
    /// Least and greatest brightness.
    pub const BRIGHTNESS: std::ops::RangeInclusive<f32> = -1.0..=1.0;
    /// Least and greatest contrast: from a flat grey to almost two tones.
    pub const CONTRAST: std::ops::RangeInclusive<f32> = 0.2..=5.0;
    /// Least and greatest gamma; at 4 a tone of 10 of 255 is shown as 113.
    pub const GAMMA: std::ops::RangeInclusive<f32> = 0.25..=4.0;

    /// The shown tone of each tone of the file. Values outside the ranges are taken as the nearest inside, and what
    /// is no number as neutral.
    pub(super) fn tones(self) -> [u8; 256] {
        let within = |value: f32, range: &std::ops::RangeInclusive<f32>, neutral: f32| {
            if value.is_nan() { neutral } else { value.clamp(*range.start(), *range.end()) }
        };
        let brightness = within(self.brightness, &Self::BRIGHTNESS, 0.0);
        let contrast = within(self.contrast, &Self::CONTRAST, 1.0);
        let gamma = within(self.gamma, &Self::GAMMA, 1.0);
        std::array::from_fn(|tone| {
            let lifted = (tone as f32 / 255.0).powf(1.0 / gamma);
            let shown = (lifted - 0.5) * contrast + 0.5 + brightness;
            (shown.clamp(0.0, 1.0) * 255.0).round() as u8
        })
    }
}

/// The colour of an RGB pixel whose tones are looked up.
pub(super) fn toned([r, g, b]: [u8; 3], tones: &[u8; 256]) -> Color32 {
    Color32::from_rgb(tones[usize::from(r)], tones[usize::from(g)], tones[usize::from(b)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neutral_leaves_every_tone_and_gamma_lifts_the_shadows_only() {
        assert!(Adjustment::default().tones().iter().enumerate().all(|(i, &tone)| i == usize::from(tone)));
        let lifted = Adjustment { gamma: 2.0, ..Adjustment::default() }.tones();
        assert!(lifted[20] > 60 && lifted[0] == 0 && lifted[255] == 255);
        assert!(lifted.windows(2).all(|pair| pair[0] <= pair[1]));
    }

    #[test]
    fn nonsense_gives_tones_all_the_same() {
        let nothing = Adjustment { brightness: f32::NAN, contrast: f32::NAN, gamma: f32::NAN };
        assert_eq!(nothing.tones(), Adjustment::default().tones());
        let extreme = Adjustment { brightness: 0.0, contrast: 1e30, gamma: -5.0 };
        assert_eq!((extreme.tones()[0], extreme.tones()[255]), (0, 255));
    }
}
