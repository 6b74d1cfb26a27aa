//! Many short lists, one after another in one array.

/// Lists for each vertex.
pub(super) struct Lists<T> {
    /// Where each list begins in `items`, and one more entry for the end of the last.
    pub start: Vec<u32>,
    pub items: Vec<T>,
}

impl<T> Lists<T> {
    /// Sorts items into lists; the order within a list is that of `items`.
    pub fn new(count: usize, items: Vec<(u32, T)>) -> Self {
        let mut items = items;
        items.sort_by_key(|(v, _)| *v);
        let mut start = vec![0; count + 1];
        items.iter().for_each(|(v, _)| start[*v as usize + 1] += 1);
        (0..count).for_each(|v| start[v + 1] += start[v]);
        Self { start, items: items.into_iter().map(|(_, item)| item).collect() }
    }

    pub fn of(&self, v: usize) -> &[T] {
        &self.items[self.start[v] as usize..self.start[v + 1] as usize]
    }
}
