//! The worst of each quantity, when and where it was seen, and the limits it must keep.

use muybridge_core::{Limb, Skeleton};

/// What is measured. Distances are in metres, angles in radians.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// Numbers of a pose or a readout that are none.
    NotFinite,
    /// Farthest a standing toe is from its place at the stance's beginning, horizontally.
    StanceSlide,
    /// Deepest a standing toe is under the ground there.
    Sink,
    /// Highest a standing toe is over the ground there.
    Float,
    /// Farthest a standing toe is from the print that the readout states.
    PrintApart,
    /// Farthest a bend is outside the skeleton's limits.
    BendBeyondLimit,
    /// Greatest change of a bone's length.
    BoneLength,
    /// How much farther than the sum of the leg's bones a toe is from where the leg hangs.
    LegReach,
    /// How much faster than [`TOE_SPEED_FACTOR`] times the horse a toe moves, m/s.
    ToeSpeed,
    /// How far the root is from where it would have flown on to, less what [`ROOT_ACCELERATION_M_S2`] explains.
    RootJump,
    /// Fastest change of a bend, rad/s.
    BendSpeed,
    /// Greatest second difference of a bend, rad/s^2.
    BendAcceleration,
    /// Deepest a swinging toe or another joint is under the ground.
    UnderGround,
    /// Share of its stance that was left when a foot left the ground.
    BrokenStance,
    /// How far the body was let down for its feet.
    Lowered,
}

/// A toe in swing moves up to 2.6 times as fast as the horse; with this factor a foot that is put somewhere else shows.
pub const TOE_SPEED_FACTOR: f64 = 3.5;
/// Acceleration of the root that is a motion and no jump, m/s^2: twice the greatest in the database (gallop, 77).
pub const ROOT_ACCELERATION_M_S2: f64 = 150.0;

impl Quantity {
    /// Number of quantities.
    pub const COUNT: usize = 15;
    /// Every quantity, in the order of the tables.
    pub const ALL: [Self; Self::COUNT] = [
        Self::NotFinite,
        Self::StanceSlide,
        Self::Sink,
        Self::Float,
        Self::PrintApart,
        Self::BendBeyondLimit,
        Self::BoneLength,
        Self::LegReach,
        Self::ToeSpeed,
        Self::RootJump,
        Self::BendSpeed,
        Self::BendAcceleration,
        Self::UnderGround,
        Self::BrokenStance,
        Self::Lowered,
    ];

    /// Plain name for tables.
    pub fn name(self) -> &'static str {
        self.row().0
    }

    /// Unit that tables show it in.
    pub fn unit(self) -> &'static str {
        self.row().1
    }

    /// What to multiply it with for that unit.
    pub fn per_unit(self) -> f64 {
        self.row().2
    }

    fn row(self) -> (&'static str, &'static str, f64) {
        match self {
            Self::NotFinite => ("not finite", "numbers", 1.0),
            Self::StanceSlide => ("stance slide", "mm", 1e3),
            Self::Sink => ("sink in stance", "mm", 1e3),
            Self::Float => ("float in stance", "mm", 1e3),
            Self::PrintApart => ("toe from its print", "mm", 1e3),
            Self::BendBeyondLimit => ("bend beyond limit", "mrad", 1e3),
            Self::BoneLength => ("change of a bone's length", "mm", 1e3),
            Self::LegReach => ("leg longer than its bones", "mm", 1e3),
            Self::ToeSpeed => ("toe faster than 3.5 x the horse", "m/s", 1.0),
            Self::RootJump => ("jump of the root", "mm", 1e3),
            Self::BendSpeed => ("bend speed", "rad/s", 1.0),
            Self::BendAcceleration => ("bend acceleration", "rad/s2", 1.0),
            Self::UnderGround => ("under the ground in swing", "mm", 1e3),
            Self::BrokenStance => ("stance broken off", "%", 100.0),
            Self::Lowered => ("body let down", "mm", 1e3),
        }
    }
}

/// The part of the horse a value belongs to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Part {
    /// Root or whole body.
    #[default]
    Body,
    /// A leg.
    Leg(Limb),
    /// A bone.
    Bone(usize),
}

impl Part {
    /// Its name in a skeleton: `LF`, `RH tibia`, `head`.
    pub fn name(self, skeleton: &Skeleton) -> String {
        match self {
            Self::Body => "body".into(),
            Self::Leg(limb) => limb.abbreviation().into(),
            Self::Bone(index) => {
                let limb = Skeleton::limb_of(index).map_or("", Limb::abbreviation);
                let bone = skeleton.bones.get(index).map_or("", |bone| bone.name.as_str());
                format!("{limb} {bone}").trim().to_string()
            }
        }
    }
}

/// The worst value of a quantity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Worst {
    /// The value; 0 where nothing was seen.
    pub value: f64,
    /// When, seconds since the inspection began.
    pub at_s: f64,
    /// Where.
    pub part: Part,
}

/// The worst of everything, and how much was looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Findings {
    worst: [Worst; Quantity::COUNT],
    /// Steps looked at.
    pub steps: u64,
    /// Stances begun.
    pub stances: u64,
    /// Time looked at, s.
    pub time_s: f64,
}

/// A limit that was broken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Broken {
    /// Which quantity.
    pub quantity: Quantity,
    /// Its worst value.
    pub worst: Worst,
    /// Its limit.
    pub limit: f64,
}

