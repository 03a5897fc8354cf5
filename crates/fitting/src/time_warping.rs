//! The paper's own gait change, frame by frame: synchronous and asynchronous time warping (Huang 2012, section 3.3).
//!
//! The run time has its own way of changing gaits. This is the published one as it stands, to be held against it. Only the legs'
//! times are worked out; Eq. 3.18 and the mean of the body's postures after Eq. 3.20 mix poses at these times.
//!
//! Where the paper leaves something open:
//!
//! - *Keytimes.* Three per leg and stride: foot strike, lift-off, next foot strike (`N_k` = 3), each leg on its own (section 3.3
//!   names them; that the second strike closes the stride follows from Fig. 3.13).
//! - *Whole frames.* "Total frame numbers in M for one stride" (Table 3.1) is the stride time times the frame rate, rounded;
//!   keytimes need not fall on frames. The frame rate is not given and is the caller's.
//! - *Eq. 3.6, 3.7* hold within a stride. Beyond it both times go on counting: a stride more adds 1 and `L`.
//! - *Eq. 3.8* is said of one generic time and `N_e` motions: here two, with the weights of the transition.
//! - *Synchronous* weights and increments are not given; they are those of the asynchronous change (Eq. 3.11), so that the two
//!   differ in nothing but the legs' shares.
//! - *Generic time in the target* when the change begins, `t_2(0)` of Eq. 3.20, is the leg's generic time in the original motion:
//!   a strike is blended with a strike. Eq. 3.15 and 3.16 arrive at the end posture for no other choice.
//! - *Reference leg.* "We assign a leg": it is the caller's.
//! - *Eq. 3.13* gives no whole number; it is rounded, and `sigma*` is what Eq. 3.14 then adds up to, near 2.5.
//! - *Eq. 3.15* is with index `i` on both sides, which the text resolves: the target at the end, the original at the start. Both
//!   generic times count from the leg's last strike, in `[0, 1)`. "x = 2 or 3" leaves no nearest number within half a stride when
//!   `sigma*` is not 2.5 exactly; here x is the nearest whole number, which is 2 or 3 in all but rare cases.
//!
//! Two things follow that the paper does not mention. Its increments are averages over the stride (Eq. 3.9), so that a leg's pace
//! has a step where a change begins and where it ends: a stance goes on at twice the duty factor of its pace. And a leg keeps its own
//! share of the pace (Eq. 3.17) up to the last frame, where it falls into the common one.

use muybridge_core::{Contact, Database, Gait, Limb};

/// Foot strike, lift-off and next foot strike: `N_k` of Eq. 3.5.
const KEYTIME_COUNT: usize = 3;

/// Share of the stride a hoof is down, in double precision.
fn duty_factor(contact: Contact) -> f64 {
    (f64::from(contact.lift_off_phase) - f64::from(contact.strike_phase)).rem_euclid(1.0)
}

/// A gait at one speed as the warping sees it: `M_1` or `M_2`.
#[derive(Clone, Debug, PartialEq)]
pub struct WarpedMotion {
    frames_per_stride: f64,
    strikes: [f64; 4],
    duty_factors: [f64; 4],
}

impl WarpedMotion {
    /// A stride of a whole number of frames, at least one, with its contacts as phases; none when a leg is never down or never up,
    /// so that its keytimes fall together.
    pub fn new(contacts: [Contact; 4], frames_per_stride: u32) -> Option<Self> {
        let strikes = contacts.map(|contact| f64::from(contact.strike_phase));
        let duty_factors = contacts.map(duty_factor);
        Self::from_phases(strikes, duty_factors, frames_per_stride)
    }

    /// A gait of a database at a speed in m/s and a frame rate in 1/s; none for a gait without strides at whole miles per hour.
    pub fn of(database: &Database, gait: Gait, speed_m_s: f32, frame_rate_hz: f64) -> Option<Self> {
        let blend = database.at_speed(gait, speed_m_s)?;
        let (slower, faster) = (blend.slower.contacts, blend.faster.contacts);
        let strikes = slower.map(|contact| f64::from(contact.strike_phase));
        let duty_factors = std::array::from_fn(|j| {
            let [slower, faster] = [slower[j], faster[j]].map(duty_factor);
            slower + f64::from(blend.share) * (faster - slower)
        });
        let frames = (f64::from(blend.stride_time_s()) * frame_rate_hz).round();
        Self::from_phases(strikes, duty_factors, frames as u32)
    }

