//! The energy at one moment: the force that nobody exerts, and the legs that are not as long as is comfortable
//! (van de Panne 1997, 2.4.1 and 2.4.2).
//!
//! The required force per mass is `v = a - g`. A foot on the ground pushes along the line from its point of support through the centre
//! of mass, so that all feet together exert any force in the cone of these directions. What is missing is the distance of `v` from the
//! cone: for no foot its length, for one foot Fig. 7, for two the plane and triangle of Fig. 8 with the rule of an edge outside it. Three
//! and four feet of a horse are the same with more edges.
//!
//! A leg longer than it can be makes its heel rise: the virtual leg, from hip to ankle, then stays as long as it is, and the support is at
//! the toe. Only a hip that foot and leg together do not reach from the toe is uncomfortable anew.

use glam::{DMat3, DVec3};

/// Acceleration of gravity, m/s².
pub(crate) const GRAVITY: DVec3 = DVec3::new(0.0, -9.81, 0.0);
/// Two or three directions whose (squared) area or volume is less than this count as lying in a line or plane.
const FLAT: f64 = 1e-10;
/// A force less than this towards the ground is none: rounding on an edge of the cone.
const NO_PULL: f64 = -1e-12;
/// Prints and hips that are apart by less are the same, metres.
const SAME_PRINT_M: f64 = 1e-6;
const SAME_HIP_M: f64 = 1e-3;
/// Most feet on the ground.
pub(crate) const MOST_FEET: usize = 4;

/// A foot on the ground at one moment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Support {
    /// Ankle with the foot flat, world space, metres.
    pub(crate) ankle: DVec3,
    /// Point of support with the foot flat, world space, metres.
    pub(crate) middle: DVec3,
    /// From there to the toe, metres.
    pub(crate) toe_from_middle: DVec3,
    /// Hip from the centre of mass, world space, metres.
    pub(crate) hip: DVec3,
    /// Where the force goes through, from the centre of mass, world space, metres.
    pub(crate) through: DVec3,
    /// Comfortable and longest length of the virtual leg, metres.
    pub(crate) nominal_m: f64,
    pub(crate) longest_m: f64,
}

/// A leg for a place of the centre of mass.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Push {
    /// From the ankle of the flat foot to the hip, unit length, and that far, metres.
    along: DVec3,
    length_m: f64,
    /// How much too long the virtual leg is, metres, and how much of a longer way from the flat foot it takes: none on the toes, as
    /// then the heel rises.
    longer_m: f64,
    gives: f64,
    /// From the toe to the hip, unit length, and that far, metres; how much that is beyond foot and leg together.
    from_toe: DVec3,
    toe_length_m: f64,
    beyond_m: f64,
    /// From the point of support to where the force goes through, unit length.
    direction: DVec3,
    distance_m: f64,
    /// How fast the point of support moves with the leg's length.
    toe_per_m: DVec3,
}

impl Support {
    /// Whether another support is the same but for what nobody sees: the hip hangs on a table of the body's orientation, which is read
    /// at other places of it when earlier steps take longer.
    pub(crate) fn is_near(&self, other: &Self) -> bool {
        self.ankle.abs_diff_eq(other.ankle, SAME_PRINT_M)
            && self.toe_from_middle.abs_diff_eq(other.toe_from_middle, SAME_PRINT_M)
            && self.hip.abs_diff_eq(other.hip, SAME_HIP_M)
    }

    /// The leg when the centre of mass is at a place; `toe_band_m` as in [`crate::Weights`].
    pub(crate) fn push(&self, centre: DVec3, toe_band_m: f64) -> Push {
        let hip = centre + self.hip;
        let (along, length_m) = direction(hip - self.ankle);
        let [shown_m, share, rate] = self.on_toes(length_m, toe_band_m);
        let (direction_of_force, distance_m) =
            direction(centre + self.through - self.middle - share * self.toe_from_middle);
        let toe = self.middle + self.toe_from_middle;
        let (from_toe, toe_length_m) = direction(hip - toe);
        Push {
            along,
            length_m,
            longer_m: shown_m - self.nominal_m,
            gives: 1.0 - share,
            from_toe,
            toe_length_m,
            beyond_m: (toe_length_m - self.ankle.distance(toe) - self.longest_m).max(0.0),
            direction: direction_of_force,
            distance_m,
            toe_per_m: rate * self.toe_from_middle,
        }
    }

