//! The contact-time table of Huang 2012 (Fig. 3.9), reproduced from its data points.

use muybridge_core::{ContactLaw, Gait, LawKind, MPS_PER_MPH, PowerLaw, Provenance};

use crate::law::{ContactPoint, fit_law, shift_law};

/// Where the table stands.
pub const SOURCE: &str = "Huang 2012, Horse Gait Synthesis Based on Muybridge's Photographs, Fig. 3.9";
/// Second speed of the amble rule, miles per hour (Fig. 3.10; the first is the captured clip's).
const AMBLE_SECOND_MPH: f64 = 9.0;

/// One line of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PublishedClip {
    /// Gait.
    pub gait: Gait,
    /// Speed, miles per hour.
    pub speed_mph: f64,
    /// Contact time, s.
    pub contact_time_s: f64,
    /// The parameters printed with the gait.
    pub printed: PowerLaw,
}

impl PublishedClip {
    /// The clip as a data point.
    pub fn point(&self) -> ContactPoint {
        ContactPoint { speed_m_s: self.speed_mph * MPS_PER_MPH, contact_time_s: self.contact_time_s }
    }
}

/// The table's lines.
pub fn clips() -> Vec<PublishedClip> {
    let lines = include_str!("../data/huang-2012.csv").lines().skip(1);
    lines
        .filter_map(|line| {
            let fields: Vec<&str> = line.split(',').collect();
            let number = |i: usize| fields.get(i)?.trim().parse::<f64>().ok();
            Some(PublishedClip {
                gait: Gait::from_name(fields.first()?)?,
                speed_mph: number(2)?,
                contact_time_s: number(3)?,
                printed: PowerLaw { a: number(4)?, b: number(5)? },
            })
        })
        .collect()
}

/// The six gaits' laws, fitted anew to the table's points. They are laws of *support*: a single limb's stance of 0.34 s at
/// 15 mph would sweep 2.3 m under a leg of 1.4 m.
pub fn laws() -> Vec<ContactLaw> {
    let clips = clips();
    let points_of = |gait: Gait| -> Vec<ContactPoint> {
        clips.iter().filter(|c| c.gait == gait).map(PublishedClip::point).collect()
    };
    let walk = fit_law(&points_of(Gait::Walk)).map(|fit| fit.curve);
    Gait::ALL
        .into_iter()
        .filter_map(|gait| {
            let points = points_of(gait);
            let (curve, source) = match points.as_slice() {
                [one] => {
                    let curve = shift_law(walk?, *one, AMBLE_SECOND_MPH * MPS_PER_MPH)?;
                    (curve, format!("{SOURCE}; one clip, by the amble rule of Fig. 3.10"))
                }
                _ => (fit_law(&points)?.curve, SOURCE.to_string()),
            };
            let provenance = Provenance::Published { source };
            Some(ContactLaw {
                gait,
                law: LawKind::Support,
                curve,
                n: points.len(),
                interval: None,
                borrowed: None,
                provenance,
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_parameters_are_reproduced() {
        let laws = laws();
        assert_eq!(laws.len(), 6);
        for clip in clips() {
            let law = laws.iter().find(|law| law.gait == clip.gait).unwrap();
            let (da, db) = (law.curve.a / clip.printed.a - 1.0, law.curve.b - clip.printed.b);
            let (limit_a, limit_b) = if clip.gait == Gait::Amble { (1e-3, 1e-3) } else { (1e-4, 5e-6) };
            assert!(da.abs() <= limit_a && db.abs() <= limit_b, "{}: a {da:.1e}, b {db:.1e}", clip.gait);
        }
    }
}
