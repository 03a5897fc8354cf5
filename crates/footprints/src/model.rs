//! Figures on two legs, as data.

mod checks;

use serde::{Deserialize, Serialize};

use crate::shape::Shape;
use crate::timing::TimingRule;

/// Schema version of a model file.
pub const MODEL_SCHEMA: u32 = 1;

/// Names of the models that are built in; the last one goes on four legs.
pub const MODEL_NAMES: [&str; 4] = ["bird", "dinosaur", "human", "horse"];

/// A sinusoidal swing of the body, driven by the phase of the step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sway {
    /// Amplitude, degrees.
    pub amplitude_deg: f64,
    /// Phase of the stride at which it is greatest, 0 to 1 from the left foot's strike.
    pub greatest_at: f64,
}

/// A foot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FootModel {
    /// From the middle of the print to the toe, metres; the heel is as far behind.
    pub toe_ahead_m: f64,
    /// Ankle from the middle of the print: ahead and up, metres.
    pub ankle_m: [f64; 2],
    /// Outline of the right print, x ahead and z to the right of its middle, metres, counter-clockwise or not.
    pub outline_m: Vec<[f64; 2]>,
    /// Most the heel rises, degrees.
    pub most_heel_rise_deg: f64,
    /// Share of the stance, 0 to 1, after which the heel rises even where the leg could still reach: toe-off is tuned with it.
    pub heel_off_at: f64,
    /// How far it has risen so at the end of the stance of a full step, degrees.
    pub toe_off_rise_deg: f64,
    /// How far the toes hang down in the middle of the swing, degrees.
    pub swing_droop_deg: f64,
    /// How far the sole is raised in the middle of the swing beside all else, metres.
    pub swing_clearance_m: f64,
}

/// A leg.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LegModel {
    /// Right hip from the centre of mass: ahead, up, to the right, metres; the left one is its mirror image.
    pub hip_from_com_m: [f64; 3],
    /// Comfortable length of the virtual leg from hip to ankle, metres.
    pub nominal_m: f64,
    /// Longest virtual leg, metres.
    pub longest_m: f64,
    /// Lengths of the segments from hip to ankle, metres: two (thigh, shank) or three (and metatarsus).
    pub segments_m: Vec<f64>,
    /// Flexion of the joints between the segments in the folded leg, degrees: of the knee, which points forwards, and of the hock, which
    /// points backwards. In a leg that is folded less, both bend in this proportion; straight is 0.
    pub fold_deg: Vec<f64>,
    /// Share of the comfortable length to which the leg is retracted in the middle of a walking step's swing, 0 to 1.
    pub retracted: f64,
    /// The same in a running step, and while the leg has nothing to do (hopping on the other one).
    pub retracted_running: f64,
    /// The foot.
    pub foot: FootModel,
}

/// A figure on two legs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Model {
    /// Schema version: [`MODEL_SCHEMA`].
    pub schema: u32,
    /// Name.
    pub name: String,
    /// Where the numbers come from.
    pub about: String,
    /// Both legs.
    pub leg: LegModel,
    /// Time over which the feet's orientation is averaged for the body's, s.
    pub body_window_s: f64,
    /// Pitch, nose up positive, twice a stride.
    pub pitch: Sway,
    /// Roll to the right, once a stride.
    pub roll: Sway,
    /// Step length and width for prints laid along a path, metres.
    pub step_m: [f64; 2],
    /// Automatic times.
    pub timing: TimingRule,
    /// What it looks like.
    pub shape: Shape,
}

/// What is wrong with a model file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// The text is no model.
    #[error("{at}: {cause}")]
    Text {
        /// Field or line.
        at: String,
        /// What the reader says.
        cause: String,
    },
    /// A number that cannot be.
    #[error("{0}")]
    Number(String),
}

impl Model {
    /// A built-in two-legged model: bird, dinosaur or human.
    pub fn named(name: &str) -> Option<Self> {
        let text = match name {
            "bird" => include_str!("../data/bird.json"),
            "dinosaur" => include_str!("../data/dinosaur.json"),
            "human" => include_str!("../data/human.json"),
            _ => return None,
        };
        Self::from_json(text).ok()
    }