    /// For a hip so far from the ankle of the flat foot: the length of the leg, which grows no more once the heel rises; how far the
    /// support is from the middle of the foot (0) to its toe (1); and how fast that grows.
    fn on_toes(&self, length_m: f64, toe_band_m: f64) -> [f64; 3] {
        let beyond_m = length_m - self.longest_m;
        if beyond_m <= 0.0 {
            return [length_m, 0.0, 0.0];
        }
        if beyond_m >= toe_band_m {
            return [self.longest_m + 0.5 * toe_band_m, 1.0, 0.0];
        }
        let x = beyond_m / toe_band_m;
        let (square, cube) = (x * x, x * x * x);
        let shown_m = self.longest_m + toe_band_m * (x - cube + 0.5 * square * square);
        [shown_m, 3.0 * square - 2.0 * cube, 6.0 * (x - square) / toe_band_m]
    }
}

/// A vector's direction, upwards where it has none, and its length.
fn direction(of: DVec3) -> (DVec3, f64) {
    let length = of.length();
    (if length > 0.0 { of / length } else { DVec3::Y }, length)
}

impl Push {
    /// Square of what the leg is too long or too short, m².
    fn discomfort_m2(&self) -> f64 {
        self.longer_m * self.longer_m + self.beyond_m * self.beyond_m
    }

    fn add_discomfort(&self, comfort_per_s2: f64, all: &mut Derivatives) {
        let twice = 2.0 * comfort_per_s2;
        all.energy += comfort_per_s2 * self.discomfort_m2();
        all.by_place += twice * (self.longer_m * self.gives * self.along + self.beyond_m * self.from_toe);
        let along = outer(self.along, self.along);
        // A leg that is too short bends the energy the other way across it: left out, as the sum must not be negative.
        let across = (self.longer_m * self.gives / self.length_m.max(1e-6)).max(0.0);
        all.bend_place += (along * (self.gives * self.gives) + (DMat3::IDENTITY - along) * across) * twice;
        if self.beyond_m > 0.0 {
            let along = outer(self.from_toe, self.from_toe);
            let across = self.beyond_m / self.toe_length_m.max(1e-6);
            all.bend_place += (along + (DMat3::IDENTITY - along) * across) * twice;
        }
    }

    /// Derivative of the direction by the centre's place.
    fn direction_by_place(&self) -> DMat3 {
        let across =
            (DMat3::IDENTITY - outer(self.direction, self.direction)) * (1.0 / self.distance_m.max(1e-6));
        across * (DMat3::IDENTITY - outer(self.toe_per_m, self.along))
    }
}

/// What the feet cannot exert of a force.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Missing {
    /// The force that is missing, m/s².
    pub(crate) force: DVec3,
    /// The feet that push, and how much, m/s².
    pushing: [(usize, f64); 3],
    count: usize,
}

impl Missing {
    fn new(required: DVec3, directions: &[Push], pushing: &[(usize, f64)]) -> Self {
        let exerted: DVec3 = pushing.iter().map(|&(foot, force)| force * directions[foot].direction).sum();
        let mut missing = Self { force: required - exerted, pushing: [(0, 0.0); 3], count: pushing.len() };
        missing.pushing[..pushing.len()].copy_from_slice(pushing);
        missing
    }

    fn or(self, other: Option<Self>) -> Self {
        match other {
            Some(other) if other.force.length_squared() < self.force.length_squared() => other,
            _ => self,
        }
    }

    fn pushing(&self) -> &[(usize, f64)] {
        &self.pushing[..self.count]
    }

    /// The part of space that the pushing feet do not span.
    fn unsupported(&self, pushes: &[Push]) -> DMat3 {
        let direction = |i: usize| pushes[self.pushing[i].0].direction;
        match self.count {
            0 => DMat3::IDENTITY,
            1 => DMat3::IDENTITY - outer(direction(0), direction(0)),
            2 => {
                let normal = direction(0).cross(direction(1)).normalize_or_zero();
                outer(normal, normal)
            }
            _ => DMat3::ZERO,
        }
    }

