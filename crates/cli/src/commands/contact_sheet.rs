//! The panels of a plate with points, skeleton and fit drawn over them.

use image::{GenericImageView, Rgb, RgbImage, imageops};
use muybridge_capture::{Keypoint, KeypointState, NearOff, Panel, PanelAnnotation, Plate, StanceLabel};
use muybridge_core::{BONE_COUNT, Limb, Pair, Skeleton};
use muybridge_fitting::chain::Attachment;
use muybridge_fitting::pipeline::PlateFit;

use super::canvas::{BONE_PX, Canvas};

const PAPER: Rgb<u8> = Rgb([236, 232, 222]);
const INK: Rgb<u8> = Rgb([40, 36, 30]);
const BODY: Rgb<u8> = Rgb([255, 214, 10]);
const NEAR: Rgb<u8> = Rgb([40, 220, 90]);
const OFF: Rgb<u8> = Rgb([255, 90, 220]);
const GROUND: Rgb<u8> = Rgb([60, 140, 255]);
const PLACED: Rgb<u8> = Rgb([255, 40, 40]);
/// Height of the caption under a panel, px.
const CAPTION: u32 = 26;
const GAP: u32 = 8;
/// Largest picture drawn, px: 0.6 GB of memory.
const LARGEST_PX: u64 = 200_000_000;

/// A contact sheet to be drawn.
pub(super) struct ContactSheet<'a> {
    pub(super) plate: &'a Plate,
    pub(super) fit: Option<&'a PlateFit>,
    /// One per image of the manifest; none where it is not on this machine.
    pub(super) images: Vec<Option<RgbImage>>,
    pub(super) zoom: u32,
    pub(super) columns: u32,
}

/// A panel's place on the plate, in whole px.
struct Crop {
    x: i64,
    y: i64,
    width: u32,
    height: u32,
}

impl Crop {
    fn new(panel: &Panel) -> Self {
        let bound = |axis: usize, pick: fn(f64, f64) -> f64, start: f64| {
            panel.quad_px.iter().map(|corner| corner[axis]).fold(start, pick)
        };
        let (x, y) = (bound(0, f64::min, f64::MAX).floor(), bound(1, f64::min, f64::MAX).floor());
        let (right, bottom) = (bound(0, f64::max, f64::MIN).ceil(), bound(1, f64::max, f64::MIN).ceil());
        Self {
            x: x as i64,
            y: y as i64,
            width: (right - x).max(1.0) as u32,
            height: (bottom - y).max(1.0) as u32,
        }
    }
}

