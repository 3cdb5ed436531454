//! The experiment, and what to hide.

use egui::Ui;
use hysteron_core::effect::find;
use hysteron_core::measurement::Kind;
use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_core::mystery::{Experiment, Hideable, Pick, Strength, hideable};

use super::Bench;
use super::machines::MACHINES;
use crate::desk::Desk;
use crate::language::tr;
use crate::widgets::typed::{DECIMALS, Typed};

/// Name and story of an experiment.
fn words(experiment: Experiment) -> (&'static str, &'static str) {
    match experiment {
        Experiment::Sines => (
            "Sum of sines",
            "Ten sines from 1 to 40 Hz: shows most effects.",
        ),
        Experiment::Relay => (
            "Relay",
            "A relay on the velocity: shows what acts late and what pushes to one side.",
        ),
        Experiment::Stairs => (
            "Staircase",
            "Steps of growing size in both directions: tells offsets from asymmetry.",
        ),
        Experiment::Drifting => (
            "Drifting relay",
            "A relay whose levels differ, so that the motor drifts to and fro: shows a gap behind it. Backlash \
             measures that at once, Compare looks for it for minutes.",
        ),
        Experiment::ProcessBinary => (
            "Two levels",
            "Two levels, held for random times: shows what acts late.",
        ),
        Experiment::ProcessRelay => (
            "Relay",
            "A relay on the output: shows what acts late and what drifts.",
        ),
        Experiment::ProcessStairs => (
            "Staircase",
            "Levels of several sizes and both signs: tells offsets from asymmetry, and shows what is bent or cut off.",
        ),
    }
}

const fn strength_name(strength: Strength) -> &'static str {
    match strength {
        Strength::Small => "small",
        Strength::Medium => "medium",
        Strength::Large => "large",
    }
}

/// A unit that is handy to type in, and how many of it are one of the SI unit.
fn handy(unit: &'static str) -> (f64, &'static str) {
    match unit {
        "s" => (1e3, "ms"),
        "N m" => (1e3, "mN m"),
        "rad" => (1e3, "mrad"),
        "1" => (1e2, "%"),
        "1/s" => (6e3, "%/min"),
        "N m s^2/rad^2" => (1e6, "µN m s²/rad²"),
        other => (1.0, other),
    }
}

impl Bench {
    pub(super) fn choices_ui(&mut self, ui: &mut Ui, desk: &mut Desk) {
        ui.heading(tr("1. What is measured, and how?"));
        ui.horizontal_wrapped(|ui| {
            for (kind, id, name) in MACHINES {
                let radio = ui.radio(self.experiment.kind() == kind, tr(name));
                desk.targets.note(format!("mystery:{id}"), ui, &radio);
                if radio.clicked() {
                    self.measure(kind);
                }
            }
        });
        ui.horizontal_wrapped(|ui| {
            for &experiment in Experiment::of(self.experiment.kind()) {
                let (name, story) = words(experiment);
                ui.selectable_value(&mut self.experiment, experiment, tr(name))
                    .on_hover_text(tr(story));
            }
        });
        ui.label(tr(words(self.experiment).1));
        ui.add_space(10.0);
        ui.heading(tr("2. What is hidden in it?"));
        ui.horizontal_wrapped(|ui| {
            for (by_hand, id, name) in [
                (false, "surprise", "Surprise me: none, one or two effects"),
                (true, "choose", "I choose"),
            ] {
                let radio = ui.radio_value(&mut self.by_hand, by_hand, tr(name));
                desk.targets.note(format!("mystery:{id}"), ui, &radio);
            }
        });
        if self.by_hand {
            self.menu_ui(ui, desk);
        } else {
            ui.label(tr(self.surprise()));
        }
    }

    /// Goes to the first experiment on such a system, unless it is one; what was picked stays behind.
    fn measure(&mut self, kind: Kind) {
        let first = Experiment::of(kind).first().copied();
        if let Some(first) = first.filter(|_| self.experiment.kind() != kind) {
            self.experiment = first;
        }
    }