    fn from_phases(strikes: [f64; 4], duty_factors: [f64; 4], frames_per_stride: u32) -> Option<Self> {
        let has_keytimes = frames_per_stride > 0 && duty_factors.iter().all(|duty| *duty > 0.0);
        let frames_per_stride = f64::from(frames_per_stride);
        has_keytimes.then_some(Self { frames_per_stride, strikes, duty_factors })
    }

    /// `L` of Table 3.1.
    pub fn frames_per_stride(&self) -> f64 {
        self.frames_per_stride
    }

    /// Share of the stride each hoof is down, in the order of [`Limb::ALL`].
    pub fn duty_factors(&self) -> [f64; 4] {
        self.duty_factors
    }

    /// `K_1`, `K_2` and `K_3` of a leg, frames.
    fn keytimes(&self, limb: Limb) -> [f64; KEYTIME_COUNT] {
        let (strike, duty) = (self.strikes[limb.index()], self.duty_factors[limb.index()]);
        [strike, strike + duty, strike + 1.0].map(|phase| phase * self.frames_per_stride)
    }

    /// Generic time of a leg at an actual time in frames (Eq. 3.5, 3.6): whole at its strikes, halves at its lift-offs.
    pub fn generic_time(&self, limb: Limb, frame: f64) -> f64 {
        let keytimes = self.keytimes(limb);
        let strides = ((frame - keytimes[0]) / self.frames_per_stride).floor();
        let within = frame - strides * self.frames_per_stride;
        let m = usize::from(within >= keytimes[1]);
        let share = (within - keytimes[m]) / (keytimes[m + 1] - keytimes[m]);
        strides + (m as f64 + share) / (KEYTIME_COUNT - 1) as f64
    }

    /// Actual time in frames of a leg at its generic time (Eq. 3.7).
    pub fn actual_frame(&self, limb: Limb, generic_time: f64) -> f64 {
        let keytimes = self.keytimes(limb);
        let strides = generic_time.floor();
        let keys = (KEYTIME_COUNT - 1) as f64 * (generic_time - strides);
        let m = usize::from(keys >= 1.0);
        strides * self.frames_per_stride + keytimes[m] + (keys - m as f64) * (keytimes[m + 1] - keytimes[m])
    }
}

/// The four legs at one frame of a change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WarpedFrame {
    /// `w_2`: share of the target motion, 0 to 1.
    pub target_weight: f64,
    /// Generic time of each leg, counted on over the strides, in the order of [`Limb::ALL`].
    pub generic_times: [f64; 4],
    /// Actual time of each leg with both motions mixed (Eq. 3.8), frames.
    pub actual_frames: [f64; 4],
    /// The moment of the target's stride at which each leg is as far as it is now, phases in `[0, 1)`.
    pub target_phases: [f64; 4],
}

impl WarpedFrame {
    /// How far the legs are from one common moment of the target gait, 0 to 0.75 of its stride.
    pub fn spread(&self) -> f64 {
        cyclic_spread(self.target_phases)
    }
}

/// The shortest stretch of the stride that holds four phases (any real numbers): 0 when they are one moment, 0.75 at most.
pub fn cyclic_spread(phases: [f64; 4]) -> f64 {
    let mut sorted = phases.map(|phase| phase.rem_euclid(1.0));
    sorted.sort_by(f64::total_cmp);
    let gap = |i: usize| if i < 3 { sorted[i + 1] - sorted[i] } else { sorted[0] + 1.0 - sorted[3] };
    1.0 - (0..4).map(gap).fold(0.0, f64::max)
}

/// A change worked out.
#[derive(Clone, Debug, PartialEq)]
pub struct Warping {
    /// Frames 0 to `B`; the first is the original motion, the last the target.
    pub frames: Vec<WarpedFrame>,
    /// Generic time each leg goes through, `sigma^j`.
    pub sigmas: [f64; 4],
    /// That of the reference leg, `sigma*` (Eq. 3.14).
    pub reference_sigma: f64,
    /// Whole strides each leg adds to the end posture's generic time (`x'` of Eq. 3.15); in the synchronous warping there is no end
    /// posture and none is added.
    pub whole_strides: [f64; 4],
}

