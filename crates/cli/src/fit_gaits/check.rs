//! Is a database what the annotations give?
//!
//! Same program and same machine give the same bytes. Another processor may round the last digit otherwise, so numbers
//! count as equal within two units of the last place kept.

use muybridge_core::{ContactLaw, Database, Stride};

/// Two steps of the packed curves.
const TOLERANCE: f32 = 2.1e-4;
/// Laws are kept to six digits.
const LAW_TOLERANCE: f64 = 2.1e-5;
/// Differences listed before the rest is only counted.
const LISTED: usize = 10;

/// What differs, in words; with `only`, of these plates' captured strides alone: laws, and with them the strides at other
/// speeds, rest on all plates of a gait.
pub(super) fn differences(committed: &Database, fresh: &Database, only: &[String]) -> Vec<String> {
    let mut found = Vec::new();
    if only.is_empty() {
        let committed_ids: Vec<_> = committed.laws.iter().map(law_name).collect();
        let fresh_ids: Vec<_> = fresh.laws.iter().map(law_name).collect();
        if committed_ids != fresh_ids {
            found.push(format!("laws: file has {committed_ids:?}, annotations give {fresh_ids:?}"));
        }
        let pairs = committed.laws.iter().zip(&fresh.laws);
        found.extend(
            pairs.filter(|(a, b)| !same_law(a, b)).map(|(a, _)| format!("law {} differs", law_name(a))),
        );
    }
    let wanted = |stride: &&Stride| only.is_empty() || only.contains(&stride.id);
    for stride in fresh.strides.iter().filter(wanted) {
        match committed.strides.iter().find(|s| s.id == stride.id) {
            None => found.push(format!("stride {} is missing from the file", stride.id)),
            Some(old) => found.extend(stride_difference(old, stride)),
        }
    }
    for old in committed.strides.iter().filter(wanted) {
        if !fresh.strides.iter().any(|s| s.id == old.id) {
            found.push(format!("stride {} is in the file, but in no annotation", old.id));
        }
    }
    if found.len() > LISTED {
        let more = found.len() - LISTED;
        found.truncate(LISTED);
        found.push(format!("... and {more} more"));
    }
    found
}

fn law_name(law: &ContactLaw) -> String {
    format!("{} {}", law.gait, law.law.name())
}

fn same_law(a: &ContactLaw, b: &ContactLaw) -> bool {
    let close = |x: f64, y: f64| (x - y).abs() <= LAW_TOLERANCE * x.abs().max(y.abs());
    let intervals = match (&a.interval, &b.interval) {
        (Some(a), Some(b)) => a.a.iter().chain(&a.b).zip(b.a.iter().chain(&b.b)).all(|(x, y)| close(*x, *y)),
        (None, None) => true,
        _ => false,
    };
    close(a.curve.a, b.curve.a)
        && close(a.curve.b, b.curve.b)
        && a.n == b.n
        && a.provenance == b.provenance
        && intervals
}

fn stride_difference(old: &Stride, new: &Stride) -> Option<String> {
    if old.provenance != new.provenance || old.gait != new.gait || old.lead != new.lead {
        return Some(format!("stride {}: gait, lead or provenance differ", new.id));
    }
    let numbers = |s: &Stride| -> Vec<f32> {
        let contacts = s.contacts.iter().flat_map(|c| [c.strike_phase, c.lift_off_phase]);
        let curves = s.curves.channels().flatten().copied();
        let rest = [s.speed_m_s, s.stride_time_s, s.withers_height_m].into_iter().chain(s.prints_m);
        contacts.chain(curves).chain(rest).chain(s.bone_lengths_m.iter().copied()).collect()
    };
    let (old_numbers, new_numbers) = (numbers(old), numbers(new));
    let worst = old_numbers.iter().zip(&new_numbers).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    let same = old_numbers.len() == new_numbers.len() && worst <= TOLERANCE;
    (!same).then(|| format!("stride {}: numbers differ by up to {worst}", new.id))
}
