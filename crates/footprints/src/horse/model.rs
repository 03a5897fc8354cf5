//! A horse of one build, with everything it can do.

use std::sync::Arc;

use muybridge_core::{DataError, Database, Gait, LegReach, Repertoire, Skeleton};

/// A horse of one build: its skeleton, and the database's motion made ready for it. Making one takes some tens of milliseconds,
/// copying one nothing.
#[derive(Clone, Debug)]
pub struct HorseModel {
    repertoire: Arc<Repertoire>,
    reach: Arc<LegReach>,
}

impl HorseModel {
    /// Makes the motion of a database ready for a skeleton.
    ///
    /// # Errors
    /// Those of [`Repertoire::new`].
    pub fn new(database: &Database, skeleton: &Skeleton) -> Result<Self, DataError> {
        Ok(Self {
            repertoire: Arc::new(Repertoire::new(database, skeleton)?),
            reach: Arc::new(LegReach::new(skeleton)),
        })
    }

    /// The reference horse with the database that is compiled in.
    pub fn reference() -> Self {
        Self::new(&Database::embedded(), &Skeleton::reference())
            .unwrap_or_else(|error| unreachable!("compiled-in horse and database are tested: {error}"))
    }

    /// Its bones.
    pub fn skeleton(&self) -> &Skeleton {
        self.repertoire.skeleton()
    }

    /// Slowest and fastest speed of a gait, m/s.
    pub fn speed_range_m_s(&self, gait: Gait) -> [f32; 2] {
        self.repertoire.speed_range_m_s(gait)
    }

    pub(super) fn repertoire(&self) -> &Repertoire {
        &self.repertoire
    }

    pub(super) fn reach(&self) -> &LegReach {
        &self.reach
    }
}
