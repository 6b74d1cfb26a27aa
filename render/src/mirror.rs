//! A list of which the GPU has a copy.
//!
//! Where a few of many thousand things are others, what is new is put behind everything else and the places of what has gone are left
//! empty, so that only these are written. Whoever keeps the list lays all of it out again when it has too many holes.

use crate::scene::GrowingBuffer;
use crate::{Gpu, RenderError};
use std::ops::Range;

/// Holes are worth it up to this share of a list.
const MOST_HOLES: usize = 4;

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
        let changed = std::mem::take(&mut self.changed);
        self.buffer.write_from(gpu, bytes, written * size, limit)?;
        self.written = self.items.len();
        for Range { start, end } in changed.into_iter().filter(|places| places.start < written) {
            self.buffer.overwrite(gpu, &bytes[start * size..end * size], start * size);
        }
        Ok(())
    }
}
