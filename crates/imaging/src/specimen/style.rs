//! How a specimen plate looks.

use muybridge_core::Random;
use serde::{Deserialize, Serialize};

/// Metres in an inch.
const INCH_M: f64 = 0.0254;
/// A random plate is about this wide at most, and little higher, px.
const RANDOM_PLATE_PX: f64 = 1500.0;
/// Least difference of tone between a random plate's wall and its mount: less is not seen on real plates either.
const LEAST_EDGE: f64 = 45.0;
const WHITEST_PAPER: f64 = 245.0;

/// What the panels are mounted on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Mount {
    /// Black, with a lighter card around it, as the cabinet cards of 1878.
    Dark,
    /// Paper.
    Light,
}

/// Lines on the wall besides the uprights.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Grid {
    /// None.
    None,
    /// Four horizontal lines at the foot of the wall, as in 1878.
    Foot,
    /// Horizontal and vertical lines all over, as in *Animal Locomotion*.
    Full,
}

/// Grey values, 0 black to 255 white.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tones {
    /// The wall.
    pub wall: f64,
    /// The track.
    pub ground: f64,
    /// Uprights.
    pub uprights: f64,
    /// Finer lines.
    pub grid: f64,
    /// The horse's coat.
    pub horse: f64,
    /// The gutters between panels.
    pub mount: f64,
    /// The card or page around them.
    pub page: f64,
}

/// Everything about a specimen that is not motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpecimenStyle {
    /// Seed of all chance.
    pub seed: u64,
    /// Panels side by side, at least 1.
    pub columns: u32,
    /// Rows of panels, at least 1; a motion of fewer poses leaves the last cells empty.
    pub rows: u32,
    /// Width and height of a panel, px.
    pub panel_px: [f64; 2],
    /// Width of the gutters between columns and between rows, px.
    pub gutter_px: [f64; 2],
    /// How far gutters and edges scatter, as a share of the gutter, 0 to 1.
    pub unevenness: f64,
    /// Mount around the panels, px.
    pub margin_px: f64,
    /// What the panels are mounted on.
    pub mount: Mount,
    /// Turn of the whole page, degrees, positive clockwise.
    pub tilt_deg: f64,
    /// Standard deviation of each panel's own turn, degrees.
    pub panel_tilt_sd_deg: f64,
    /// A page fold in a gutter.
    pub fold: bool,
    /// A title under the panels.
    pub caption: bool,
    /// Hand-written panel numbers.
    pub numbers: bool,
    /// Camera to the near hooves' plane, m.
    pub camera_distance_m: f64,
    /// Lens over the track, m.
    pub camera_height_m: f64,
    /// Near hooves' plane to the wall, m.
    pub wall_distance_m: f64,
    /// Share of a panel's width or height that the horse takes at most, 0 to 1.
    pub fill: f64,
    /// Distance between neighbouring uprights, m.
    pub upright_spacing_m: f64,
    /// Width of an upright, m.
    pub upright_width_m: f64,
    /// A band with the uprights' numbers along the top of the wall.
    pub upright_numbers: bool,
    /// Number opposite the first camera.
    pub first_axis_mark: f64,
    /// Finer lines.
    pub grid: Grid,
    /// Distance between the finer lines, m.
    pub grid_spacing_m: f64,
    /// Grey values.
    pub tones: Tones,
    /// How round the horse is shaded: 0 a flat silhouette, 1 a well lit coat.
    pub shading: f64,
    /// How much darker the corners are than the middle, 0 to 1.
    pub light_falloff: f64,
    /// Number of a panel whose one half lies in shadow.
    pub shadowed_panel: Option<u32>,
    /// Standard deviation of the blur, px.
    pub blur_px: f64,
    /// Standard deviation of the grain, grey values.
    pub grain_sd: f64,
    /// Scratches and specks on the plate.
    pub scratches: u32,
    /// A rider.
    pub rider: bool,
}

impl Default for SpecimenStyle {
    /// A clean plate like the cards of 1878: four panels a row, dark horse, light wall, numbered uprights 27 inches apart.
    fn default() -> Self {
        Self {
            seed: 1,
            columns: 4,
            rows: 3,
            panel_px: [350.0, 236.0],
            gutter_px: [26.0, 26.0],
            unevenness: 0.1,
            margin_px: 24.0,
            mount: Mount::Dark,
            tilt_deg: 0.0,
            panel_tilt_sd_deg: 0.15,
            fold: false,
            caption: true,
            numbers: true,
            camera_distance_m: 12.0,
            camera_height_m: 1.2,
            wall_distance_m: 2.4,
            fill: 0.84,
            upright_spacing_m: 27.0 * INCH_M,
            upright_width_m: 0.022,
            upright_numbers: true,
            first_axis_mark: 4.0,
            grid: Grid::Foot,
            grid_spacing_m: 4.0 * INCH_M,
            tones: Tones {
                wall: 168.0,
                ground: 164.0,
                uprights: 96.0,
                grid: 110.0,
                horse: 58.0,
                mount: 58.0,
                page: 176.0,
            },
            shading: 0.35,
            light_falloff: 0.08,
            shadowed_panel: None,
            blur_px: 0.7,
            grain_sd: 2.0,
            scratches: 6,
            rider: false,
        }
    }
}

