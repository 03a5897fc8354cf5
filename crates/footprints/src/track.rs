//! A track: footprints with their times, as a file that people and programs write.

use std::io;

use muybridge_core::{Gait, Lead};
use serde::{Deserialize, Serialize};
use serde_json::ser::Formatter;

use crate::lay::Laying;
use crate::problem::Weights;
use crate::terrain::Terrain;
use crate::timing::StepTiming;

/// Schema version of a track file.
pub const TRACK_SCHEMA: u32 = 1;

/// A foot of a two-legged or of a four-legged figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Foot {
    /// The left of two.
    #[serde(rename = "L")]
    Left,
    /// The right of two.
    #[serde(rename = "R")]
    Right,
    /// Left fore.
    #[serde(rename = "LF")]
    LeftFore,
    /// Right fore.
    #[serde(rename = "RF")]
    RightFore,
    /// Left hind.
    #[serde(rename = "LH")]
    LeftHind,
    /// Right hind.
    #[serde(rename = "RH")]
    RightHind,
}

impl Foot {
    /// The two feet of a biped.
    pub const BIPED: [Self; 2] = [Self::Left, Self::Right];
    /// The four feet of a quadruped, in the order of [`muybridge_core::Limb::ALL`].
    pub const QUADRUPED: [Self; 4] = [Self::LeftFore, Self::RightFore, Self::LeftHind, Self::RightHind];

    /// Its place among the feet of its figure.
    pub fn index(self) -> usize {
        match self {
            Self::Left | Self::LeftFore => 0,
            Self::Right | Self::RightFore => 1,
            Self::LeftHind => 2,
            Self::RightHind => 3,
        }
    }

    /// Whether it is one of two.
    pub fn is_biped(self) -> bool {
        matches!(self, Self::Left | Self::Right)
    }

    /// Short name: L, R, LF, RF, LH, RH.
    pub fn abbreviation(self) -> &'static str {
        match self {
            Self::Left => "L",
            Self::Right => "R",
            Self::LeftFore => "LF",
            Self::RightFore => "RF",
            Self::LeftHind => "LH",
            Self::RightHind => "RH",
        }
    }
}

/// One footprint.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Print {
    /// Which foot.
    pub foot: Foot,
    /// Middle of the print in the plan: x and z, metres. Height and slope are the terrain's.
    pub at_m: [f64; 2],
    /// Where the toes point: degrees to the left of X.
    pub heading_deg: f64,
    /// Its times; absent: automatic, from the distances ([`crate::TimingRule`]).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub timing: Option<StepTiming>,
}

/// The gait of a four-legged figure, from which its legs' ways and its timing are taken.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrackGait {
    /// Gait.
    pub gait: Gait,
    /// Speed, m/s.
    pub speed_m_s: f64,
    /// Lead; only in canter and gallop.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lead: Option<Lead>,
}

/// A track file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Track {
    /// Schema version: [`TRACK_SCHEMA`].
    pub schema: u32,
    /// Name for people.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// What it shows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub about: Option<String>,
    /// Who walks: `bird`, `dinosaur`, `human`, `horse`.
    pub model: String,
    /// The ground.
    #[serde(default)]
    pub terrain: Terrain,
    /// Weights of the energy.
    #[serde(default)]
    pub weights: Weights,
    /// Gait of a four-legged figure.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gait: Option<TrackGait>,
    /// A path along which prints are laid while there are none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub path: Option<Laying>,
    /// The prints in the order of their footfalls.
    #[serde(default)]
    pub prints: Vec<Print>,
}

/// What is wrong with a track.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TrackError {
    /// The text is no track.
    #[error("{at}: {cause}")]
    Text {
        /// Field or line.
        at: String,
        /// What the reader says.
        cause: String,
    },
    /// The prints cannot be walked; each line says which and what to do.
    #[error("{}", .0.join("\n"))]
    Faults(Vec<String>),
}

impl Track {
    /// A track without prints.
    pub fn new(model: &str) -> Self {
        Self {
            schema: TRACK_SCHEMA,
            name: None,
            about: None,
            model: model.into(),
            terrain: Terrain::default(),
            weights: Weights::default(),
            gait: None,
            path: None,
            prints: Vec::new(),
        }
    }

