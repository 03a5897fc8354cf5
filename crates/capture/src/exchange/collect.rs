//! Points found in files, put onto the panels of a plate.

use std::collections::BTreeMap;

use super::layout::{is_whole_image, stem};
use super::names::Meaning;
use super::notes::{Notes, Skipped, short};
use super::{ExchangeError, Format, NameTable, PanelPictures};
use crate::annotation::{KeypointState, Keypoints, Placed, PlacedBy};
use crate::keypoint::Keypoint;
use crate::manifest::{Manifest, Panel};
use crate::validation::PANEL_MARGIN_PX;

/// Steps of an imported coordinate, 1/px: a point that was placed at 123.4 comes back as 123.4.
const STEPS_PER_PX: f64 = 1e6;

/// Points read from files, in plate px.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Import {
    /// Panels with at least one point, in panel order.
    pub panels: Vec<(u32, Keypoints)>,
    /// What was skipped and what was assumed, counted, one sentence each.
    pub notes: Vec<String>,
    /// How much the files said of each point beyond its place.
    pub(super) said: BTreeMap<(u32, Keypoint), Said>,
}

/// What a file says of a point beyond its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Said {
    /// Seen or guessed; none where the format has no such thing.
    pub(super) state: Option<KeypointState>,
    /// Who placed it.
    pub(super) by: Origin,
}

/// What a file says of who placed a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Origin {
    /// It is written there for people to read and change.
    Stated(PlacedBy),
    /// It rides along in a key that the other tool does not show, and stays when a person moves the point there.
    Carried(PlacedBy),
    /// Nothing.
    Unsaid,
}

impl Import {
    /// Number of points.
    pub fn point_count(&self) -> usize {
        self.panels.iter().map(|(_, keypoints)| keypoints.iter().count()).sum()
    }
}

/// Where a file says that points are.
#[derive(Clone, Debug)]
pub(super) enum Target {
    /// In a picture of this name, with its size where the file states one, and the panel of the plate where it does.
    Picture { name: String, size_px: Option<[f64; 2]>, panel: Option<u32> },
    /// In a film of all panels: the picture of this index, from 0.
    Frame(usize),
    /// In this panel, in plate px.
    Panel(u32),
}

/// A point in a file.
#[derive(Clone, Debug)]
pub(super) struct FoundPoint {
    pub(super) name: String,
    /// In the format's own pixels; none for a point declared absent.
    pub(super) at: Option<[f64; 2]>,
    pub(super) said: Said,
}

/// One point that was taken.
struct Taken {
    at_px: Option<[f64; 2]>,
    said: Said,
    place: String,
    name: String,
}

/// Gathers points of all files.
pub(super) struct Collector<'a> {
    pub(super) manifest: &'a Manifest,
    panels: &'a dyn PanelPictures,
    names: NameTable,
    taken: BTreeMap<(u32, Keypoint), Taken>,
    pub(super) notes: Notes,
}

/// The pixels that a file speaks of.
enum Here<'a> {
    /// Of a panel, cut out.
    Cutout(&'a Panel),
    /// Of an image file of the plate.
    Image(usize),
    /// Of the plate, as in our own files: nothing is changed or rounded.
    Plate,
}

impl<'a> Collector<'a> {
    pub(super) fn new(manifest: &'a Manifest, panels: &'a dyn PanelPictures, names: NameTable) -> Self {
        Self { manifest, panels, names, taken: BTreeMap::new(), notes: Notes::default() }
    }

    pub(super) fn finish(self) -> Import {
        let mut panels: BTreeMap<u32, Keypoints> = BTreeMap::new();
        let mut said = BTreeMap::new();
        for ((panel, keypoint), taken) in self.taken {
            let state = taken.said.state.unwrap_or(KeypointState::Visible);
            let by = match taken.said.by {
                Origin::Stated(by) | Origin::Carried(by) => by,
                Origin::Unsaid => PlacedBy::Hand,
            };
            panels
                .entry(panel)
                .or_default()
                .insert(keypoint, Placed { at_px: taken.at_px, state, by, sd_px: None });
            said.insert((panel, keypoint), taken.said);
        }
        Import { panels: panels.into_iter().collect(), notes: self.notes.sentences(), said }
    }

    /// Takes the points that a file has at one place (`place`: its row or entry, for messages).
    pub(super) fn take(
        &mut self,
        file: &str,
        place: &str,
        format: Format,
        target: &Target,
        points: Vec<FoundPoint>,
    ) -> Result<(), ExchangeError> {
        let (here, panel) = match self.resolve(target) {
            Ok(found) => found,
            Err((why, example)) => {
                self.notes.skip_many(why, points.len(), example);
                return Ok(());
            }
        };
        let offset = 0.5 - format.first_pixel_centre_px();
        let points: Vec<FoundPoint> = points
            .into_iter()
            .map(|point| FoundPoint { at: point.at.map(|at| at.map(|v| v + offset)), ..point })
            .collect();
        let Some(panel) = panel.or_else(|| self.panel_around(&here, &points)) else {
            self.notes.skip_many(Skipped::Outside, points.len(), place);
            return Ok(());
        };
        for point in points {
            self.take_point(file, place, &here, panel, &point)?;
        }
        Ok(())
    }

