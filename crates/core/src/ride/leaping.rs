//! The leap under way (spec 6.5): the horse changes to the gait that the leap's beginning is nearest to, comes to the speed that the
//! wanted length asks for, gathers, pushes off, flies as a thrown body, lands, and goes on.

use serde::{Deserialize, Serialize};

use super::command::Leap;
use super::leap_clip::LeapClip;
use super::repertoire::{Repertoire, Way};
use super::retarget::smooth;
use super::warp::Warp;
use crate::gait::Gait;

/// Least and greatest rise of the trunk, metres of a reference horse: a ditch, and a puissance wall's share of the body.
const HEIGHT_M: [f32; 2] = [0.05, 1.2];
/// Least and greatest speed in flight, m/s of a reference horse.
const SPEED_M_S: [f32; 2] = [2.0, 14.0];
/// Strides of the change from the approach to the leap, at least.
const GATHERING_STRIDES: f32 = 0.75;
/// Strides of the change from the landing to the gait that follows.
const GOING_ON_STRIDES: f32 = 2.5;
/// The gait that follows comes when so much of the landing, from the first forefoot to the hind feet, is done.
const LANDED: f32 = 0.8;
/// The leap's postures come and go within so many strides: its stride has a flight, and only what is on the ground before and
/// after it is to be mixed with a gait.
const MIXED_STRIDES: f32 = 0.35;
/// Share of the flight from which the body makes ready to land.
const HEEDED_FROM: f32 = 0.5;
/// The approach is at its speed when it is as near as this, m/s.
const AT_SPEED_M_S: f32 = 0.25;

/// Where a leap is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Stage {
    /// There is none.
    #[default]
    None,
    /// Coming to the gait and speed to leap from.
    Approach,
    /// Changing to the leap, until the hind feet strike.
    Gathering,
    /// Pushing off, flying.
    Leaping,
    /// The forefeet are down; the next gait comes.
    Landing,
}

/// The leap under way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Leaping {
    pub(super) stage: Stage,
    height_m: f32,
    /// Speed in flight, m/s.
    pub(super) speed_m_s: f32,
    flight_s: f32,
    flown_s: f32,
    was_asked: bool,
}

impl Leaping {
    /// Takes a wish for a leap, once.
    pub(super) fn ask(&mut self, leap: Option<Leap>, size: f32) {
        let is_new = leap.is_some() && !self.was_asked;
        self.was_asked = leap.is_some();
        let Some(leap) = leap.filter(|_| is_new && self.stage == Stage::None) else { return };
        let number = |value: f32, least: f32| if value.is_nan() { least } else { value };
        let [low, high] = HEIGHT_M.map(|height| height * size);
        self.height_m = number(leap.height_m, low).clamp(low, high);
        self.flight_s = LeapClip::flight_of_height_s(self.height_m);
        let [slow, fast] = SPEED_M_S.map(|speed| speed * size.sqrt());
        self.speed_m_s = (number(leap.length_m, 0.0) / self.flight_s).clamp(slow, fast);
        (self.stage, self.flown_s) = (Stage::Approach, 0.0);
    }

    /// The gait and the speed (m/s) to approach in; none when nothing is to be leapt.
    pub(super) fn approach(&self, repertoire: &Repertoire, now: Gait) -> Option<(Gait, f32)> {
        (self.stage == Stage::Approach).then_some((self.gait_about(repertoire, now), self.speed_m_s))
    }

    /// The gait to leap from and to land into: the one it is in where that has a lead and the leap's speed, the one whose postures
    /// are nearest otherwise, or the gallop where that one is too slow.
    fn gait_about(&self, repertoire: &Repertoire, now: Gait) -> Gait {
        let fits = |gait: Gait| {
            let [slow, fast] = repertoire.playable_m_s(gait);
            (slow..=fast).contains(&self.speed_m_s)
        };
        if matches!(now, Gait::Canter | Gait::Gallop) && fits(now) {
            return now;
        }
        let nearest = repertoire.leap.approach;
        if self.speed_m_s > repertoire.playable_m_s(nearest)[1] { Gait::Gallop } else { nearest }
    }

