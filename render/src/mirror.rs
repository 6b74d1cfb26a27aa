//! A list of which the GPU has a copy.
//!
//! Where a few of many thousand things are others, what is new is put behind everything else and the places of what has gone are left
//! empty, so that only these are written; the order of drawing is that of the list, not of the things. Whoever keeps the list lays all
//! of it out again when it has too many holes.

use crate::scene::GrowingBuffer;
use crate::{Gpu, RenderError};
use std::ops::Range;

/// Holes are worth it up to one item in so many.
const MOST_HOLES: usize = 4;
/// Each write has its own way to the GPU, which costs as much as some more bytes: what lies between two changes is written along.
const GAP_BYTES: usize = 8192;

/// The list. It is on the GPU as it was when it was uploaded last.
#[derive(Debug)]
pub(crate) struct Mirror<T> {
    items: Vec<T>,
    buffer: GrowingBuffer,
    /// How many the GPU has, from the first, but for those that have changed since.
    written: usize,
    changed: Vec<Range<usize>>,
}

impl<T: bytemuck::Pod> Mirror<T> {
    pub fn new(what: &'static str, usage: wgpu::BufferUsages) -> Self {
        Self { items: Vec::new(), buffer: GrowingBuffer::new(what, usage), written: 0, changed: Vec::new() }
    }

    /// The items as they are here.
    pub fn items(&self) -> &[T] {
        &self.items
    }

    /// The items as they are on the GPU, if there are any.
    pub fn buffer(&self) -> Option<&wgpu::Buffer> {
        self.buffer.buffer().filter(|_| !self.items.is_empty())
    }

    /// Whether a list of so many with so many holes is better laid out again.
    pub fn has_too_many_holes(&self, holes: usize) -> bool {
        holes * MOST_HOLES > self.items.len()
    }

    /// Forgets all items.
    pub fn clear(&mut self) {
        self.items.clear();
        self.changed.clear();
        self.written = 0;
    }

    /// Adds items behind the last.
    pub fn extend(&mut self, items: impl IntoIterator<Item = T>) {
        self.items.extend(items);
    }

    /// Fills some places with one item.
    pub fn fill(&mut self, places: Range<usize>, item: T) {
        self.items[places.clone()].fill(item);
        match self.changed.last_mut().filter(|last| last.end == places.start) {
            Some(last) => last.end = places.end,
            None => self.changed.push(places),
        }
    }

    /// Brings the GPU up to date.
    ///
    /// # Errors
    /// It is more than a buffer holds; then there is none.
    pub fn upload(&mut self, gpu: &Gpu) -> Result<(), RenderError> {
        let limit = gpu.device.limits().max_buffer_size;
        let bytes = bytemuck::cast_slice(&self.items);
        let size = size_of::<T>();
        let written = std::mem::take(&mut self.written);
        let changed = bridged(std::mem::take(&mut self.changed), GAP_BYTES / size);
        self.buffer.write_from(gpu, bytes, written * size, limit)?;
        self.written = self.items.len();
        for Range { start, end } in changed.into_iter().filter(|places| places.start < written) {
            self.buffer.overwrite(gpu, &bytes[start * size..end * size], start * size);
        }
        Ok(())
    }
}

/// Ranges in their order, joined where the gap between them is small.
pub(crate) fn bridged(mut ranges: Vec<Range<usize>>, gap: usize) -> Vec<Range<usize>> {
    ranges.sort_unstable_by_key(|range| range.start);
    let mut joined: Vec<Range<usize>> = Vec::new();
    for range in ranges {
        match joined.last_mut().filter(|last| range.start <= last.end + gap) {
            Some(last) => last.end = last.end.max(range.end),
            None => joined.push(range),
        }
    }
    joined
}

#[cfg(test)]
mod tests {
    use super::bridged;
    use std::ops::Range;

    #[test]
    fn changes_are_written_in_few_pieces() {
        let pieces = |ranges: Vec<Range<usize>>, gap| {
            bridged(ranges, gap).into_iter().map(|r| [r.start, r.end]).collect::<Vec<_>>()
        };
        assert_eq!(pieces(vec![9..10, 0..2, 3..4, 2..3], 2), [[0, 4], [9, 10]]);
        assert_eq!(pieces((0..1000).map(|i| 2 * i..2 * i + 1).collect(), 2), [[0, 1999]]);
        assert_eq!(pieces(vec![5..9, 6..7], 0), [[5, 9]]);
        assert!(pieces(vec![], 3).is_empty());
    }
}