    /// Derivative of the exerted force by the centre's place, the feet pushing as they do.
    fn exerted_by_place(&self, pushes: &[Push]) -> DMat3 {
        let part = |&(foot, force): &(usize, f64)| force * pushes[foot].direction_by_place();
        self.pushing().iter().map(part).fold(DMat3::ZERO, |sum, part| sum + part)
    }
}

/// The distance of a required force from what feet exert that only push.
pub(crate) fn missing(required: DVec3, pushes: &[Push]) -> Missing {
    // Two feet that both push leave the least: nothing else has to be tried.
    if let [_, _] = pushes
        && let Some(both) = two(required, pushes, [0, 1])
    {
        return both;
    }
    let mut best = Missing::new(required, pushes, &[]);
    for i in 0..pushes.len() {
        best = best.or(one(required, pushes, i));
    }
    if pushes.len() > 2 {
        best = many(required, pushes, best);
    }
    best
}

/// The best of any two and any three of three or four feet.
fn many(required: DVec3, pushes: &[Push], mut best: Missing) -> Missing {
    for i in 0..pushes.len() {
        for j in 0..i {
            best = best.or(two(required, pushes, [j, i]));
        }
    }
    for left_out in 0..if pushes.len() == 3 { 1 } else { 4 } {
        let mut feet = [0; 3];
        let others = (0..pushes.len()).filter(|&foot| pushes.len() == 3 || foot != left_out);
        feet.iter_mut().zip(others).for_each(|(to, foot)| *to = foot);
        best = best.or(three(required, pushes, feet));
    }
    best
}

fn one(required: DVec3, pushes: &[Push], foot: usize) -> Option<Missing> {
    let force = required.dot(pushes[foot].direction);
    (force > 0.0).then(|| Missing::new(required, pushes, &[(foot, force)]))
}

fn two(required: DVec3, pushes: &[Push], [first, second]: [usize; 2]) -> Option<Missing> {
    let [a, b] = [first, second].map(|foot| pushes[foot].direction);
    let between = a.dot(b);
    let area = 1.0 - between * between;
    let [along_a, along_b] = [a, b].map(|direction| required.dot(direction));
    let forces = [(along_a - between * along_b) / area, (along_b - between * along_a) / area];
    let pushes_only = area > FLAT && forces[0] >= NO_PULL && forces[1] >= NO_PULL;
    pushes_only.then(|| Missing::new(required, pushes, &[(first, forces[0]), (second, forces[1])]))
}

fn three(required: DVec3, pushes: &[Push], feet: [usize; 3]) -> Option<Missing> {
    let [a, b, c] = feet.map(|foot| pushes[foot].direction);
    let volume = a.dot(b.cross(c));
    if volume * volume < FLAT {
        return None;
    }
    let forces = [b.cross(c), c.cross(a), a.cross(b)].map(|normal| required.dot(normal) / volume);
    let pushing = [(feet[0], forces[0]), (feet[1], forces[1]), (feet[2], forces[2])];
    forces.iter().all(|force| *force >= NO_PULL).then(|| Missing::new(required, pushes, &pushing))
}

pub(crate) fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

/// First and second derivatives of the energy at a moment by the place and the acceleration of the centre of mass.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Derivatives {
    pub(crate) energy: f64,
    pub(crate) foreseen: Foreseen,
    pub(crate) by_place: DVec3,
    pub(crate) by_acceleration: DVec3,
    /// Second derivatives: place with place, place (rows) with acceleration (columns), acceleration with acceleration. Of the force only
    /// its own curvature, so that the whole is never negative.
    pub(crate) bend_place: DMat3,
    pub(crate) bend_mixed: DMat3,
    pub(crate) bend_acceleration: DMat3,
}

