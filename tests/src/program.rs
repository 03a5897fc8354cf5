//! The programs, built once and run as a user runs them.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use crate::repository;

/// What a program left behind.
#[derive(Clone, Debug)]
pub struct Run {
    /// Exit code.
    pub code: i32,
    /// Standard output.
    pub stdout: String,
    /// Standard error.
    pub stderr: String,
}

impl Run {
    /// Runs a program to its end.
    pub fn of(command: &mut Command) -> Self {
        let output = command.output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        let code = output.status.code().unwrap_or_else(|| panic!("{command:?} was ended by a signal"));
        Self { code, stdout: text(output.stdout), stderr: text(output.stderr) }
    }

    /// Fails the test with everything the program said unless it ended with this code.
    #[track_caller]
    pub fn expect_code(self, code: i32) -> Self {
        assert!(
            self.code == code,
            "exit code {}, expected {code}\n{}\n{}",
            self.code,
            self.stdout,
            self.stderr
        );
        self
    }
}

/// Path of `fit-gaits` or `muybridge`, built once per test process in the running test's profile and target folder.
pub fn program(name: &str) -> PathBuf {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(build).join(format!("{name}{}", std::env::consts::EXE_SUFFIX))
}

/// Builds the programs; the folder they are in.
fn build() -> PathBuf {
    // `<target>/<profile>/deps/<test>`
    let test = std::env::current_exe().unwrap();
    let folder = test.ancestors().nth(2).unwrap();
    let profile = match folder.file_name().and_then(OsStr::to_str).unwrap() {
        "debug" => "dev",
        other => other,
    };
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| OsString::from("cargo"));
    let mut command = Command::new(cargo);
    // With the tests beside them, as `cargo test` has built everything: any other choice of packages has other features, and
    // would compile half the dependencies once more.
    let targets = ["--workspace", "--tests", "--bins"];
    command.args(["build", "--quiet"]).args(targets).args(["--profile", profile, "--target-dir"]);
    command.arg(folder.parent().map_or(Path::new("target"), |target| target)).current_dir(repository());
    Run::of(&mut command).expect_code(0);
    folder.to_path_buf()
}