    /// Whether gait and speed are the leap's own business now.
    pub(super) fn is_under_way(&self) -> bool {
        matches!(self.stage, Stage::Gathering | Stage::Leaping | Stage::Landing)
    }

    /// Whether the feet go by the leap's own time.
    pub(super) fn leads_feet(&self) -> bool {
        matches!(self.stage, Stage::Gathering | Stage::Leaping)
    }

    /// Goes from stage to stage. `wished_m_s` is the speed the gaits are played at: the leap hands its own on when it lands.
    pub(super) fn advance(&mut self, repertoire: &Repertoire, warp: &mut Warp, wished_m_s: &mut f32) {
        let leap = &repertoire.leap;
        match self.stage {
            Stage::None => {}
            Stage::Approach => {
                let gait = self.gait_about(repertoire, warp.to.gait);
                let [slow, fast] = repertoire.playable_m_s(gait);
                let is_there = (*wished_m_s - self.speed_m_s.clamp(slow, fast)).abs() < AT_SPEED_M_S;
                if is_there && warp.is_steady() && warp.to.gait == gait {
                    let way = Way { gait: Gait::Leap, is_mirrored: warp.to.is_mirrored };
                    warp.begin_to_phase(repertoire, way, [GATHERING_STRIDES, MIXED_STRIDES], 0.0);
                    self.stage = Stage::Gathering;
                }
            }
            Stage::Gathering => {
                if warp.is_steady() {
                    self.stage = Stage::Leaping;
                }
            }
            Stage::Leaping => {
                if self.flown_s >= self.flight_s
                    && warp.phase() >= leap.landing + LANDED * (1.0 - leap.landing)
                {
                    self.stage = Stage::Landing;
                    let gait = self.gait_about(repertoire, Gait::Leap);
                    let next = match repertoire.lead(Way::of(gait)) {
                        Some(_) => Way { gait, is_mirrored: warp.to.is_mirrored },
                        None => Way::of(gait),
                    };
                    *wished_m_s = self.speed_m_s;
                    warp.begin_at_once(repertoire, next, GOING_ON_STRIDES, MIXED_STRIDES);
                }
            }
            Stage::Landing => {
                if warp.is_steady() {
                    self.stage = Stage::None;
                }
            }
        }
    }

    fn is_flying(&self, leap: &LeapClip, phase: f32) -> bool {
        self.stage == Stage::Leaping && phase >= leap.take_off && self.flown_s < self.flight_s
    }

    /// Whether the horse flies.
    pub(super) fn flies(&self, repertoire: &Repertoire, warp: &Warp) -> bool {
        self.is_flying(&repertoire.leap, warp.phase())
    }

    /// Time gone of the flight, s; what is gone of it when it began between two steps as well.
    fn flown_s(&self, leap: &LeapClip, phase: f32, rate_hz: f32) -> f32 {
        if self.flown_s > 0.0 { self.flown_s } else { (phase - leap.take_off).max(0.0) / rate_hz }
    }

    /// Phase of the flight at a share of its time: it leaves and arrives at the rate the feet have on the ground.
    fn flight_phase(&self, leap: &LeapClip, share: f32, rate_hz: f32) -> f32 {
        let span = leap.landing - leap.take_off;
        let slope = (rate_hz * self.flight_s).min(3.0 * span);
        let (t, u) = (share, 1.0 - share);
        leap.take_off + span * t * t * (3.0 - 2.0 * t) + slope * (t * u * u - t * t * u)
    }

