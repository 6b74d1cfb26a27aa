//! The editor model, the window and the command line.
//!
//! | file | idea |
//! |---|---|
//! | `project` | what a project is, and its file |
//! | `command`, `document` | every change is a [`command::Command`]; a [`document::Document`] does, undoes and redoes them |
//! | `cloth` | woven cloth as a project of its own |
//! | `relax` | relaxing the stitch mesh of a project, and how even it is |
//! | `inspect`, `problems`, `preview`, `scenes`, `drawing`, `export`, `bundled`, `sheet`, `charts` | facts, what is wrong, what other counts would come to, named scenes, pictures and curves of a project, what comes with the program, the contact sheet of stitches, knitting charts |
//! | `lab` | virtual textile experiments |
//! | `page` | pages laid out as the window is, drawn without one |
//! | `cli` | the command line |
//! | `window` | the same document with a mouse |

pub mod bundled;
pub mod charts;
pub mod cli;
pub mod cloth;
pub mod command;
pub mod document;
pub mod drawing;
pub mod export;
pub mod fabric;
pub mod files;
pub mod inspect;
pub mod lab;
pub mod library;
pub mod open;
mod page;
pub mod preview;
pub mod problems;
pub mod project;
pub mod relax;
pub mod scenes;
pub mod sheet;
pub mod solids;
pub mod window;
pub mod written;