    /// Reads a model.
    ///
    /// # Errors
    /// When it is no model, or its numbers cannot be (lengths that are not positive, `nominal_m` not below `longest_m`, ...).
    pub fn from_json(text: &str) -> Result<Self, ModelError> {
        let model: Self = serde_json::from_str(text).map_err(|error| ModelError::Text {
            at: format!("line {}, column {}", error.line(), error.column()),
            cause: error.to_string(),
        })?;
        checks::check(&model).map_err(ModelError::Number)?;
        Ok(model)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    #[test]
    fn built_in_models_are_read_and_are_those_of_the_list() {
        for name in &MODEL_NAMES[..3] {
            let model = Model::named(name).unwrap();
            assert_eq!(&model.name, name);
            let again = serde_json::to_string(&model).unwrap();
            assert_eq!(Model::from_json(&again).unwrap(), model);
        }
        assert!(Model::named("horse").is_none() && Model::named("").is_none());
        let texts = [include_str!("../data/bird.json"), include_str!("../data/dinosaur.json")];
        for text in texts.into_iter().chain([include_str!("../data/human.json")]) {
            Model::from_json(text).unwrap();
        }
    }

    /// A built-in model with one value replaced, at a JSON pointer.
    fn changed(at: &str, value: Value) -> Result<Model, ModelError> {
        let mut file: Value = serde_json::from_str(include_str!("../data/human.json")).unwrap();
        *file.pointer_mut(at).unwrap() = value;
        Model::from_json(&file.to_string())
    }

    #[test]
    fn numbers_that_cannot_be_are_named() {
        let cases = [
            ("/schema", json!(2), "schema"),
            ("/leg/nominal_m", json!(0.0), "leg.nominal_m"),
            ("/leg/nominal_m", json!(0.9), "leg.nominal_m"),
            ("/leg/longest_m", json!(0.95), "leg.longest_m"),
            ("/leg/segments_m", json!([0.43]), "leg.segments_m"),
            ("/leg/segments_m", json!([0.43, -0.43]), "leg.segments_m"),
            ("/leg/segments_m", json!([0.2, 0.2, 0.2, 0.26]), "leg.segments_m"),
            ("/leg/fold_deg", json!([120.0, 20.0]), "leg.fold_deg"),
            ("/leg/fold_deg", json!([10.0]), "leg.fold_deg"),
            ("/leg/retracted", json!(1.5), "leg.retracted"),
            ("/leg/hip_from_com_m/2", json!(-0.1), "leg.hip_from_com_m"),
            ("/leg/foot/toe_ahead_m", json!(0), "leg.foot.toe_ahead_m"),
            ("/leg/foot/outline_m", json!([[0, 0], [1, 1]]), "leg.foot.outline_m"),
            ("/leg/foot/most_heel_rise_deg", json!(120), "leg.foot.most_heel_rise_deg"),
            ("/body_window_s", json!(1e9), "body_window_s"),
            ("/pitch/amplitude_deg", json!(90), "pitch.amplitude_deg"),
            ("/roll/greatest_at", json!(-1), "roll.greatest_at"),
            ("/step_m/0", json!(0), "step_m"),
            ("/timing/step_times", json!([]), "step_times"),
            ("/timing/step_times", json!([[1, 0.5], [0.5, 0.5]]), "step_times"),
            ("/timing/stance_times/0/1", json!(-1), "stance_times"),
            ("/shape/body/0/radii_m", json!([[0.1, 0.1]]), "shape.body"),
            ("/shape/legs", json!([]), "shape.legs"),
        ];
        for (at, value, named) in cases {
            let error = changed(at, value.clone()).unwrap_err();
            let ModelError::Number(text) = &error else { panic!("{at} {value}: {error}") };
            assert!(text.contains(named), "{at} {value}: {text}");
        }
    }

    #[test]
    fn texts_that_are_no_model_are_refused_with_their_place() {
        for text in ["", "{", "[]", "null", "{\"schema\": 1}", "\u{0}"] {
            assert!(matches!(Model::from_json(text), Err(ModelError::Text { .. })), "{text:?}");
        }
        let unknown = include_str!("../data/human.json").replacen("\"leg\"", "\"wings\": 2, \"leg\"", 1);
        assert!(Model::from_json(&unknown).unwrap_err().to_string().contains("wings"));
        let infinite = include_str!("../data/human.json").replacen("0.43", "1e999", 1);
        assert!(Model::from_json(&infinite).is_err());
    }
}