impl SpecimenStyle {
    /// A plate in the manner of *Animal Locomotion* (1887): a light wall ruled every 5 cm, heavier uprights, no numbers on the
    /// wall, a dark horse with light and shade, narrow black gutters.
    pub fn animal_locomotion() -> Self {
        Self {
            columns: 6,
            rows: 2,
            panel_px: [240.0, 222.0],
            gutter_px: [9.0, 22.0],
            margin_px: 14.0,
            fill: 0.9,
            upright_spacing_m: 1.0,
            upright_width_m: 0.03,
            upright_numbers: false,
            grid: Grid::Full,
            grid_spacing_m: 0.05,
            tones: Tones {
                wall: 188.0,
                ground: 118.0,
                uprights: 74.0,
                grid: 160.0,
                horse: 56.0,
                mount: 26.0,
                page: 26.0,
            },
            shading: 0.8,
            ..Self::default()
        }
    }

    /// A grey horse before a dark wall with a white grid, on paper.
    pub fn dark_wall() -> Self {
        Self {
            mount: Mount::Light,
            tones: Tones {
                wall: 84.0,
                ground: 118.0,
                uprights: 172.0,
                grid: 116.0,
                horse: 150.0,
                mount: 222.0,
                page: 222.0,
            },
            shading: 0.65,
            ..Self::animal_locomotion()
        }
    }

    /// A plate as it may come: 2 to 6 columns, 1 to 5 rows, up to 3 degrees of tilt, uneven gutters, black or light mount, fold,
    /// caption, numbers, grain, blur, scratches, a panel half in shadow. Equal seeds give equal styles.
    pub fn random(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let columns = 2 + (5.0 * random.uniform()) as u32;
        let rows = 1 + (5.0 * random.uniform()) as u32;
        let gutter = random.between(6.0, 36.0);
        let margin_px = random.between(10.0, 70.0);
        let width = (RANDOM_PLATE_PX - 2.0 * margin_px) / f64::from(columns) - gutter;
        let width = width.min(520.0).min(RANDOM_PLATE_PX / f64::from(rows));
        let base = match (3.0 * random.uniform()) as u32 {
            0 => Self::default(),
            1 => Self::animal_locomotion(),
            _ => Self::dark_wall(),
        };
        let tilted = random.uniform() < 0.7;
        let shadowed = random.uniform() < 0.25;
        Self {
            seed,
            columns,
            rows,
            panel_px: [width, width * random.between(0.6, 1.0)],
            gutter_px: [gutter, gutter * random.between(0.7, 1.8)],
            unevenness: random.between(0.0, 0.6),
            margin_px,
            tilt_deg: if tilted { random.between(-3.0, 3.0) } else { 0.0 },
            panel_tilt_sd_deg: random.between(0.0, 0.4),
            fold: random.uniform() < 0.25,
            caption: random.uniform() < 0.6,
            numbers: random.uniform() < 0.7,
            camera_distance_m: random.between(9.0, 15.0),
            camera_height_m: random.between(0.9, 1.4),
            wall_distance_m: random.between(1.2, 3.0),
            fill: random.between(0.65, 0.92),
            first_axis_mark: random.between(2.0, 6.0),
            light_falloff: random.between(0.0, 0.3),
            shadowed_panel: shadowed.then(|| 1 + (f64::from(columns * rows) * random.uniform()) as u32),
            blur_px: random.between(0.4, 1.4),
            grain_sd: random.between(1.0, 9.0),
            scratches: (40.0 * random.uniform()) as u32,
            rider: random.uniform() < 0.3,
            ..base.with_random_tones(&mut random)
        }
    }

    fn with_random_tones(mut self, random: &mut Random) -> Self {
        let tones = &mut self.tones;
        for tone in [&mut tones.ground, &mut tones.uprights, &mut tones.grid, &mut tones.horse] {
            *tone += random.between(-12.0, 12.0);
        }
        tones.wall = (tones.wall + random.between(-25.0, 25.0)).min(WHITEST_PAPER - LEAST_EDGE);
        self.mount = if random.uniform() < 0.5 { Mount::Dark } else { Mount::Light };
        tones.mount = match self.mount {
            Mount::Dark => random.between(8.0, (tones.wall - LEAST_EDGE).min(70.0)),
            Mount::Light => random.between((tones.wall + LEAST_EDGE).max(200.0), WHITEST_PAPER),
        };
        tones.page = match self.mount {
            Mount::Dark if random.uniform() < 0.5 => random.between(165.0, 235.0),
            Mount::Dark | Mount::Light => tones.mount,
        };
        self.shading *= random.between(0.6, 1.1);
        self
    }
}