impl ContactSheet<'_> {
    /// Draws the wanted panels (all, if none is named); none when there is none, or the picture would be too large.
    pub(super) fn draw(&self, wanted: &[u32]) -> Option<RgbImage> {
        let panels: Vec<(&Panel, &PanelAnnotation)> = self
            .plate
            .annotation
            .panels
            .iter()
            .filter(|panel| wanted.is_empty() || wanted.contains(&panel.panel))
            .filter_map(|panel| {
                Some((self.plate.manifest.panels.iter().find(|p| p.panel == panel.panel)?, panel))
            })
            .collect();
        let crops: Vec<Crop> = panels.iter().map(|(panel, _)| Crop::new(panel)).collect();
        let cell_width = crops.iter().map(|crop| crop.width).max()? * self.zoom + GAP;
        let cell_height = crops.iter().map(|crop| crop.height).max()? * self.zoom + CAPTION + GAP;
        let columns = self.columns.min(panels.len() as u32);
        let rows = (panels.len() as u32).div_ceil(columns);
        if u64::from(columns) * u64::from(cell_width) * u64::from(rows) * u64::from(cell_height) > LARGEST_PX
        {
            return None;
        }
        let mut canvas = Canvas::new(columns * cell_width + GAP, rows * cell_height + CAPTION + GAP, PAPER);
        for (i, ((panel, annotation), crop)) in panels.iter().zip(&crops).enumerate() {
            let at = [GAP + i as u32 % columns * cell_width, GAP + i as u32 / columns * cell_height];
            self.draw_panel(&mut canvas, at, crop, panel, annotation);
        }
        self.draw_legend(&mut canvas, rows * cell_height + GAP);
        Some(canvas.picture)
    }

    fn draw_panel(
        &self,
        canvas: &mut Canvas,
        at: [u32; 2],
        crop: &Crop,
        panel: &Panel,
        annotation: &PanelAnnotation,
    ) {
        let zoom = f64::from(self.zoom);
        if let Some(Some(image)) = self.images.get(panel.image) {
            let photograph = imageops::crop_imm(
                image,
                crop.x.max(0) as u32,
                crop.y.max(0) as u32,
                crop.width,
                crop.height,
            );
            let size = [photograph.width() * self.zoom, photograph.height() * self.zoom];
            let mut enlarged =
                imageops::resize(&photograph.to_image(), size[0], size[1], imageops::FilterType::CatmullRom);
            brighten_shadows(&mut enlarged);
            imageops::replace(&mut canvas.picture, &enlarged, i64::from(at[0]), i64::from(at[1]));
        }
        // The centre of plate pixel (0, 0) is at (0.5, 0.5) of its enlarged square.
        let sheet_from_plate = |p: [f64; 2]| {
            [
                f64::from(at[0]) + (p[0] - crop.x as f64) * zoom,
                f64::from(at[1]) + (p[1] - crop.y as f64) * zoom,
            ]
        };
        if let Some([left, right]) = annotation.ground_px.map(|line| line.map(sheet_from_plate)) {
            canvas.line(left, right, 1.5, GROUND);
        }
        self.draw_fit(canvas, annotation, &sheet_from_plate);
        for (keypoint, placed) in annotation.keypoints.iter() {
            let Some(place) = placed.place() else { continue };
            draw_point(canvas, keypoint, placed.state, sheet_from_plate(place));
        }
        let below = f64::from(at[1] + crop.height * self.zoom) + 4.0;
        canvas.text([f64::from(at[0]), below], &self.caption(annotation), INK);
    }

    /// The fitted skeleton, off limbs first, and a line from each placed point to its fitted one.
    fn draw_fit(
        &self,
        canvas: &mut Canvas,
        annotation: &PanelAnnotation,
        sheet: &impl Fn([f64; 2]) -> [f64; 2],
    ) {
        let Some(fitted) = self.fit else { return };
        let fit = &fitted.fit;
        let slot = fit
            .problem
            .order
            .iter()
            .position(|i| fit.observation.panels[*i].camera.panel == annotation.panel);
        let Some(slot) = slot else { return };
        let kinematics = &fit.kinematics()[slot];
        let facing = self.plate.facing;
        for colour in [OFF, BODY, NEAR] {
            for bone in (0..BONE_COUNT).filter(|bone| bone_colour(*bone, facing) == colour) {
                let ends = kinematics.bone(bone).map(|end| {
                    let camera = &fit.observation.panels[fit.problem.order[slot]].camera;
                    sheet(camera.plate_from_world([end[0], end[1], fit.bone_depth_m(bone)]))
                });
                canvas.line(ends[0], ends[1], BONE_PX, colour);
                canvas.dot(ends[1], 4, colour);
            }
        }
        let dock = fit.place_attachment_px(slot, kinematics, Attachment::Dock);
        let croup = fit.place_attachment_px(slot, kinematics, Attachment::Root);
        canvas.line(sheet(croup), sheet(dock), 1.5, BODY);
        for residual in fitted.residuals.iter().filter(|r| r.panel == annotation.panel) {
            canvas.line(sheet(residual.placed_px), sheet(residual.fitted_px), 1.5, PLACED);
        }
    }

    fn caption(&self, annotation: &PanelAnnotation) -> String {
        let mut caption = format!("{}", annotation.panel);
        let Some(fitted) = self.fit else { return caption };
        let panels = &fitted.fit.observation.panels;
        if let Some(panel) = panels.iter().find(|p| p.camera.panel == annotation.panel) {
            caption.push_str(&format!("  {:.0} ms", 1000.0 * panel.camera.time_s));
            let legs = |label: StanceLabel| -> Vec<&str> {
                let has = |limb: &Limb| panel.contacts[limb.index()] == label;
                Limb::ALL.into_iter().filter(has).map(Limb::abbreviation).collect()
            };
            let down = match (legs(StanceLabel::Stance), legs(StanceLabel::Unknown)) {
                (down, unknown) if !unknown.is_empty() => {
                    format!("down: {} (unknown: {})", down.join(" "), unknown.join(" "))
                }
                (down, _) if down.is_empty() => "in the air".to_string(),
                (down, _) => format!("down: {}", down.join(" ")),
            };
            caption.push_str(&format!("  {down}"));
        } else {
            caption.push_str("  not part of the stride");
        }
        caption
    }

    fn draw_legend(&self, canvas: &mut Canvas, top: u32) {
        let mut x = f64::from(GAP);
        let top = f64::from(top);
        for (colour, label) in [
            (NEAR, "near limbs (fit)"),
            (OFF, "off limbs (fit)"),
            (BODY, "body (fit)"),
            (PLACED, "placed: dot seen, ring guessed; line to the fit"),
            (GROUND, "ground line"),
        ] {
            canvas.line([x, top + 10.0], [x + 24.0, top + 10.0], 4.0, colour);
            canvas.text([x + 30.0, top], label, INK);
            x += 30.0 + 10.0 * label.len() as f64 + 20.0;
        }
    }
}

/// Silhouettes are nearly black; a gamma of 0.6 lets limbs part without hiding the rest.
fn brighten_shadows(picture: &mut RgbImage) {
    let table: Vec<u8> =
        (0..256u32).map(|v| (255.0 * (f64::from(v) / 255.0).powf(0.6)).round() as u8).collect();
    for pixel in picture.pixels_mut() {
        pixel.0 = pixel.0.map(|v| table[usize::from(v)]);
    }
}

fn bone_colour(bone: usize, facing: muybridge_capture::Facing) -> Rgb<u8> {
    match Skeleton::limb_of(bone).map(|limb| facing.near_off(limb.side())) {
        None => BODY,
        Some(NearOff::Near) => NEAR,
        Some(NearOff::Off) => OFF,
    }
}

fn draw_point(canvas: &mut Canvas, keypoint: Keypoint, state: KeypointState, at: [f64; 2]) {
    // Off fore and off hind points get a dark core, so that they are told from near ones where they meet.
    let off = matches!(keypoint, Keypoint::Limb(NearOff::Off, Pair::Fore | Pair::Hind, _));
    match state {
        KeypointState::Visible => {
            canvas.dot(at, 3, PLACED);
            if off {
                canvas.dot(at, 1, INK);
            }
        }
        KeypointState::Occluded => canvas.ring(at, 4, PLACED),
        KeypointState::Absent => {}
    }
}
