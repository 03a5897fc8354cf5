//! Single things a horse does, one at a time: which of them breaks which limit, on which build.

use std::fmt::{Display, Formatter, Result as FormatResult};
use std::sync::Arc;

use muybridge_core::{Command, Gait, Horse, Leap, MPS_PER_MPH, Repertoire, Turn};

use super::changes::{GAITS, usual_mph};
use super::findings::{Findings, Limits, Quantity};
use super::inspector::Inspector;
use super::terrain::Terrain;

/// Steps, s.
const STEP_S: f32 = 1.0 / 120.0;
/// Time before the thing is done, s; nothing is looked at in the first half.
const BEFORE_S: f64 = 6.0;
/// Time in which it is done and looked at, s.
const LOOKED_AT_S: f64 = 12.0;

/// A situation.
#[derive(Clone, Debug)]
pub struct Situation {
    /// In plain words.
    pub name: String,
    /// What is asked for first.
    pub before: Command,
    /// What is asked for then.
    pub then: Command,
    /// The ground.
    pub terrain: Terrain,
}

fn going(gait: Gait) -> Command {
    Command { gait: Some(gait), speed_m_s: (usual_mph(gait) * MPS_PER_MPH) as f32, ..Command::default() }
}

/// Every situation: straight on, turning, halting, leaping, faster and slower, and on every ground, in each gait.
pub fn all() -> Vec<Situation> {
    GAITS.into_iter().flat_map(of_gait).collect()
}

fn of_gait(gait: Gait) -> Vec<Situation> {
    let before = going(gait);
    let with = |what: &str, then: Command, terrain| Situation {
        name: format!("{gait}: {what}"),
        before,
        then,
        terrain,
    };
    let turned = |turn| Command { turn, ..before };
    let at = |mph: f64| Command { speed_m_s: (mph * MPS_PER_MPH) as f32, ..before };
    let [slow, fast] = gait.speed_range_mph().unwrap_or_default();
    let over = |height_m, length_m| Command { leap: Some(Leap { height_m, length_m }), ..before };
    let slope = |deg: f32, along: f32, across: f32| {
        let rise = deg.to_radians().tan();
        Terrain::Slope([rise * along, rise * across])
    };
    vec![
        with("straight on", before, Terrain::Flat),
        with("slowest", at(slow), Terrain::Flat),
        with("fastest", at(fast), Terrain::Flat),
        with("turns left gently", turned(Turn::Rate(0.2)), Terrain::Flat),
        with("turns right sharply", turned(Turn::Rate(-2.0)), Terrain::Flat),
        with("turns by 90 degrees", turned(Turn::Steps(6)), Terrain::Flat),
        with("halts", Command { speed_m_s: 0.0, gait: None, ..before }, Terrain::Flat),
        with("halts and turns", Command { speed_m_s: 0.0, turn: Turn::Steps(-6), ..before }, Terrain::Flat),
        with("leaps low", over(0.3, 2.0), Terrain::Flat),
        with("leaps high", over(1.0, 4.0), Terrain::Flat),
        with("up 20 degrees", before, slope(20.0, 1.0, 0.0)),
        with("down 20 degrees", before, slope(20.0, -1.0, 0.0)),
        with("across 20 degrees", before, slope(20.0, 0.0, 1.0)),
        with("steps of 0.2 m", before, Terrain::Steps(2.5)),
        with("hills", before, Terrain::Hills([1.0, 30.0])),
    ]
}

impl Situation {
    /// Rides it.
    pub fn ride(&self, repertoire: &Arc<Repertoire>) -> Findings {
        let mut horse = Horse::of(Arc::clone(repertoire), 3);
        horse.place(horse.readout().prints[0] * 0.0, 0.0, &self.terrain);
        let mut inspector = Inspector::new(repertoire.skeleton());
        let steps = |seconds: f64| (seconds / f64::from(STEP_S)) as usize;
        for step in 0..steps(BEFORE_S + LOOKED_AT_S) {
            let command = if step < steps(BEFORE_S) { &self.before } else { &self.then };
            horse.step(command, STEP_S, &self.terrain);
            if step >= steps(BEFORE_S) {
                inspector.look(&horse, STEP_S, &self.terrain);
            }
        }
        *inspector.findings()
    }

    /// The limits of what is done on its ground.
    pub fn limits(&self) -> Limits {
        match (self.terrain, self.then.leap) {
            (Terrain::Flat, None) => Limits::smooth(),
            (Terrain::Flat, Some(_)) => Limits::flat(),
            _ => Limits::terrain(),
        }
    }
}

/// Situations by builds, with what they break.
#[derive(Clone, Debug, Default)]
pub struct SituationTable {
    /// Situation, build and what was found.
    pub rows: Vec<(Situation, String, Findings)>,
}

impl SituationTable {
    /// Rides every situation on every build.
    pub fn ride(repertoires: &[Arc<Repertoire>]) -> Self {
        let mut table = Self::default();
        for situation in all() {
            for repertoire in repertoires {
                let findings = situation.ride(repertoire);
                table.rows.push((situation.clone(), repertoire.skeleton().name.clone(), findings));
            }
        }
        table
    }

    /// Everything that is broken.
    pub fn faults(&self) -> Vec<String> {
        let told = |(situation, build, findings): &(Situation, String, Findings)| {
            let broken = findings.broken(&situation.limits());
            let lines = broken.into_iter().map(|b| format!("{}, {build}: {b}", situation.name));
            lines.collect::<Vec<_>>()
        };
        self.rows.iter().flat_map(told).collect()
    }
}

impl Display for SituationTable {
    fn fmt(&self, f: &mut Formatter<'_>) -> FormatResult {
        let shown = [
            Quantity::StanceSlide,
            Quantity::Float,
            Quantity::ToeSpeed,
            Quantity::RootJump,
            Quantity::BendSpeed,
            Quantity::UnderGround,
            Quantity::BrokenStance,
            Quantity::Lowered,
        ];
        writeln!(
            f,
            "{:<28} {:<34} slide mm  float mm  toe m/s  jump mm  bend rad/s  under mm  broken %  lowered mm",
            "situation", "build"
        )?;
        for (situation, build, findings) in &self.rows {
            write!(f, "{:<28} {build:<34}", situation.name)?;
            for (quantity, width) in shown.into_iter().zip([8, 9, 8, 8, 11, 9, 9, 11]) {
                let value = findings.worst(quantity).value;
                let mark = if value > situation.limits().of(quantity) { '*' } else { ' ' };
                let digits = if matches!(quantity, Quantity::StanceSlide | Quantity::Float) { 3 } else { 0 };
                write!(f, "{:width$.digits$}{mark}", value * quantity.per_unit())?;
            }
            writeln!(f)?;
        }
        Ok(())
    }
}
