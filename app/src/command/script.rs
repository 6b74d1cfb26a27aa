//! Scripts: files of commands, one JSON object a line.

use super::Command;
use anyhow::{Context, Result};

/// Reads a script: one command a line, as JSON; empty lines and lines that begin with `#` are passed over. Each command comes
/// with the number of its line, from 1.
///
/// # Errors
/// The line that is not a command.
pub fn read_script(text: &str) -> Result<Vec<(usize, Command)>> {
    let lines = text.lines().enumerate().filter(|(_, l)| !l.trim().is_empty() && !l.trim().starts_with('#'));
    lines
        .map(|(number, line)| {
            let command =
                serde_json::from_str(line).with_context(|| format!("line {}: not a command", number + 1))?;
            Ok((number + 1, command))
        })
        .collect()
}

/// Writes a script that [`read_script`] reads.
///
/// # Errors
/// A command with a number that JSON cannot hold.
pub fn write_script<'a>(commands: impl IntoIterator<Item = &'a Command>) -> Result<String> {
    let mut text = String::new();
    for command in commands {
        text.push_str(&serde_json::to_string(command)?);
        text.push('\n');
    }
    Ok(text)
}