impl Default for Derivatives {
    /// All zero; a matrix by default is not.
    fn default() -> Self {
        Self {
            energy: 0.0,
            foreseen: Foreseen::default(),
            by_place: DVec3::ZERO,
            by_acceleration: DVec3::ZERO,
            bend_place: DMat3::ZERO,
            bend_mixed: DMat3::ZERO,
            bend_acceleration: DMat3::ZERO,
        }
    }
}

/// The direction a missing force will have after a step, at most of unit length: the length of a force bends the more sharply the
/// smaller it is, and a step foresees that only when its direction is an unknown of its own (Chan, Golub & Mulet 1999, a primal-dual
/// method for total variation). It halves the steps of the solution.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Foreseen {
    direction: DVec3,
    force: DVec3,
    smoothed: f64,
}

impl Foreseen {
    fn follow(&self, force: DVec3, smoothed: f64) -> Self {
        if smoothed <= 0.0 {
            return Self::default();
        }
        let turned = if self.smoothed > 0.0 {
            self.direction * (self.force.dot(force - self.force) / self.smoothed)
        } else {
            DVec3::ZERO
        };
        // Where nothing has moved only the smoothing is another.
        let has_moved = self.smoothed <= 0.0 || force != self.force;
        let direction =
            if has_moved { ((force - turned) / smoothed).clamp_length_max(1.0) } else { self.direction };
        Self { direction, force, smoothed }
    }
}

/// Weights at a moment, and what smooths the length of the missing force near zero, m/s².
#[derive(Clone, Copy, Debug)]
pub(crate) struct Terms {
    pub(crate) physics: f64,
    pub(crate) comfort_per_s2: f64,
    pub(crate) toe_band_m: f64,
    pub(crate) smoothing: f64,
}

/// The legs of a moment.
pub(crate) fn pushes(supports: &[Support], centre: DVec3, toe_band_m: f64) -> [Push; MOST_FEET] {
    let mut pushes = [Push::default(); MOST_FEET];
    for (push, support) in pushes.iter_mut().zip(supports) {
        *push = support.push(centre, toe_band_m);
    }
    pushes
}

/// Missing force (m/s², weighted) and discomfort (m/s², weighted) at a moment.
pub(crate) fn energy(supports: &[Support], centre: DVec3, acceleration: DVec3, terms: &Terms) -> [f64; 2] {
    let pushes = &pushes(supports, centre, terms.toe_band_m)[..supports.len()];
    let force = missing(acceleration - GRAVITY, pushes).force;
    let smoothed = (force.length_squared() + terms.smoothing * terms.smoothing).sqrt();
    let uncomfortable: f64 = pushes.iter().map(Push::discomfort_m2).sum();
    [terms.physics * smoothed, terms.comfort_per_s2 * uncomfortable]
}

/// The energy and its derivatives; `before` is what was foreseen a step ago.
pub(crate) fn derivatives(
    supports: &[Support],
    centre: DVec3,
    acceleration: DVec3,
    terms: &Terms,
    before: &Foreseen,
) -> Derivatives {
    let pushes = &pushes(supports, centre, terms.toe_band_m)[..supports.len()];
    let missing = missing(acceleration - GRAVITY, pushes);
    let smoothed = (missing.force.length_squared() + terms.smoothing * terms.smoothing).sqrt();
    let foreseen = before.follow(missing.force, smoothed);
    let mut all = Derivatives { energy: terms.physics * smoothed, foreseen, ..Derivatives::default() };
    if smoothed > 0.0 {
        let share = missing.force / smoothed;
        let exerted = missing.exerted_by_place(pushes);
        all.by_acceleration = terms.physics * share;
        all.by_place = -(exerted.transpose() * all.by_acceleration);
        let free = missing.unsupported(pushes);
        let along = outer(free * foreseen.direction, share);
        all.bend_acceleration = (free - (along + along.transpose()) * 0.5) * (terms.physics / smoothed);
        all.bend_mixed = -(exerted.transpose() * all.bend_acceleration);
        all.bend_place = -(all.bend_mixed * exerted);
    }
    for push in pushes {
        push.add_discomfort(terms.comfort_per_s2, &mut all);
    }
    all
}

#[cfg(test)]
mod tests;