/// A change from one motion to another that begins at an actual time.
#[derive(Clone, Copy, Debug)]
pub struct GaitChange<'a> {
    /// `M_1`.
    pub from: &'a WarpedMotion,
    /// `M_2`.
    pub to: &'a WarpedMotion,
    /// `T_1`, frames into the original stride when the change begins.
    pub start_frame: f64,
    /// The leg that the others follow.
    pub reference: Limb,
}

impl GaitChange<'_> {
    /// Average increments of generic time per frame in both motions (Eq. 3.9, 3.10).
    fn increments(&self) -> [f64; 2] {
        [self.from, self.to].map(|motion| motion.frames_per_stride.recip())
    }

    /// `B`, frames the change takes (Eq. 3.13, from Eq. 3.12: two and a half strides), at least one.
    pub fn frame_count(&self) -> usize {
        let [first, second] = self.increments();
        (((5.0 + first - second) / (first + second)).round() as usize).max(1)
    }

    /// `w_2(i)`.
    fn target_weight(&self, i: usize) -> f64 {
        i as f64 / self.frame_count() as f64
    }

    /// What the reference leg gains in frame `i`, 1 to `B` (Eq. 3.11).
    fn reference_increment(&self, i: usize) -> f64 {
        let ([first, second], weight) = (self.increments(), self.target_weight(i));
        (1.0 - weight) * first + weight * second
    }

    /// `sigma*` (Eq. 3.14).
    fn reference_sigma(&self) -> f64 {
        (1..=self.frame_count()).map(|i| self.reference_increment(i)).sum()
    }

    /// Generic times of the legs when the change begins, in `[0, 1)`.
    fn start_times(&self) -> [f64; 4] {
        Limb::ALL.map(|limb| self.from.generic_time(limb, self.start_frame).rem_euclid(1.0))
    }

    /// Every leg gains what the reference leg gains: the four actual times of Eq. 3.8 go their own ways.
    pub fn synchronous(&self) -> Warping {
        self.warping([self.reference_sigma(); 4], [0.0; 4])
    }

    /// Every leg gains its own share, so that all arrive at one posture of the target (Eq. 3.15 to 3.17, 3.19, 3.20).
    pub fn asynchronous(&self) -> Warping {
        let (starts, sigma) = (self.start_times(), self.reference_sigma());
        let end_frame = self.to.actual_frame(self.reference, starts[self.reference.index()] + sigma);
        let ends = Limb::ALL.map(|limb| self.to.generic_time(limb, end_frame).rem_euclid(1.0));
        let strides: [f64; 4] = std::array::from_fn(|j| (sigma - (ends[j] - starts[j])).round());
        let sigmas = std::array::from_fn(|j| {
            if j == self.reference.index() { sigma } else { ends[j] + strides[j] - starts[j] }
        });
        self.warping(sigmas, strides)
    }

    fn warping(&self, sigmas: [f64; 4], whole_strides: [f64; 4]) -> Warping {
        let reference_sigma = self.reference_sigma();
        let mut generic_times = self.start_times();
        let mut frames = vec![self.frame(0, generic_times)];
        for i in 1..=self.frame_count() {
            for (time, sigma) in generic_times.iter_mut().zip(sigmas) {
                *time += self.reference_increment(i) * sigma / reference_sigma;
            }
            frames.push(self.frame(i, generic_times));
        }
        Warping { frames, sigmas, reference_sigma, whole_strides }
    }

    fn frame(&self, i: usize, generic_times: [f64; 4]) -> WarpedFrame {
        let target_weight = self.target_weight(i);
        let in_motion = |motion: &WarpedMotion| {
            Limb::ALL.map(|limb| motion.actual_frame(limb, generic_times[limb.index()]))
        };
        let [first, second] = [self.from, self.to].map(in_motion);
        WarpedFrame {
            target_weight,
            generic_times,
            actual_frames: std::array::from_fn(|j| {
                (1.0 - target_weight) * first[j] + target_weight * second[j]
            }),
            target_phases: second.map(|frame| (frame / self.to.frames_per_stride).rem_euclid(1.0)),
        }
    }
}

#[cfg(test)]
mod tests;
