//! What is wrong with a text, or doubtful in it, and where.

use ariadne::{Config, IndexType, Label, Report, ReportKind, Source};
use std::fmt;
use std::ops::Range;

/// Why a text cannot be read, or its rows cannot be worked. Shown on one line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct KnitSpeakError {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// Number of the pattern's row, where one is concerned.
    pub row: Option<usize>,
    /// Bytes of the text that it is about.
    pub span: Range<usize>,
    /// What was found and what was expected.
    pub message: String,
}

/// Something that does not keep a pattern from being worked, but is hardly meant so. Shown on one line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// What is doubtful.
    pub text: String,
}

/// A fault in a text, before it has a line and a column.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fault {
    pub span: Range<usize>,
    pub row: Option<usize>,
    pub message: String,
}

impl Fault {
    pub fn new(span: Range<usize>, message: impl Into<String>) -> Self {
        Self { span, row: None, message: message.into() }
    }

    /// The fault of a row: of that one inside, if one is named already.
    pub fn in_row(mut self, row: usize) -> Self {
        self.row.get_or_insert(row);
        self
    }
}

/// Where the lines of a text begin, and which of its bytes begin a character.
#[derive(Clone, Debug)]
pub(super) struct Lines {
    text: String,
    starts: Vec<usize>,
}

impl Lines {
    pub fn new(text: &str) -> Self {
        let starts = std::iter::once(0).chain(text.match_indices('\n').map(|(i, _)| i + 1)).collect();
        Self { text: text.to_owned(), starts }
    }

    /// Line and column of a byte, both from 1.
    fn place(&self, byte: usize) -> (usize, usize) {
        let line = self.starts.partition_point(|start| *start <= byte);
        let start = self.starts[line - 1];
        (line, self.text.get(start..byte).map_or(0, |before| before.chars().count()) + 1)
    }

    pub fn error(&self, fault: Fault) -> KnitSpeakError {
        let (line, column) = self.place(fault.span.start);
        KnitSpeakError { line, column, row: fault.row, span: fault.span, message: fault.message }
    }

    pub fn warning(&self, byte: usize, text: String) -> Warning {
        let (line, column) = self.place(byte);
        Warning { line, column, text }
    }
}

impl fmt::Display for KnitSpeakError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}, column {}", self.line, self.column)?;
        if let Some(row) = self.row {
            write!(f, ", row {row}")?;
        }
        write!(f, ": {}", self.message)
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}, column {}: {}", self.line, self.column, self.text)
    }
}

impl KnitSpeakError {
    /// The error with the place in the text drawn under it, for people at a terminal. `name` is the text's, `text` the one
    /// that was read.
    pub fn report(&self, name: &str, text: &str) -> String {
        let mut bytes = Vec::new();
        let config = Config::default().with_color(false).with_index_type(IndexType::Byte);
        let written = Report::build(ReportKind::Error, (name, self.span.clone()))
            .with_config(config)
            .with_message(self)
            .with_label(Label::new((name, self.span.clone())).with_message("here"))
            .finish()
            .write((name, Source::from(text)), &mut bytes);
        // Writing into memory does not fail; the line itself says all there is to say if it did.
        written.map_or_else(|_| self.to_string(), |()| String::from_utf8_lossy(&bytes).into_owned())
    }
}
