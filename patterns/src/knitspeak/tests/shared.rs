//! The patterns that come with the project's data.

use super::*;
use std::path::PathBuf;

fn shared() -> Vec<(String, String)> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/patterns");
    let Ok(entries) = std::fs::read_dir(&folder) else {
        println!("skipped: there is no {}", folder.display());
        return Vec::new();
    };
    let paths = entries.map(|e| e.unwrap().path()).filter(|p| p.extension().is_some_and(|e| e == "ks"));
    paths.map(|p| (p.display().to_string(), std::fs::read_to_string(&p).unwrap())).collect()
}

#[test]
fn shared_patterns_give_the_figures_of_their_check_lines() {
    for (name, text) in shared() {
        let pattern = Pattern::read(&text).unwrap_or_else(|e| panic!("{}", e.report(&name, &text)));
        let worked = pattern.work(Width::AsWritten).unwrap_or_else(|e| panic!("{}", e.report(&name, &text)));
        assert_eq!(worked.warnings, [], "{name}");
        let check = pattern.check.unwrap();
        let figures = (worked.cast_on, worked.rows.len(), worked.most_stitches());
        assert_eq!(figures, (check.cast_on, check.rows, check.most), "{name}");
        assert_round_trip(&worked);
    }
}

#[test]
fn shared_patterns_need_no_check_line() {
    for (name, text) in shared() {
        let bare: String = text.lines().filter(|l| !l.contains("check:")).map(|l| format!("{l}\n")).collect();
        for repeats in 2..5 {
            let pattern = Pattern::read(&bare).unwrap();
            let worked = pattern.work(Width::Repeats(repeats)).unwrap_or_else(|e| panic!("{name}: {e}"));
            if let Some(row) = worked.rows.iter().find(|row| !row.repeats.is_empty()) {
                assert_eq!(row.repeats.len(), repeats, "{name}");
            }
            assert_round_trip(&worked);
        }
        let worked = as_written(&bare);
        assert!(worked.rows.iter().all(|row| row.repeats.len() != 1), "{name}");
    }
}