    /// Reads a track. Its numbers are checked where it is placed ([`Track::place`]), so that a broken track can be mended.
    ///
    /// # Errors
    /// When the text is no track, or of another schema: with the line and the column.
    pub fn from_json(text: &str) -> Result<Self, TrackError> {
        let fault = |at: &str, cause: String| TrackError::Text { at: at.into(), cause };
        let Schema { schema } = serde_json::from_str(text).map_err(|error| text_error(&error))?;
        let Some(schema) = schema else {
            return Err(fault("schema", format!("missing; this program reads schema {TRACK_SCHEMA}")));
        };
        if schema != u64::from(TRACK_SCHEMA) {
            return Err(fault("schema", format!("{schema}, but this program reads schema {TRACK_SCHEMA}")));
        }
        serde_json::from_str(text).map_err(|error| text_error(&error))
    }

    /// The track as a file: every field and every print on a line of its own, so that differences are readable.
    pub fn to_json(&self) -> String {
        let mut text = Vec::new();
        let mut serializer = serde_json::Serializer::with_formatter(&mut text, Lines::default());
        // Writing to memory does not fail, and the text is UTF-8. A number that is none becomes null, which the
        // reader names.
        let written = self.serialize(&mut serializer);
        text.push(b'\n');
        written.ok().and_then(|()| String::from_utf8(text).ok()).unwrap_or_default()
    }
}

/// What tells the schema, whatever else there is.
#[derive(Deserialize)]
struct Schema {
    schema: Option<u64>,
}

fn text_error(error: &serde_json::Error) -> TrackError {
    let at = format!("line {} column {}", error.line(), error.column());
    let cause = error.to_string();
    let cause = cause.strip_suffix(&format!(" at {at}")).unwrap_or(&cause).to_owned();
    TrackError::Text { at, cause }
}

/// Writes the fields of the whole and the elements of a list among them on lines of their own, all else in a line with spaces.
#[derive(Default)]
struct Lines {
    depth: usize,
    /// Whether the innermost list or object has something in it.
    filled: bool,
}

impl Lines {
    fn begin<W: ?Sized + io::Write>(&mut self, writer: &mut W, bracket: &[u8]) -> io::Result<()> {
        self.depth += 1;
        self.filled = false;
        writer.write_all(bracket)
    }

    fn next<W: ?Sized + io::Write>(&mut self, writer: &mut W, first: bool, space: &str) -> io::Result<()> {
        let comma = if first { "" } else { "," };
        match self.depth {
            1 => write!(writer, "{comma}\n  "),
            2 if space.is_empty() => write!(writer, "{comma}\n    "),
            _ if first => writer.write_all(space.as_bytes()),
            _ => writer.write_all(b", "),
        }
    }

    fn end<W: ?Sized + io::Write>(&mut self, writer: &mut W, bracket: &str, space: &str) -> io::Result<()> {
        self.depth -= 1;
        let filled = std::mem::replace(&mut self.filled, true);
        match self.depth {
            _ if !filled => {}
            0 => writeln!(writer)?,
            1 if space.is_empty() => write!(writer, "\n  ")?,
            _ => writer.write_all(space.as_bytes())?,
        }
        writer.write_all(bracket.as_bytes())
    }
}

impl Formatter for Lines {
    fn begin_array<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.begin(writer, b"[")
    }

    fn begin_array_value<W: ?Sized + io::Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        self.next(writer, first, "")
    }

    fn end_array_value<W: ?Sized + io::Write>(&mut self, _writer: &mut W) -> io::Result<()> {
        self.filled = true;
        Ok(())
    }

    fn end_array<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.end(writer, "]", "")
    }

    fn begin_object<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.begin(writer, b"{")
    }

    fn begin_object_key<W: ?Sized + io::Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        self.next(writer, first, " ")
    }

    fn begin_object_value<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        writer.write_all(b": ")
    }

    fn end_object_value<W: ?Sized + io::Write>(&mut self, _writer: &mut W) -> io::Result<()> {
        self.filled = true;
        Ok(())
    }

    fn end_object<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.end(writer, "}", " ")
    }
}

#[cfg(test)]
mod tests;
