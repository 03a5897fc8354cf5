//! The programs of the toolchain: arguments in, files and tables out; everything else is in the libraries.

pub mod commands;
pub mod fit_gaits;
pub mod ride_script;
pub mod specimens;

use std::process::ExitCode;

/// Something could not be done; the rest was.
pub const EXIT_FAILED: u8 = 1;
/// The program was called wrongly.
pub const EXIT_USAGE: u8 = 2;

/// Prints an error with its causes on one line and turns it into an exit code.
pub fn report_error(error: &anyhow::Error, code: u8) -> ExitCode {
    eprintln!("error: {error:#}");
    ExitCode::from(code)
}