    fn take_point(
        &mut self,
        file: &str,
        place: &str,
        here: &Here<'_>,
        panel: &'a Panel,
        point: &FoundPoint,
    ) -> Result<(), ExchangeError> {
        let keypoint = match self.names.meaning(&point.name) {
            Meaning::Point(keypoint) => keypoint,
            Meaning::Skip => return Ok(()),
            Meaning::NeedsFacing => {
                self.notes.skip(Skipped::NeedsFacing, short(&point.name));
                return Ok(());
            }
            Meaning::Unknown => {
                self.notes.skip(Skipped::UnknownName, short(&point.name));
                return Ok(());
            }
        };
        let number = panel.panel;
        let at_px = point.at.and_then(|at| self.on_plate(here, panel, at));
        if point.at.is_some() && at_px.is_none() {
            self.notes.skip(Skipped::Outside, format!("{keypoint} of panel {number}"));
            return Ok(());
        }
        if let Some(first) = self.taken.get(&(number, keypoint)) {
            return Err(ExchangeError::Twice {
                file: file.into(),
                place: place.into(),
                name: short(&point.name),
                panel: number,
                keypoint,
                first_place: first.place.clone(),
                first_name: first.name.clone(),
            });
        }
        let place = format!("{file}: {place}");
        let taken = Taken { at_px, said: point.said, place, name: short(&point.name) };
        self.taken.insert((number, keypoint), taken);
        Ok(())
    }

    /// A place in plate px; none when it lies outside the panel.
    fn on_plate(&self, here: &Here<'_>, panel: &Panel, at: [f64; 2]) -> Option<[f64; 2]> {
        let rounded = |at: [f64; 2]| at.map(|v| (v * STEPS_PER_PX).round() / STEPS_PER_PX);
        let on_plate = match here {
            Here::Plate => Some(at),
            Here::Image(_) => Some(rounded(at)),
            Here::Cutout(_) => self.panels.plate_from_panel(panel.panel, at).map(rounded),
        };
        on_plate.filter(|at| panel.contains(*at, PANEL_MARGIN_PX))
    }

    /// The picture that a file speaks of, and its panel where that is certain.
    fn resolve(&self, target: &Target) -> Result<(Here<'a>, Option<&'a Panel>), (Skipped, String)> {
        let manifest = self.manifest;
        let numbered = |number: u32| manifest.panels.iter().find(|panel| panel.panel == number);
        match target {
            Target::Panel(number) => {
                let panel = numbered(*number).ok_or_else(|| (Skipped::NoPanel, format!("panel {number}")))?;
                Ok((Here::Plate, Some(panel)))
            }
            Target::Frame(index) => {
                let panel = manifest.panels.get(*index);
                let panel = panel.ok_or_else(|| (Skipped::NoPanel, format!("frame {index}")))?;
                let whole = is_whole_image(manifest, panel);
                Ok((if whole { Here::Image(panel.image) } else { Here::Cutout(panel) }, Some(panel)))
            }
            Target::Picture { name, size_px, panel } => {
                let stated = panel.and_then(numbered);
                let (here, panel) = self.picture(name).ok_or_else(|| (Skipped::NoPanel, short(name)))?;
                let size = match here {
                    Here::Cutout(panel) => self.panels.size_px(panel.panel),
                    Here::Image(image) => manifest.images.get(image).map(|i| [i.width_px, i.height_px]),
                    Here::Plate => None,
                };
                let same = |(stated, ours): (&[f64; 2], [u32; 2])| *stated == ours.map(f64::from);
                if size_px.as_ref().zip(size).is_some_and(|both| !same(both)) {
                    return Err((Skipped::OtherSize, short(name)));
                }
                Ok((here, panel.or(stated)))
            }
        }
    }

    /// A picture by its name: an image of the plate, or else a cut-out, called `img003` or `panel_03`.
    fn picture(&self, name: &str) -> Option<(Here<'a>, Option<&'a Panel>)> {
        let wanted = stem(name);
        let mut images =
            (0..self.manifest.images.len()).filter(|i| stem(&self.manifest.images[*i].file) == wanted);
        if let Some(image) = images.next() {
            if images.next().is_some() {
                return None;
            }
            let mut panels = self.manifest.panels.iter().filter(|panel| panel.image == image);
            let only = panels.next().filter(|_| panels.next().is_none());
            return Some((Here::Image(image), only));
        }
        let digits = wanted.strip_prefix("img").or_else(|| wanted.strip_prefix("panel_"))?;
        let number: u32 = digits.bytes().all(|b| b.is_ascii_digit()).then(|| digits.parse().ok())??;
        let panel = self.manifest.panels.iter().find(|panel| panel.panel == number)?;
        Some((Here::Cutout(panel), Some(panel)))
    }

    /// The panel of an image that holds most of these points; none when none of them lies in any.
    fn panel_around(&self, here: &Here<'_>, points: &[FoundPoint]) -> Option<&'a Panel> {
        let Here::Image(image) = here else { return None };
        let inside = |panel: &Panel| {
            points.iter().filter_map(|point| point.at).filter(|at| panel.contains(*at, 0.0)).count()
        };
        let panels = self.manifest.panels.iter().filter(|panel| panel.image == *image);
        // The first of equals, so that the answer does not depend on anything else.
        let counted = panels.map(|panel| (inside(panel), panel)).filter(|(count, _)| *count > 0);
        counted
            .fold(None, |best: Option<(usize, &Panel)>, next| match best {
                Some(best) if best.0 >= next.0 => Some(best),
                _ => Some(next),
            })
            .map(|(_, panel)| panel)
    }
}
