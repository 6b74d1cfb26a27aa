//! The buffers of a net on the device: those of all of it, and those of each chunk.

use super::constants::SUM_SPAN;
use super::device::{GpuDevice, LIMITS};
use super::layout::{Body as BodyRecord, Contact, Params, Pin as PinRecord, Rigid, Status};
use super::tables::{Chunk, Tables, yarns};
use crate::material::Material;
use std::collections::BTreeMap;

/// Buffers by the names that kernels know them by.
pub(crate) struct Buffers {
    whole: BTreeMap<&'static str, wgpu::Buffer>,
    chunks: Vec<BTreeMap<&'static str, wgpu::Buffer>>,
    /// Cells of the grid that near nodes are looked for in.
    pub cell_count: u32,
    /// Places for contacts of layers.
    pub contact_capacity: u32,
}

impl Buffers {
    /// Puts `tables` on the device, and makes room for what the kernels find.
    pub fn new(gpu: &GpuDevice, tables: &Tables, materials: &[Material]) -> Self {
        let nodes = tables.nodes.len() as u64;
        let dofs = u64::from(tables.dof_count());
        let visits = u64::from(tables.visit_count);
        let most_contacts = LIMITS.max_storage_buffer_binding_size / size_of::<Contact>() as u64;
        let contact_capacity = (8 * nodes).min(most_contacts);
        let cell_count = nodes.next_power_of_two();
        let spans = |count: u64| count.div_ceil(u64::from(SUM_SPAN));
        let elements = tables.chunks.iter().map(Chunk::element_count).max().unwrap_or_default();
        let p = &tables.pattern;
        let mut whole = BTreeMap::from([
            ("params", gpu.upload("params", &[Params::default()])),
            ("materials", gpu.upload("materials", &yarns(materials))),
            ("nodes", gpu.upload("nodes", &tables.nodes)),
            ("stacked", gpu.upload("stacked", &tables.stacked)),
            ("pulls", gpu.upload("pulls", &tables.pulls)),
            ("around", gpu.upload("around", &tables.around)),
            ("incoming", gpu.upload("incoming", &tables.incoming)),
            ("joints", gpu.upload("joints", &tables.joints)),
            ("old_dyes", gpu.upload("old_dyes", &tables.old_dyes)),
            ("groups", gpu.upload("groups", &p.groups)),
            ("tiles", gpu.upload("tiles", &p.changes.tiles)),
            ("sources", gpu.upload("sources", &p.changes.sources)),
            ("rows", gpu.upload("rows", &p.row_dofs)),
            ("bodies", gpu.upload("bodies", &[BodyRecord::default()])),
            ("fields", gpu.upload("fields", &[0.0_f32])),
            ("pins", gpu.upload("pins", &[PinRecord::default()])),
        ]);
        for (name, bytes) in [
            ("position", 16 * nodes),
            ("velocity", 16 * nodes),
            ("next_position", 16 * nodes),
            ("moving", 16 * nodes),
            ("back", 16 * nodes),
            ("back_next", 16 * nodes),
            ("normals", 16 * nodes),
            ("held", 48 * nodes),
            ("links", 4 * nodes),
            ("contacts_of", 8 * nodes),
            ("contacts", size_of::<Contact>() as u64 * contact_capacity),
            ("heads", 4 * (cell_count + 2)),
            ("visits", 16 * visits),
            ("next_visits", 16 * visits),
            ("pull", 16 * tables.stacked.len() as u64),
            ("springs", 16 * tables.stacked.len() as u64),
            ("points", 16 * u64::from(tables.point_count())),
            ("load", 8 * dofs),
            ("x", 4 * dofs),
            ("r", 4 * dofs),
            ("p", 4 * dofs),
            ("q", 4 * dofs),
            ("z", 4 * dofs),
            ("handed", 4 * p.row_dofs.len() as u64),
            ("partial", 8 * spans(dofs)),
            ("sums", 48 * spans(nodes)),
            ("held_sums", 32 * spans(nodes)),
            ("elements", 16 * u64::from(elements)),
            ("rigid", size_of::<Rigid>() as u64),
            ("status", size_of::<Status>() as u64),
            ("faults", 8),
            ("touching", 4),
            ("shift", 16),
            ("factor_elsewhere", 16),
        ] {
            whole.insert(name, gpu.buffer(name, bytes));
        }
        let of_chunk = |(c, shared_rows): (&Chunk, &Vec<u32>)| {
            BTreeMap::from([
                ("shared_rows", gpu.upload("shared_rows", shared_rows)),
                ("counts", gpu.upload("counts", &[c.counts])),
                ("segments", gpu.upload("segments", &c.segments)),
                ("bends", gpu.upload("bends", &c.bends)),
                ("wraps", gpu.upload("wraps", &c.wraps)),
                ("shears", gpu.upload("shears", &c.shears)),
                ("entries", gpu.upload("entries", &c.entries)),
                ("blocks", gpu.upload("blocks", &c.blocks)),
                ("values", gpu.buffer("values", 4 * u64::from(c.value_count))),
                ("factor", gpu.buffer("factor", 4 * c.factor_count)),
            ])
        };
        let chunks = tables.chunks.iter().zip(&p.changes.shared_rows).map(of_chunk).collect();
        Self { whole, chunks, cell_count: cell_count as u32, contact_capacity: contact_capacity as u32 }
    }

    /// A buffer of all of the net.
    pub fn whole(&self, name: &str) -> &wgpu::Buffer {
        &self.whole[name]
    }

    /// The buffer that a kernel knows as `name` when it works on a chunk, or on everything.
    pub fn find(&self, chunk: Option<usize>, name: &str) -> Option<&wgpu::Buffer> {
        chunk.and_then(|c| self.chunks[c].get(name)).or_else(|| self.whole.get(name))
    }

    /// The buffers of all chunks that kernels know as `name`.
    pub fn of_chunks<'a>(&'a self, name: &'static str) -> impl Iterator<Item = &'a wgpu::Buffer> {
        self.chunks.iter().filter_map(move |chunk| chunk.get(name))
    }

    /// Puts a buffer in the place of another, which what is bound to that still has.
    pub fn replace(&mut self, name: &'static str, buffer: wgpu::Buffer) {
        self.whole.insert(name, buffer);
    }

    /// What they take on the device [bytes].
    pub fn bytes(&self) -> u64 {
        self.whole.values().chain(self.chunks.iter().flat_map(BTreeMap::values)).map(wgpu::Buffer::size).sum()
    }

    /// Bytes of the largest that is not cut into chunks. Elements and contacts are left out: the ones are those of one chunk
    /// at a time, and of the others there are no more than fit.
    #[cfg(test)]
    pub fn largest_whole(&self) -> u64 {
        let whole = self.whole.iter().filter(|(name, _)| !["elements", "contacts", "part"].contains(*name));
        whole.map(|(_, buffer)| buffer.size()).max().unwrap_or_default()
    }
}
