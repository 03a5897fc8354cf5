//! Tracks to begin with: those of `docs/footprints`, and an empty one.

use muybridge_footprints::Track;

/// A track to begin with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Example {
    /// The paper's first figure.
    WalkingBird,
    /// A dinosaur goes up.
    Stairs,
    /// A turn, then leaps.
    Leaps,
    /// A person runs.
    Runner,
    /// The distances alone say when to leap.
    AutomaticTiming,
    /// A person along a path.
    Path,
    /// A horse along a path.
    Trot,
    /// From stone to stone.
    River,
    /// Nothing yet.
    Empty,
}

macro_rules! text {
    ($name:literal) => {
        include_str!(concat!("../../../../docs/footprints/tracks/", $name, ".json"))
    };
}

impl Example {
    /// All, with their names.
    pub const ALL: [(Self, &'static str); 9] = [
        (Self::WalkingBird, "Walking bird"),
        (Self::Stairs, "Dinosaur on stairs"),
        (Self::Leaps, "A turn and leaps"),
        (Self::Runner, "Running human"),
        (Self::AutomaticTiming, "Bird, timed by its distances"),
        (Self::Path, "Human along a path"),
        (Self::Trot, "Horse in trot along a path"),
        (Self::River, "Stepping stones across a river"),
        (Self::Empty, "No prints"),
    ];

    /// The track.
    pub fn track(self) -> Track {
        let text = match self {
            Self::WalkingBird => text!("bird-walk"),
            Self::Stairs => text!("dinosaur-stairs"),
            Self::Leaps => text!("dinosaur-turn-and-leaps"),
            Self::Runner => text!("human-run"),
            Self::AutomaticTiming => text!("bird-automatic-timing"),
            Self::Path => text!("human-path"),
            Self::Trot => text!("horse-trot-uphill"),
            Self::River => text!("bird-river"),
            Self::Empty => return Track::new("bird"),
        };
        Track::from_json(text)
            .unwrap_or_else(|error| unreachable!("the tracks of docs/footprints are tested: {error}"))
    }
}
