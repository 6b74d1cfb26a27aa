//! Cross-crate suites live beside this file; see each test.