impl std::fmt::Display for Broken {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (quantity, worst) = (self.quantity, self.worst);
        let (k, unit) = (quantity.per_unit(), quantity.unit());
        write!(
            f,
            "{}: {:.3} {unit} at {:.3} s ({:?}); at most {:.3}",
            quantity.name(),
            worst.value * k,
            worst.at_s,
            worst.part,
            self.limit * k
        )
    }
}

impl Findings {
    /// The worst value of a quantity so far.
    pub fn worst(&self, quantity: Quantity) -> Worst {
        self.worst[quantity as usize]
    }

    /// Takes a value in; what is no number is worse than any number.
    pub fn see(&mut self, quantity: Quantity, value: f64, at_s: f64, part: Part) {
        let value = if value.is_nan() { f64::INFINITY } else { value };
        let worst = &mut self.worst[quantity as usize];
        if value > worst.value {
            *worst = Worst { value, at_s, part };
        }
    }

    /// The worse of both, each with its own time; numbers of steps, stances and seconds are added.
    pub fn merge(&mut self, other: &Self) {
        for (mine, theirs) in self.worst.iter_mut().zip(&other.worst) {
            if theirs.value > mine.value {
                *mine = *theirs;
            }
        }
        self.steps += other.steps;
        self.stances += other.stances;
        self.time_s += other.time_s;
    }

    /// Every limit that is broken.
    pub fn broken(&self, limits: &Limits) -> Vec<Broken> {
        let rows = Quantity::ALL.into_iter().map(|quantity| Broken {
            quantity,
            worst: self.worst(quantity),
            limit: limits.of(quantity),
        });
        rows.filter(|row| row.worst.value > row.limit).collect()
    }
}

/// The greatest value allowed of each quantity; infinite where it is only told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits([f64; Quantity::COUNT]);

/// Only told, not judged.
const TOLD: f64 = f64::INFINITY;

/// Limits of each quantity on the flat in every single thing a horse does there but leap, on the flat in anything, and on slopes,
/// steps and hills. The first eight rows are what a hoof that never slides, a body that never breaks and a leg that is never stretched
/// mean; they hold everywhere. The others are about smoothness: a leap, a riser met at a gallop or a mind changed three times a second is
/// not smooth, and what it comes to is told.
const LIMITS: [(Quantity, [f64; 3]); Quantity::COUNT] = [
    (Quantity::NotFinite, [0.0, 0.0, 0.0]),
    (Quantity::StanceSlide, [1e-4, 1e-4, 1e-4]),
    (Quantity::Sink, [1e-3, 1e-3, 5e-3]),
    (Quantity::Float, [1e-3, 1e-3, 5e-3]),
    (Quantity::PrintApart, [1e-3, 1e-3, 1e-3]),
    (Quantity::BendBeyondLimit, [1e-4, 1e-4, 1e-4]),
    (Quantity::BoneLength, [1e-5, 1e-5, 1e-5]),
    (Quantity::LegReach, [1e-5, 1e-5, 1e-5]),
    // A fifth of the speed of a toe in a gallop's swing.
    (Quantity::ToeSpeed, [10.0, TOLD, TOLD]),
    // Half a hundredth of the horse's height, in one step.
    (Quantity::RootJump, [0.01, TOLD, TOLD]),
    // Three and a half times the fastest of the database's strides.
    (Quantity::BendSpeed, [200.0, TOLD, TOLD]),
    (Quantity::BendAcceleration, [TOLD, TOLD, TOLD]),
    // As deep as the clearance of a swing on short legs.
    (Quantity::UnderGround, [0.035, TOLD, TOLD]),
    // A step of a fast gallop's stance at 120 steps a second is a tenth of it.
    (Quantity::BrokenStance, [0.05, TOLD, TOLD]),
    (Quantity::Lowered, [TOLD, TOLD, TOLD]),
];

impl Limits {
    /// On the flat, without a leap: as below, and smoothly.
    pub fn smooth() -> Self {
        Self::column(0)
    }

    /// On the flat: a toe slides by less than 0.1 mm and stands within 1 mm of the ground.
    pub fn flat() -> Self {
        Self::column(1)
    }

    /// On slopes, steps and hills: within 5 mm of the ground.
    pub fn terrain() -> Self {
        Self::column(2)
    }

    fn column(column: usize) -> Self {
        let mut limits = [TOLD; Quantity::COUNT];
        for (quantity, row) in LIMITS {
            limits[quantity as usize] = row[column];
        }
        Self(limits)
    }

    /// The limit of a quantity.
    pub fn of(&self, quantity: Quantity) -> f64 {
        self.0[quantity as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_is_kept_with_its_time_and_no_number_is_the_worst_of_all() {
        let mut findings = Findings::default();
        findings.see(Quantity::Sink, 0.002, 1.0, Part::Leg(Limb::LF));
        findings.see(Quantity::Sink, 0.001, 2.0, Part::Leg(Limb::RF));
        assert_eq!(
            findings.worst(Quantity::Sink),
            Worst { value: 0.002, at_s: 1.0, part: Part::Leg(Limb::LF) }
        );
        assert_eq!(findings.broken(&Limits::smooth()).len(), 1);
        assert_eq!(findings.broken(&Limits::terrain()), []);
        let mut other = Findings::default();
        other.see(Quantity::Sink, f64::NAN, 3.0, Part::Body);
        findings.merge(&other);
        assert_eq!(findings.worst(Quantity::Sink).at_s, 3.0);
    }
}
