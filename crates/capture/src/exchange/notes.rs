//! What has to be said about an exchange, counted, in few sentences.

use std::collections::BTreeMap;

/// Examples shown with a note.
const EXAMPLES: usize = 5;

/// What was left away, in the order in which it is told.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Skipped {
    /// A picture or number that is no panel.
    NoPanel,
    /// A picture of another size than the panel's or plate's.
    OtherSize,
    /// A name that is no keypoint of ours.
    UnknownName,
    /// Left or right, and the plate's facing is not known.
    NeedsFacing,
    /// A place outside the panel.
    Outside,
    /// A place that is no number, or half of one.
    NoPlace,
    /// A state or visibility that does not exist.
    UnknownState,
    /// A prediction too unlikely to be a place.
    Unlikely,
    /// A shape or annotation that holds no points.
    NoPoints,
}

impl Skipped {
    fn sentence(self, count: usize, examples: &str) -> String {
        let s = if count == 1 { "" } else { "s" };
        match self {
            Self::NoPanel => {
                format!("{count} point{s} skipped: the picture is no panel of the plate ({examples})")
            }
            Self::OtherSize => format!(
                "{count} point{s} skipped: the picture has another size than here, so it was resized or the plate split anew ({examples})"
            ),
            Self::UnknownName => {
                format!("{count} point{s} skipped: no keypoint of ours is called that ({examples})")
            }
            Self::NeedsFacing => format!(
                "{count} point{s} skipped: left or right, but the manifest's `facing` is not known yet ({examples})"
            ),
            Self::Outside => format!("{count} point{s} skipped: outside the panel ({examples})"),
            Self::NoPlace => {
                format!("{count} point{s} skipped: the place is not two finite numbers ({examples})")
            }
            Self::UnknownState => format!("{count} point{s} skipped: no such state ({examples})"),
            Self::Unlikely => {
                format!("{count} point{s} skipped: predicted with next to no likelihood ({examples})")
            }
            Self::NoPoints => format!("{count} item{s} skipped: no keypoints in it ({examples})"),
        }
    }
}

/// Counts and examples of what was left away, and other remarks.
#[derive(Debug, Default)]
pub(super) struct Notes {
    skipped: BTreeMap<Skipped, (usize, Vec<String>)>,
    remarks: Vec<String>,
}

impl Notes {
    /// Counts one point; an example is kept if it is new and there are few.
    pub(super) fn skip(&mut self, why: Skipped, example: impl Into<String>) {
        self.skip_many(why, 1, example);
    }

    pub(super) fn skip_many(&mut self, why: Skipped, count: usize, example: impl Into<String>) {
        if count == 0 {
            return;
        }
        let (total, examples) = self.skipped.entry(why).or_default();
        *total += count;
        let example = example.into();
        if examples.len() <= EXAMPLES && !examples.contains(&example) {
            examples.push(example);
        }
    }

    /// A remark, said once.
    pub(super) fn remark(&mut self, remark: impl Into<String>) {
        let remark = remark.into();
        if !self.remarks.contains(&remark) {
            self.remarks.push(remark);
        }
    }

    pub(super) fn sentences(self) -> Vec<String> {
        let mut sentences = self.remarks;
        for (why, (count, examples)) in self.skipped {
            let shown: Vec<String> = examples.iter().take(EXAMPLES).map(|example| short(example)).collect();
            let more = if examples.len() > EXAMPLES { ", ..." } else { "" };
            sentences.push(why.sentence(count, &format!("{}{more}", shown.join(", "))));
        }
        sentences
    }
}

/// Longest piece of a file that a message repeats, characters.
const LONGEST_EXAMPLE: usize = 60;

/// Text of a file as a message may show it: one line, not long, nothing that steers a terminal.
pub(super) fn short(text: &str) -> String {
    let cleaned = text.chars().map(|c| if c.is_control() { ' ' } else { c });
    let mut shown: String = cleaned.take(LONGEST_EXAMPLE).collect();
    if text.chars().nth(LONGEST_EXAMPLE).is_some() {
        shown.push_str("...");
    }
    shown
}
