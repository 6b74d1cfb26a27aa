//! Cables written out: crosses of unequal strands, plaits, whatever changes places.
//!
//! Letters name the strands, `A` the leftmost below. `2/1`, `BA`, `BA` brings a single loop to the left in front of two; `2/2/2`,
//! `CBA`, `ACB` is a plait of three whose outer strands change sides, the left one in front.

use crate::window::actions::button;
use crate::window::editor::Editor;
use egui::Ui;
use stitch_mesh::cable::Cable;
use stitch_mesh::ids::VertexId;

/// What stands in the fields.
pub struct Fields {
    /// Loops of each strand, left to right below.
    loops: String,
    /// Strands left to right above.
    above: String,
    /// Strands front to back.
    front: String,
}

impl Default for Fields {
    fn default() -> Self {
        Self { loops: "2/1".into(), above: "BA".into(), front: "BA".into() }
    }
}

impl Fields {
    /// The cable along a path.
    ///
    /// # Errors
    /// What cannot be read. Whether the cable can cross there is found when it is set.
    pub fn cable(&self, path: Vec<VertexId>) -> Result<Cable, &'static str> {
        let number = |text: &str| text.trim().parse::<u8>().ok();
        let strands: Option<Vec<u8>> = self.loops.split('/').map(number).collect();
        let letters = |text: &str| -> Option<Vec<u8>> {
            let letters = text.chars().filter(|c| !c.is_whitespace());
            letters.map(|c| c.is_ascii_alphabetic().then(|| c.to_ascii_uppercase() as u8 - b'A')).collect()
        };
        Ok(Cable {
            path,
            strands: strands.ok_or("write the loops of each strand as in 2/1 or 2/2/2")?,
            order: letters(&self.above).ok_or("write which strands stand where above as in BA or CBA")?,
            front: letters(&self.front).ok_or("write the strands front to back as in BA or ACB")?,
        })
    }
}

/// Shows the fields.
pub fn show(editor: &mut Editor, ui: &mut Ui) {
    let field = |ui: &mut Ui, name: &str, value: &mut String, what: &str| {
        let label = ui.label(name);
        let field = egui::TextEdit::singleline(value).desired_width(44.0);
        ui.add(field).labelled_by(label.id).on_hover_text(what);
    };
    ui.horizontal(|ui| {
        let what = "Loops of each strand, left to right below: 2/1, or 2/2/2 for a plait";
        field(ui, "Strands", &mut editor.panel.strands.loops, what);
        button(editor, ui, "Cross strands");
    });
    ui.horizontal(|ui| {
        let fields = &mut editor.panel.strands;
        field(ui, "Above", &mut fields.above, "Strands left to right above; A is the leftmost below");
        field(ui, "In front", &mut fields.front, "Strands front to back");
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_are_strands() {
        let of = |loops: &str, above: &str, front: &str| {
            Fields { loops: loops.into(), above: above.into(), front: front.into() }.cable(vec![])
        };
        let plait = of("2/1/2", "cba", "A C B").unwrap();
        assert_eq!((plait.strands, plait.order, plait.front), (vec![2, 1, 2], vec![2, 1, 0], vec![0, 2, 1]));
        assert_eq!(Fields::default().cable(vec![]), Ok(Cable::cross(vec![], 2, 1, true)));
        assert!(of("2;1", "BA", "BA").unwrap_err().contains("2/1"));
        assert!(of("2/1", "B1", "BA").is_err() && of("2/1", "BA", "?").is_err());
    }
}
