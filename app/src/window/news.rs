//! What has come since the last frame: from the document, from the simulation, and what goes to it.

use super::editor::{Editor, first_stage};
use super::panels;
use crate::drawing::Stage;
use render::NamedView;
use sim_core::SimCommand;
use std::sync::Arc;

impl Editor {
    /// Takes over what the document and the simulation have done since the last frame.
    pub(super) fn take_news(&mut self) {
        let view = self.session.latest();
        if view.revision != self.view.revision {
            if view.opened != self.view.opened {
                let kept = std::mem::replace(&mut self.panel, panels::State::of(&view));
                (self.panel.aspect, self.panel.lab) = (kept.aspect, kept.lab);
                // Files of the document before are not this one's, and what was asked about it is settled.
                self.written.clear();
                (self.replacing, self.leaving) = (None, None);
            } else if view.path != self.view.path {
                self.panel.path = panels::path_text(&view);
            }
            self.error = view.message.clone().err();
            self.forget_parts(&view.project);
            if view.opened != self.view.opened {
                self.go_to(first_stage(&view.project));
                self.set_strained(false);
                self.framed = false;
            } else if view.project.fabric.is_none() {
                // Stitches that were taken back leave the labels they were made from.
                self.go_to(self.stage.min(Stage::Labels));
            }
            self.view = view;
        }
        let survey = self.session.survey();
        if !Arc::ptr_eq(&survey, &self.survey) {
            self.survey = survey;
            self.recolour |= self.strained;
        }
        let strung = self.newest.get().filter(|s| s.snapshot.generation == self.generation);
        let is_new = match (&strung, &self.strung) {
            (Some(new), Some(old)) => !Arc::ptr_eq(new, old),
            (new, _) => new.is_some(),
        };
        if is_new {
            self.playing = self.playing && strung.as_ref().is_none_or(|s| s.snapshot.error.is_none());
            self.strung = strung;
            self.is_new = true;
        }
    }

    /// Puts on the screen what is not there yet.
    pub(super) fn show_news(&mut self) {
        let is_new = std::mem::take(&mut self.is_new);
        if self.shown != Some((self.view.revision, self.stage)) {
            self.shown = Some((self.view.revision, self.stage));
            self.show_stage();
        } else if is_new && self.stage == Stage::Yarn {
            self.show_yarn();
        } else if std::mem::take(&mut self.recolour) {
            self.show_colors();
        }
        self.show_preview();
        if !self.framed && self.bounds().is_some() {
            self.framed = true;
            self.frame(Some(NamedView::ThreeQuarter));
        }
    }

    /// Hands the yarn to the simulation where the net, the scene or the materials are others than before. As long as
    /// nobody looks at it or lets it move, it need not be ready.
    pub(super) fn load_yarn(&mut self) {
        if self.stage != Stage::Yarn && !self.playing {
            return;
        }
        let project = &self.view.project;
        let Some(fabric) = &project.fabric else {
            if self.loaded.take().is_some() {
                self.sim.send(SimCommand::Stop);
                self.strung = None;
            }
            return;
        };
        // After an edit the yarn follows a little later.
        let Some(net) = fabric.net_if_laid() else { return };
        let wants = (project.materials.clone(), project.scene.clone());
        let in_place = self.placed == self.view.placed
            && self.loaded.as_ref().is_some_and(|loaded| Arc::ptr_eq(loaded, net));
        if !in_place {
            self.generation = self.sim.send(SimCommand::Load {
                net: net.clone(),
                materials: wants.0.clone(),
                scene: wants.1.clone(),
                state: Some(fabric.state()),
            });
            self.loaded = Some(net.clone());
            self.placed = self.view.placed;
            if self.playing {
                self.sim.send(SimCommand::Play);
            }
        } else if self.simulated.as_ref() != Some(&wants) {
            self.sim.send(SimCommand::SetMaterials(wants.0.clone()));
            self.sim.send(SimCommand::SetScene(wants.1.clone()));
        }
        self.simulated = Some(wants);
    }
}
