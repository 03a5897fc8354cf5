//! The motion database: every stride and law the toolchain made, in one versioned file that is compiled in.

use serde::{Deserialize, Serialize};

use crate::gait::Gait;
use crate::law::{ContactLaw, LawKind};
use crate::stride::Stride;

/// Schema version of a database file.
///
/// 2: curves are packed (see [`crate::CURVE_STEP`]), and a law says where a borrowed exponent is from.
pub const DATABASE_SCHEMA: u32 = 2;

/// Why a data file could not be read.
#[derive(Debug)]
pub enum DataError {
    /// Not JSON of the expected form.
    Parse(serde_json::Error),
    /// Written for another version of this library.
    Schema {
        /// Version in the file.
        found: u32,
        /// Version this library reads.
        expected: u32,
    },
    /// Well formed, but its content contradicts itself.
    Invalid(String),
}

impl std::fmt::Display for DataError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Parse(error) => write!(f, "not a data file of this form: {error}"),
            Self::Schema { found, expected } => {
                write!(
                    f,
                    "schema {found}, but this version reads schema {expected}; regenerate it with `fit-gaits`"
                )
            }
            Self::Invalid(fault) => f.write_str(fault),
        }
    }
}

impl std::error::Error for DataError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Parse(error) => Some(error),
            Self::Schema { .. } | Self::Invalid(_) => None,
        }
    }
}

/// Strides and contact-time laws.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Database {
    /// [`DATABASE_SCHEMA`].
    pub schema: u32,
    /// Command that wrote the file.
    pub generator: String,
    /// Contact-time laws, ordered by gait, then kind.
    pub laws: Vec<ContactLaw>,
    /// Strides, ordered by gait, then speed.
    pub strides: Vec<Stride>,
}

impl Database {
    /// The database compiled into this crate, made by `fit-gaits` from the repository's annotations.
    pub fn embedded() -> Self {
        Self::from_json(include_str!("../data/motion.json"))
            .unwrap_or_else(|error| unreachable!("the compiled-in database is tested: {error}"))
    }

    /// Reads a database file.
    ///
    /// # Errors
    /// When the text is no JSON of this form, has another schema, or a stride's curves have the wrong shape.
    pub fn from_json(text: &str) -> Result<Self, DataError> {
        #[derive(Deserialize)]
        struct Head {
            schema: u32,
        }
        let head: Head = serde_json::from_str(text).map_err(DataError::Parse)?;
        if head.schema != DATABASE_SCHEMA {
            return Err(DataError::Schema { found: head.schema, expected: DATABASE_SCHEMA });
        }
        let database: Self = serde_json::from_str(text).map_err(DataError::Parse)?;
        match database.strides.iter().find_map(Stride::fault) {
            Some(fault) => Err(DataError::Invalid(fault)),
            None => Ok(database),
        }
    }

    /// Strides of a gait, slowest first.
    pub fn strides_of(&self, gait: Gait) -> impl Iterator<Item = &Stride> {
        self.strides.iter().filter(move |stride| stride.gait == gait)
    }

    /// The law of a gait for one of the contact times.
    pub fn law(&self, gait: Gait, kind: LawKind) -> Option<&ContactLaw> {
        self.laws.iter().find(|law| law.gait == gait && law.law == kind)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skeleton::Skeleton;

    #[test]
    fn embedded_database_plays_finite_poses() {
        let database = Database::embedded();
        let reference = Skeleton::reference();
        assert!(!database.strides.is_empty());
        for stride in &database.strides {
            let skeleton = stride.skeleton(&reference);
            for k in 0..200 {
                let joints = stride.pose(k as f32 / 100.0).joints(&skeleton);
                assert!(joints.tips.iter().all(|tip| tip.is_finite()), "{} at {k}", stride.id);
            }
        }
    }

    #[test]
    fn a_stride_advances_by_its_length() {
        for stride in Database::embedded().strides {
            let (here, there) = (stride.pose(0.3).root_in_world, stride.pose(1.3).root_in_world);
            assert!((there.x - here.x - stride.stride_length_m()).abs() < 1e-4);
        }
    }

    #[test]
    fn other_schemas_and_wrong_shapes_are_refused() {
        assert!(matches!(
            Database::from_json(r#"{"schema": 99}"#),
            Err(DataError::Schema { found: 99, expected: DATABASE_SCHEMA })
        ));
        let mut database = Database::embedded();
        database.strides[0].bone_lengths_m.pop();
        let text = serde_json::to_string(&database).unwrap();
        assert!(matches!(Database::from_json(&text), Err(DataError::Invalid(_))));
    }
}
