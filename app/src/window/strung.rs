//! The newest snapshot of the simulation with its yarn laid out for the screen.
//!
//! It is laid out in the simulation's thread, which gives way to the window: a frame uploads what is new and nothing more. The
//! slot holds one of them, so what no frame has shown by the time the next is there is dropped.

use render::YarnLayout;
use sim_core::Snapshot;
use std::sync::{Arc, Mutex, PoisonError};

/// A snapshot ready to be shown.
#[derive(Debug)]
pub struct Strung {
    /// The snapshot.
    pub snapshot: Arc<Snapshot>,
    /// All of its yarn; nothing where that is on the device already.
    pub yarn: YarnLayout,
}

/// The newest of them.
#[derive(Clone, Debug, Default)]
pub struct Newest(Arc<Mutex<Option<Arc<Strung>>>>);

impl Newest {
    /// Lays out a snapshot in place of the one before.
    pub fn put(&self, snapshot: Option<&Arc<Snapshot>>) {
        let strung = snapshot.map(|snapshot| {
            let yarn = YarnLayout::of(&snapshot.curves);
            Arc::new(Strung { snapshot: Arc::clone(snapshot), yarn })
        });
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = strung;
    }

    /// The newest. Does not wait for the one that is being laid out.
    pub fn get(&self) -> Option<Arc<Strung>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use stitch_mesh::dye::Dye;
    use stitch_mesh::yarn_curves::{YarnCurve, YarnCurves};

    fn snapshot(length: usize) -> Arc<Snapshot> {
        let points = (0..length).map(|i| Vec3::new(i as f32, (i * i) as f32, 0.0)).collect();
        let curves = YarnCurves { curves: vec![YarnCurve::new(points, false, 0.1, Dye::UNDYED)] };
        Arc::new(Snapshot { curves, ..Snapshot::default() })
    }

    #[test]
    fn the_newest_wins_laid_out_as_elsewhere() {
        let newest = Newest::default();
        assert!(newest.get().is_none());
        let [first, last] = [40, 70].map(snapshot);
        newest.put(Some(&first));
        let before = newest.get().unwrap();
        newest.put(Some(&last));
        let strung = newest.get().unwrap();
        assert!(Arc::ptr_eq(&strung.snapshot, &last));
        assert_eq!(strung.yarn, YarnLayout::of(&last.curves));
        assert_ne!(strung.yarn, before.yarn);
        // Where there is nothing new it is the very same, and nothing is laid out.
        assert!(Arc::ptr_eq(&strung, &newest.get().unwrap()));
        newest.put(None);
        assert!(newest.get().is_none());
    }
}
