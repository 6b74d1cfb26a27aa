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

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    /// Every line of `docs/scripts.md` that looks like a command is one, and every command is named there.
    #[test]
    fn the_documentation_of_scripts_is_complete_and_true() {
        let text = include_str!("../../../docs/scripts.md");
        let lines: Vec<&str> = text.lines().filter(|line| line.starts_with('{')).collect();
        let read = read_script(&lines.join("\n")).unwrap();
        assert_eq!(read.len(), lines.len());
        // What serde expects is the list of all of them.
        let expected = serde_json::from_str::<Command>(r#"{"do":"?"}"#).unwrap_err().to_string();
        let names: BTreeSet<&str> = expected.split('`').skip(3).step_by(2).collect();
        assert!(names.len() > 40, "{expected}");
        for name in names {
            let is_told = lines.iter().any(|line| line.contains(&format!("{{\"do\":\"{name}\"")));
            assert!(is_told || text.contains(&format!("`{name}`")), "{name} is not told of");
        }
        assert!(read_script(r#"{"do":"dance"}"#).is_err());
    }
}
