//! Commands that say what yarns are made of.

use crate::project::Project;
use crate::relax::mean_width;
use anyhow::{Result, bail};
use sim_core::{Material, Preset};
use stitch_mesh::dye::Dye;

pub(super) fn set(project: &mut Project, color: Option<Dye>, material: Material) -> Result<()> {
    let mut materials = project.materials.clone();
    match color {
        Some(color) => {
            materials.by_dye.insert(color, material);
        }
        None => materials.base = material,
    }
    materials.validate()?;
    project.materials = materials;
    Ok(())
}

pub(super) fn use_preset(project: &mut Project, color: Option<Dye>, preset: Preset) -> Result<()> {
    let width = project.knitted().map_or(project.size.width, |f| mean_width(&f.stitches));
    set(project, color, preset.material(width))
}

pub(super) fn clear(project: &mut Project, color: Dye) -> Result<()> {
    if project.materials.by_dye.remove(&color).is_none() {
        bail!("yarn of the colour {color} has no material of its own");
    }
    Ok(())
}
