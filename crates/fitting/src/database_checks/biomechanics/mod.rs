//! What real horses do, as published: times and lengths, footfalls, posture, forces, and how they change with speed.

mod footfalls;
mod forces;
mod posture;
mod published;
mod trends;

use super::{Deviation, Subject};

pub(super) use trends::check as check_trends;

pub(super) fn check(subject: &Subject<'_>) -> Vec<Deviation> {
    let mut deviations = published::check(subject);
    deviations.extend(footfalls::check(subject));
    deviations.extend(posture::check(subject));
    deviations.extend(forces::check(subject));
    deviations
}