    /// The clock's rate with the flight taken to its own time, strides per second.
    pub(super) fn rate_hz(&mut self, repertoire: &Repertoire, warp: &Warp, rate_hz: f32, dt_s: f32) -> f32 {
        let (leap, phase) = (&repertoire.leap, warp.phase());
        if !self.is_flying(leap, phase) {
            return rate_hz;
        }
        self.flown_s = self.flown_s(leap, phase, rate_hz) + dt_s;
        let share = (self.flown_s / self.flight_s).min(1.0);
        let landing = if share >= 1.0 { 1e-4 } else { 0.0 };
        (self.flight_phase(leap, share, rate_hz) + landing - phase).max(0.0) / dt_s
    }

    /// Time to a number of strides from now, s, over the flight if it lies between.
    pub(super) fn time_s(&self, repertoire: &Repertoire, warp: &Warp, strides: f32, rate_hz: f32) -> f32 {
        let (leap, phase) = (&repertoire.leap, warp.phase());
        let to = phase + strides;
        let is_ahead =
            self.stage == Stage::Leaping && self.flown_s < self.flight_s && to > leap.landing - 1e-3;
        if !is_ahead {
            return strides / rate_hz;
        }
        let before = (leap.take_off - phase).max(0.0) / rate_hz;
        before + self.flight_s - self.flown_s + (to - leap.landing) / rate_hz
    }

    /// How much the body heeds the strikes to come, 0 to 1: not before the flight comes to its end.
    pub(super) fn heeds(&self) -> f32 {
        if self.stage == Stage::Leaping {
            smooth((self.flown_s / self.flight_s - HEEDED_FROM) / (1.0 - HEEDED_FROM))
        } else {
            1.0
        }
    }

    /// How much higher the body is than it will be at the landing, metres; zero but in flight.
    pub(super) fn falls_m(&self, repertoire: &Repertoire, warp: &Warp) -> f32 {
        let leap = &repertoire.leap;
        if !self.is_flying(leap, warp.phase()) {
            return 0.0;
        }
        let share = self.flown_s / self.flight_s;
        let [from_m, to_m] = leap.heights_m;
        (from_m - to_m) * (1.0 - share) + 4.0 * self.height_m * share * (1.0 - share)
    }

    /// What the leap adds to the height its stride has, metres: the flight's own arc, and the crouch before and after it in which
    /// the body gains and loses the speed it flies up and down with.
    pub(super) fn added_m(&self, repertoire: &Repertoire, warp: &Warp, rate_hz: f32) -> f32 {
        let (leap, phase) = (&repertoire.leap, warp.phase());
        let [from_m, to_m] = leap.heights_m;
        let climb = to_m - from_m;
        let arc = |height_m: f32, time_s: f32, sign: f32| (sign * 4.0 * height_m + climb) / time_s;
        let stored_rise_m = super::retarget::GRAVITY_M_S2 * leap.flight_s * leap.flight_s / 8.0;
        let faster = |sign: f32| {
            let stored = arc(stored_rise_m, leap.flight_s, sign) * rate_hz * leap.clip.stride_time_s;
            arc(self.height_m, self.flight_s, sign) - stored
        };
        match self.stage {
            Stage::Leaping if self.is_flying(leap, phase) => {
                let (share, stored) = (
                    self.flown_s(leap, phase, rate_hz) / self.flight_s,
                    (phase - leap.take_off) / (leap.landing - leap.take_off),
                );
                let height = |rise_m: f32, t: f32| climb * t + 4.0 * rise_m * t * (1.0 - t);
                height(self.height_m, share) - height(stored_rise_m, stored)
            }
            Stage::Leaping if phase < leap.take_off => {
                let t = phase / leap.take_off;
                -faster(1.0) * leap.take_off / rate_hz * t * t * (1.0 - t)
            }
            Stage::Leaping | Stage::Landing if phase >= leap.landing => {
                let (span, t) = (1.0 - leap.landing, (phase - leap.landing) / (1.0 - leap.landing));
                let weight = warp.weights.iter().skip(2 * Gait::Leap as usize).sum::<f32>();
                weight * faster(-1.0) * span / rate_hz * t * (1.0 - t) * (1.0 - t)
            }
            _ => 0.0,
        }
    }
}
