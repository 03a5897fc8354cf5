//! What a mean stride's annotation says of itself: how many strides, how far apart, what was taken and left out.

use muybridge_capture::Keypoint;

use super::MeanStride;
use super::clip::Clip;
use super::documents::{BIAS, WIDE_SPREADS};
use super::mean::{MeanPlace, PHASES};

/// The notes of a mean stride's annotation, in words.
pub(super) fn notes(clip: &Clip, mean: &MeanStride) -> Vec<String> {
    let percent = |share: f64| 100.0 * share;
    let [median, worst] = mean.spread().map(percent);
    let [first, last] = mean.sizes.map(|size| size.map(percent));
    let mut notes = vec![
        format!(
            "The mean of {:.1} strides of {:.2} frames, frames {} to {}; panel k is phase (k - 1) / {PHASES}, phase 0 the first frame's.",
            mean.strides.count, mean.strides.period_frames, clip.named_frames[0], clip.named_frames[1]
        ),
        format!(
            "Spread between strides, standard deviation of a coordinate: median {median:.2} % of withers height, worst {worst:.2} %. sd_px is the standard error of the mean with {:.1} % for what every stride has wrong alike.",
            percent(BIAS)
        ),
        format!(
            "Taken out: the animal's advance, and its change of size (length {:.0} to {:.0} %, height {:.0} to {:.0} % of that in the middle of the clip), and a slow drift of each point.",
            first[0], last[0], first[1], last[1]
        ),
        format!(
            "Left out: {} places the tracker does not trust, {} that no stride explains; {} were moved to the other leg. Not ours: {}.",
            clip.drop_outs, mean.jumps, mean.swaps, clip.naming.left_out
        ),
        "The frame rate is not stated and nor is any length: speed and times are inferred from the stride's length at an assumed withers height.".into(),
        "Contacts: a hoof stands where it is at its lowest and falls back as the trunk advances; unknown where only one of the two holds.".into(),
    ];
    if mean.parallax().is_some_and(|parallax| parallax < 0.0) {
        notes.push("Off legs overtake near ones as the animal passes: near and off may be exchanged.".into());
    }
    notes.extend(missing(mean));
    notes
}

/// Keypoints that some phases lack.
fn missing(mean: &MeanStride) -> Option<String> {
    let is_there = |place: &Option<MeanPlace>| place.is_some_and(|place| place.spread <= WIDE_SPREADS[1]);
    let lacks = |keypoint: Keypoint| {
        let point = mean.points.iter().find(|point| point.keypoint == keypoint)?;
        let phases = point.places.iter().filter(|place| !is_there(place)).count();
        (phases > 0).then(|| format!("{keypoint} in {phases}"))
    };
    let list: Vec<String> = Keypoint::all().filter_map(lacks).collect();
    (!list.is_empty())
        .then(|| format!("Missing, because too few strides show them: {} panels.", list.join(", ")))
}
