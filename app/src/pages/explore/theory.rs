//! Equation (3) beside its z-form, and play before the relay: its describing function and the cycles with it.

use egui_plot::{HLine, Line, LineStyle, Points};
use hysteron_core::drive::{LoopTheory, loop_theory};
use hysteron_core::explore::{ExploreData, ExploreInput};
use hysteron_core::message::fixed;
use hysteron_core::msg;

use crate::language::{tr, tr_number};
use crate::theme;
use crate::widgets::chart::{Shape, caption_ui, curve, significant, still};
use crate::widgets::controls::slider;
use crate::widgets::equation::equation_ui;

/// Height of the plots, points.
const HEIGHT: f32 = 170.0;

/// What was asked, and what follows from it; computed while one of both is unfolded.
#[derive(Default)]
pub struct Theory {
    /// Half gap of the play before the relay, in the unit of the output.
    pub play: f64,
    known: Option<(ExploreInput, f64, LoopTheory)>,
}

impl Theory {
    fn of(&mut self, input: &ExploreInput, data: &ExploreData) -> &LoopTheory {
        let play = self.play;
        let known = self.known.take();
        let known = known.filter(|(i, p, _)| i == input && *p == play);
        let new = || (input.clone(), play, loop_theory(input, data, play));
        &self.known.insert(known.unwrap_or_else(new)).2
    }

    /// Beside what is known of a loop.
    pub fn ui(&mut self, ui: &mut egui::Ui, input: &ExploreInput, data: &ExploreData) {
        ui.collapsing(tr("Equation (3) in z"), |ui| self.z_ui(ui, input, data));
        ui.collapsing(tr("Play before the relay"), |ui| {
            self.play_ui(ui, input, data);
        });
    }

    /// The pulse transfer function at -1 over the half period: where it meets the threshold is the exact cycle.
    fn z_ui(&mut self, ui: &mut egui::Ui, input: &ExploreInput, data: &ExploreData) {
        equation_ui(ui, "H_h(-1) = -ε/k", &|_| None);
        let level = input.relay.hysteresis / input.relay.gain;
        let theory = self.of(input, data);
        let Some([h, value]) = theory.at_cycle else {
            ui.label(tr("There is no symmetric exact cycle to compare it with."));
            return;
        };
        let keys = [
            ("-Hₕ(-1)", theme::SIMULATED, Shape::Line),
            ("ε/k", theme::NOISE, Shape::Dashes),
            ("exact, by (3)", theme::EXACT, Shape::Circle),
        ];
        caption_ui(ui, "", &keys);
        still("z form", "half period h [s]", "-Hₕ(-1)", HEIGHT).show(ui, |plot| {
            let [form, threshold, exact] = keys.map(|k| k.0);
            plot.hline(
                HLine::new(tr(threshold), level)
                    .color(theme::NOISE)
                    .style(LineStyle::dashed_dense()),
            );
            plot.line(Line::new(tr(form), curve(&theory.z_form)).color(theme::SIMULATED));
            plot.points(
                Points::new(tr(exact), vec![[h, value]])
                    .color(theme::EXACT)
                    .radius(5.0),
            );
        });
        ui.label(tr(msg!(
            "By (3) h = {} s; there -Hₕ(-1) = {}, and ε/k = {}: the same equation at z = -1.",
            fixed(h, 6),
            fixed(value, 6),
            fixed(level, 6)
        )));
    }

    fn play_ui(&mut self, ui: &mut egui::Ui, input: &ExploreInput, data: &ExploreData) {
        slider(ui, &mut self.play, 0.0, 1.0, 0.0..=0.5, "half gap β").on_hover_text(tr(
            "Play between the output and the relay: it stays behind until the output has crossed the gap",
        ));
        if self.play == 0.0 {
            return;
        }
        let theory = self.of(input, data);
        let keys = [
            ("N(A) of the play", theme::DESCRIBING, Shape::Line),
            ("at the predicted cycle", theme::MODEL, Shape::Circle),
        ];
        caption_ui(ui, "", &keys);
        still("play", "real part", "imaginary part", HEIGHT).show(ui, |plot| {
            let [line, found] = keys.map(|k| k.0);
            plot.line(Line::new(tr(line), curve(&theory.play)).color(theme::DESCRIBING));
            let points: Vec<[f64; 2]> = theory.predicted.iter().map(|(_, n)| *n).collect();
            plot.points(
                Points::new(tr(found), points)
                    .color(theme::MODEL)
                    .radius(5.0),
            );
        });
        let predicted = theory.predicted.iter();
        let predicted = predicted.map(|(c, _)| ("Describing function", [c.period, c.before]));
        let exact = theory.with_play.iter();
        let exact = exact.map(|c| ("Exact", [c.period, c.amplitude]));
        egui::Grid::new("play_cycles")
            .striped(true)
            .num_columns(3)
            .show(ui, |ui| {
                for title in ["", "period [s]", "amplitude"] {
                    ui.strong(tr(title));
                }
                ui.end_row();
                for (name, values) in predicted.chain(exact) {
                    ui.label(tr(name));
                    for value in values {
                        ui.label(tr_number(significant(value, 5)));
                    }
                    ui.end_row();
                }
            });
        ui.small(tr(
            "With play the relay acts as one with the hysteresis ε + β, so that the exact cycle is known too.",
        ));
    }
}
