//! Every pattern at hand knitted: the library, and the patterns that stand beside the repository where they do.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests are tests, which clippy cannot see")]

use patterns::instructions::instructions;
use patterns::knit::knit;
use patterns::knitspeak::{Pattern, Width, Work, write};
use std::path::{Path, PathBuf};
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::lay::lay;
use stitch_mesh::unravel::loose_loops;

const SIZE: StitchSize = StitchSize { width: 4e-3, height: 3e-3 };

fn texts(folder: &Path) -> Vec<(PathBuf, String)> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let paths = entries.map(|e| e.unwrap().path()).filter(|p| p.extension().is_some_and(|e| e == "ks"));
    let mut texts: Vec<_> = paths.map(|p| (p.clone(), std::fs::read_to_string(p).unwrap())).collect();
    texts.sort();
    texts
}

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

#[test]
fn all_patterns_are_knitted_hold_and_come_back_from_their_instructions() {
    let library = texts(&folder("../assets/patterns"));
    assert!(library.len() >= 39, "{} patterns", library.len());
    let beside = texts(&folder("../../shared/patterns"));
    if beside.is_empty() {
        eprintln!("skipped: there are no patterns beside the repository");
    }
    for (path, text) in library.iter().chain(&beside) {
        let name = path.display();
        let pattern = Pattern::read(text).unwrap_or_else(|e| panic!("{name}: {e}"));
        let worked = pattern.work(Width::AsWritten).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(worked.warnings.is_empty(), "{name}: {}", worked.warnings[0]);
        let fabric = knit(&pattern, &worked, SIZE).unwrap_or_else(|e| panic!("{name}: {e}"));
        let loops: usize = worked.rows.iter().map(|r| r.loops).sum();
        let crosses_first = worked.rows[0].steps.iter().any(|s| matches!(s.what, Work::Cross(_)));
        let below = if crosses_first { worked.cast_on } else { 0 };
        assert_eq!(fabric.loop_count(), loops + below, "{name}");
        let net = lay(&fabric);
        assert!(loose_loops(&fabric, &net).is_empty(), "{name}: a loop that nothing holds");
        let ends = net.yarns.iter().filter(|y| y.period.is_none()).count();
        if !worked.in_the_round {
            assert_eq!((ends, net.yarns.len()), (1, 1), "{name} is one yarn");
        }
        let told = instructions(&fabric, &fabric.rows()).unwrap_or_else(|e| panic!("{name}: {e}"));
        let written = write(&told);
        let again = Pattern::read(&written).unwrap_or_else(|e| panic!("{name}: {e}\n{written}"));
        let worked = again.work(Width::AsWritten).unwrap_or_else(|e| panic!("{name}: {e}\n{written}"));
        let knitted = knit(&again, &worked, SIZE).unwrap_or_else(|e| panic!("{name}: {e}\n{written}"));
        assert!(
            knitted == fabric,
            "{name} becomes another fabric when its instructions are knitted:\n{written}"
        );
    }
}