    /// Everything that can be hidden in what is measured.
    fn menu(&self) -> &'static [Hideable] {
        hideable(self.experiment.kind())
    }

    /// What the page may choose, in words.
    fn surprise(&self) -> Message {
        let shown = |h: &&Hideable| h.shown_by.contains(&self.experiment);
        let names = self.menu().iter().filter(shown).map(Hideable::name);
        msg!(
            "It may hide: {}. One mystery in five hides nothing, half hide one effect, and the rest two of different \
             kinds, anywhere from small to large.",
            Message::list(", ", names)
        )
    }

    /// The menu of effects; those that this experiment shows stand first.
    fn menu_ui(&mut self, ui: &mut Ui, desk: &mut Desk) {
        let shown = |h: &&Hideable| h.shown_by.contains(&self.experiment);
        let (shown, others): (Vec<&Hideable>, Vec<_>) = self.menu().iter().partition(shown);
        for effect in shown {
            self.effect_ui(ui, effect, desk);
        }
        let count = others.iter().filter(|h| self.pick(h.id).is_some()).count();
        let title = match count {
            0 => "Effects that this experiment hardly shows".into(),
            n => msg!("Effects that this experiment hardly shows ({} chosen)", n),
        };
        egui::CollapsingHeader::new(tr(title))
            .id_salt("hardly_shown")
            .show(ui, |ui| {
                for effect in others {
                    self.effect_ui(ui, effect, desk);
                }
            });
        if self.picks().is_empty() {
            ui.label(tr("Nothing is chosen: then nothing is missing, and that is for your students to find out."));
        }
    }

    fn effect_ui(&mut self, ui: &mut Ui, effect: &'static Hideable, desk: &mut Desk) {
        let name = effect.name();
        let mut chosen = self.pick(effect.id).is_some();
        let other = self
            .menu()
            .iter()
            .find(|o| o.id != effect.id && !o.goes_with(effect) && self.pick(o.id).is_some());
        ui.horizontal_wrapped(|ui| {
            let full = self.picks().len() >= MOST && !chosen;
            let tick = ui.add_enabled(
                other.is_none() && !full,
                egui::Checkbox::new(&mut chosen, tr(name)),
            );
            // Its name alone may say nothing yet.
            let tick = match find(effect.id) {
                Some(named) => tick.on_hover_text(tr(named.sentence())),
                None => tick,
            };
            desk.targets
                .note(format!("mystery:hide:{}", effect.id), ui, &tick);
            if let Some(other) = other {
                tick.on_disabled_hover_text(tr(msg!("Not together with {}", other.name())));
            } else if tick.changed() {
                self.picks_mut().retain(|p| p.effect != effect.id);
                if chosen {
                    self.picks_mut().push(Pick {
                        effect: effect.id,
                        value: effect.value(Strength::default()),
                    });
                }
            }
            if let Some(pick) = self.picks_mut().iter_mut().find(|p| p.effect == effect.id) {
                strength_ui(ui, effect, &mut pick.value);
            }
        });
    }
}

/// Most effects that can be ticked.
const MOST: usize = 3;

fn strength_ui(ui: &mut Ui, effect: &Hideable, value: &mut f64) {
    for strength in Strength::ALL {
        let at = effect.value(strength);
        let button = ui
            .selectable_label(*value == at, tr(strength_name(strength)))
            .on_hover_text(tr(msg!("{}: {}", effect.name(), strength_name(strength))));
        if button.clicked() {
            *value = at;
        }
    }
    let (symbol, label, unit) = effect.parameter();
    let (scale, unit) = handy(unit);
    let [least, most] = effect.range;
    let mut shown = *value * scale;
    let text = ui.label(format!("{} {symbol}", tr(label)));
    let field = Typed::new(shown, unit, least * scale..=most * scale, DECIMALS)
        .field(ui.ctx(), &mut shown)
        .speed(0.002 * most * scale)
        .suffix(format!(" {unit}"));
    if ui.add(field).labelled_by(text.id).changed() {
        *value = shown / scale;
    }
}
