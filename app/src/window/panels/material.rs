//! What yarns are made of: presets and parameters, for all yarn or for yarn of one colour.

use crate::command::Command;
use crate::window::editor::Editor;
use egui::{Color32, Ui};
use sim_core::{Material, Preset, SimCommand};
use stitch_mesh::dye::Dye;

/// A parameter as the panel shows it.
struct Field {
    name: &'static str,
    unit: &'static str,
    /// Shown value over the one in SI units.
    scale: f64,
    what: &'static str,
    of: fn(&mut Material) -> &mut f64,
}

/// The parameters that have a meaning for somebody who chooses yarn; the others stand in project files and scripts.
const FIELDS: [Field; 11] = [
    Field {
        name: "Radius",
        unit: " mm",
        scale: 1e3,
        what: "Radius that the stiffnesses are reckoned with",
        of: |m| &mut m.radius,
    },
    Field {
        name: "Drawn",
        unit: " mm",
        scale: 1e3,
        what: "Radius at which it is drawn and keeps clear of bodies",
        of: |m| &mut m.drawn_radius,
    },
    Field {
        name: "Mass",
        unit: " g/m",
        scale: 1e3,
        what: "Mass of a metre: 1 g/m is 1000 tex",
        of: |m| &mut m.density,
    },
    Field {
        name: "Stretch",
        unit: " MPa",
        scale: 1e-6,
        what: "Young's modulus along the yarn",
        of: |m| &mut m.young_modulus,
    },
    Field {
        name: "Bending",
        unit: " kPa mm²",
        scale: 1e3,
        what: "Bending modulus: stiffness of bending over cross-section",
        of: |m| &mut m.bending_modulus,
    },
    Field {
        name: "Wrapping",
        unit: " mN",
        scale: 1e3,
        what: "How strongly loops stand out of the fabric: what curls it and draws rib in",
        of: |m| &mut m.wrap_stiffness,
    },
    Field {
        name: "Angle",
        unit: "°",
        scale: 180.0 / std::f64::consts::PI,
        what: "Angle at which wrapped yarns are at rest",
        of: |m| &mut m.wrap_angle,
    },
    Field {
        name: "Friction",
        unit: "",
        scale: 1.0,
        what: "Coefficient of friction; between two yarns the geometric mean of both",
        of: |m| &mut m.friction,
    },
    Field {
        name: "Cohesion",
        unit: " mN",
        scale: 1e3,
        what: "Force that presses touching yarns together besides their tension",
        of: |m| &mut m.cohesion,
    },
    Field {
        name: "Damping α",
        unit: " /s",
        scale: 1.0,
        what: "Rayleigh damping by mass: how soon motion dies",
        of: |m| &mut m.mass_damping,
    },
    Field {
        name: "Damping β",
        unit: " ms",
        scale: 1e3,
        what: "Rayleigh damping by stiffness: how soon trembling dies",
        of: |m| &mut m.stiffness_damping,
    },
];

/// Shows them.
pub fn show(editor: &mut Editor, ui: &mut Ui) {
    ui.heading("Material");
    choose_yarn(editor, ui);
    let color = editor.panel.yarn;
    ui.horizontal(|ui| {
        ui.menu_button("Preset…", |ui| {
            for preset in Preset::ALL {
                if ui.button(preset.name()).clicked() {
                    editor.act(Command::UsePreset { color, preset });
                    ui.close();
                }
            }
        });
        if let Some(color) = color.filter(|c| editor.project().materials.by_dye.contains_key(c))
            && ui.button("As the rest").on_hover_text("Forget the material of this colour").clicked()
        {
            editor.act(Command::ClearMaterial { color });
        }
    });
    fields(editor, ui, color);
}

/// All yarn, or one of the colours in the fabric.
fn choose_yarn(editor: &mut Editor, ui: &mut Ui) {
    let project = editor.project();
    let mut dyes = project.fabric.as_ref().map(|f| f.stitches.dyes().to_vec()).unwrap_or_default();
    dyes.extend(project.materials.by_dye.keys());
    dyes.sort_unstable();
    dyes.dedup();
    if editor.panel.yarn.is_some_and(|y| !dyes.contains(&y)) {
        editor.panel.yarn = None;
    }
    ui.horizontal_wrapped(|ui| {
        let all = ui.selectable_label(editor.panel.yarn.is_none(), "All yarn");
        if all.on_hover_text("Yarn of every colour that has no material of its own").clicked() {
            editor.panel.yarn = None;
        }
        for dye in dyes {
            let Dye([r, g, b]) = dye;
            let chosen = editor.panel.yarn == Some(dye);
            let width = if chosen { 2.5 } else { 0.0 };
            let stroke = egui::Stroke::new(width, ui.visuals().strong_text_color());
            let swatch = egui::Button::new("").fill(Color32::from_rgb(r, g, b)).stroke(stroke);
            let response = ui.add(swatch.min_size(egui::vec2(22.0, 22.0)));
            let name = format!("Yarn {dye}");
            response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &name));
            if response.on_hover_text(name).clicked() {
                editor.panel.yarn = Some(dye);
            }
        }
    });
}

fn fields(editor: &mut Editor, ui: &mut Ui, color: Option<Dye>) {
    let materials = &editor.project().materials;
    let known = color.map_or(&materials.base, |c| materials.of(c)).clone();
    let mut material = editor.panel.material.take().unwrap_or(known);
    let (mut moving, mut done) = (false, false);
    egui::Grid::new("material").num_columns(2).show(ui, |ui| {
        for Field { name, unit, scale, what, of } in FIELDS {
            let value = of(&mut material);
            let mut shown = *value * scale;
            let label = ui.label(name);
            let speed = 0.01 * shown.max(1e-3);
            let drag = egui::DragValue::new(&mut shown)
                .suffix(unit)
                .range(0.0..=f64::MAX)
                .update_while_editing(false);
            let response = ui.add(drag.speed(speed).max_decimals(3)).labelled_by(label.id);
            if response.changed() {
                *value = shown / scale;
            }
            moving |= response.dragged();
            done |= response.drag_stopped() || (response.changed() && !response.dragged());
            response.on_hover_text(what);
            ui.end_row();
        }
    });
    if moving {
        // The fabric answers while the number is dragged; the history gets one step when it is let go.
        let mut materials = editor.project().materials.clone();
        match color {
            Some(color) => drop(materials.by_dye.insert(color, material.clone())),
            None => materials.base = material.clone(),
        }
        editor.sim.send(SimCommand::SetMaterials(materials));
        editor.panel.material = Some(material);
    } else if done {
        editor.act(Command::SetMaterial { color, material });
    }
}
