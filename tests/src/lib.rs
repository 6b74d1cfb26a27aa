//! What the cross-crate suites share. The suites themselves are in `tests/`, one idea a file.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "helpers of tests are tests, which clippy cannot see"
)]

pub mod fabrics;
pub mod window;

use render::Gpu;
use serde_json::Value;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// The meshes that ship with the program.
pub const ASSETS: [&str; 8] =
    ["swatch", "cowl", "poncho", "hat", "pullover", "slipover", "sweater", "t-shirt"];

/// A session that makes a cabled, ribbed and shaped panel of the swatch without labels: a script for `purlwise edit`, and
/// what a person does in the window.
pub const PANEL: &str = include_str!("panel.jsonl");

/// The root of the workspace.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap()
}

/// The file of a mesh that ships with the program.
pub fn asset(name: &str) -> String {
    root().join(format!("assets/meshes/{name}.obj")).display().to_string()
}

/// A folder for pictures to look at; not in the repository.
pub fn picture_folder() -> PathBuf {
    let folder = root().join("target/pictures");
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Says something past the test harness, which swallows what `eprintln` prints.
pub fn say(line: &str) {
    let line = format!("{line}\n");
    std::io::stderr().write_all(line.as_bytes()).unwrap();
}

/// Says that a test was skipped.
pub fn skip(why: &str) {
    say(&format!("skipped: {why}"));
}

/// The graphics adapter of this machine. Without one the tests that draw fail with a line that says what to install.
pub fn gpu() -> &'static Gpu {
    static GPU: OnceLock<Gpu> = OnceLock::new();
    GPU.get_or_init(|| Gpu::headless().unwrap_or_else(|error| panic!("{error}")))
}

/// The program with a folder of its own to run in.
pub struct Program {
    program: &'static str,
    folder: tempfile::TempDir,
    variables: Vec<(&'static str, &'static str)>,
}

/// What one run of the program came to.
#[derive(Debug)]
pub struct Run {
    /// Exit status.
    pub status: Option<i32>,
    /// Standard output.
    pub stdout: String,
    /// Standard error.
    pub stderr: String,
}

impl Program {
    /// The program at a path, which only the suites themselves know: `env!("CARGO_BIN_EXE_purlwise-tested")`.
    pub fn new(program: &'static str) -> Self {
        Self { program, folder: tempfile::tempdir().unwrap(), variables: Vec::new() }
    }

    /// Sets a variable of the environment for all runs from now on.
    pub fn set(&mut self, name: &'static str, value: &'static str) {
        self.variables.push((name, value));
    }

    /// A file in the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes a file into the folder.
    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), bytes).unwrap();
    }

    /// Reads a file from the folder.
    pub fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    /// Runs the program in the folder.
    pub fn run(&self, arguments: &[&str]) -> Run {
        let mut command = Command::new(self.program);
        command.args(arguments).current_dir(self.folder.path()).envs(self.variables.iter().copied());
        let output = command.output().unwrap();
        let text = |bytes| String::from_utf8(bytes).unwrap();
        Run { status: output.status.code(), stdout: text(output.stdout), stderr: text(output.stderr) }
    }

    /// Runs the program with `--json`; it has to succeed and to print one JSON object and nothing else.
    pub fn json(&self, arguments: &[&str]) -> Value {
        let run = self.run(&[arguments, &["--json"]].concat());
        assert_eq!(run.status, Some(0), "{arguments:?}: {}", run.stderr);
        let value: Value = serde_json::from_str(&run.stdout)
            .unwrap_or_else(|e| panic!("{arguments:?}: {e}: {}", run.stdout));
        assert!(value.is_object(), "{value}");
        value
    }
}
