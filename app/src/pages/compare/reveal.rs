//! The sealed truth of a mystery, and the model on screen beside it.

use egui::RichText;
use hysteron_core::effect::{EffectId, VISCOUS_FRICTION, name_of};
use hysteron_core::message::{Message, fixed};
use hysteron_core::msg;
use hysteron_core::mystery::{Answer, Compared, Mark, Reveal, Row};
use hysteron_core::uncertain::{quantity, with_error, written_like};

use super::command::Command;
use super::sealed::Sealed;
use super::state::Compare;
use super::waterfall::BASELINE;
use crate::hook::Targets;
use crate::jobs::Job;
use crate::language::tr;
use crate::motion;
use crate::theme;
use hysteron_work::tasks::RevealTask;

/// Width that the table of numbers needs, points; in a narrower window each is a line of its own.
const TABLE: f32 = 600.0;

impl Compare {
    /// The model on screen, with what the record cannot tell from its effects.
    fn answer_to_judge(&self) -> Option<Answer> {
        let (report, shown) = (self.report()?, self.shown.as_deref()?);
        let classes = report.verdict.iter().flat_map(|v| &v.missing);
        let classes: Vec<&Vec<EffectId>> = classes.collect();
        let alike = |effect: EffectId| {
            if let Some(class) = classes.iter().find(|class| class.contains(&effect)) {
                return (*class).clone();
            }
            // Without a verdict: what was said when the effect was added.
            let place = shown.iter().position(|e| *e == effect);
            let before = place.and_then(|n| self.reports.get(&shown[..n]));
            let candidates = before.iter().flat_map(|r| &r.step.candidates);
            let mut own = candidates.filter(|c| c.effects == [effect]);
            own.next()
                .map_or_else(Vec::new, |c| c.equivalent_to.clone())
        };
        let effects = report.step.effects.iter().copied();
        Some(Answer {
            effects: effects
                .filter(|e| *e != VISCOUS_FRICTION)
                .map(|e| (e, alike(e)))
                .collect(),
            parameters: report.step.parameters.clone(),
        })
    }

    /// Opens the seal with the word that was typed.
    pub(super) fn reveal(&mut self, ctx: &egui::Context) {
        let answer = self.answer_to_judge();
        if let (Some(sealed), Some(answer)) = (&mut self.sealed, answer) {
            sealed.message = None;
            let task = RevealTask {
                seal: sealed.seal.clone(),
                word: sealed.word.clone(),
                answer,
            };
            sealed.job = Some(Job::run(ctx, task));
        }
    }
}

pub(super) fn ui(
    page: &Compare,
    ui: &mut egui::Ui,
    targets: &mut Targets,
    commands: &mut Vec<Command>,
) {
    let Some(sealed) = &page.sealed else {
        return;
    };
    ui.add_space(6.0);
    if let Some((effects, reveal)) = &sealed.revealed {
        revealed_ui(page, sealed, effects, reveal, ui, targets, commands);
    } else {
        word_ui(page, sealed, ui, targets, commands);
    }
}

/// Asks for the word.
fn word_ui(
    page: &Compare,
    sealed: &Sealed,
    ui: &mut egui::Ui,
    targets: &mut Targets,
    commands: &mut Vec<Command>,
) {
    ui.label(tr(
        "The truth about this record is sealed inside it. Add what is missing until only noise is left; then enter \
         the password."));
    let (mut word, mut legible) = (sealed.word.clone(), sealed.legible);
    let asked = ui.horizontal_wrapped(|ui| {
        let label = ui.label(tr("Password"));
        let field = theme::line(&mut word)
            .password(!legible)
            .desired_width(220.0);
        let field = ui.add(field).labelled_by(label.id);
        targets.note("reveal:word", ui, &field);
        ui.checkbox(&mut legible, tr("Show the password"));
        let ready = !word.trim().is_empty() && sealed.job.is_none() && page.report().is_some();
        let reveal = ui.add_enabled(ready, egui::Button::new(tr("Reveal the truth")));
        targets.note("reveal", ui, &reveal);
        let entered = field.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
        if sealed.job.is_some() {
            motion::busy_ui(ui);
        }
        reveal.clicked() || ready && entered
    });
    if word != sealed.word || legible != sealed.legible {
        commands.push(Command::Word(word, legible));
    }
    // With the word as it is now.
    if asked.inner {
        commands.push(Command::Reveal);
    }
    if let Some(message) = &sealed.message {
        ui.colored_label(ui.visuals().warn_fg_color, tr(message));
    }
}

/// The truth beside the model with these effects.
fn revealed_ui(
    page: &Compare,
    sealed: &Sealed,
    effects: &[EffectId],
    reveal: &Reveal,
    ui: &mut egui::Ui,
    targets: &mut Targets,
    commands: &mut Vec<Command>,
) {
    let points = page.points().unwrap_or_default();
    theme::answer_ui(ui, msg!("{} of 100 points.", fixed(points, 0)));
    let cost = page.guess.cost();
    if cost > 0 {
        ui.label(tr(msg!("Hints have cost {} points so far.", cost)));
    }
    if Some(effects) != page.shown.as_deref() {
        ui.horizontal_wrapped(|ui| {
            ui.label(tr(
                "They are for the model that was on screen then; the model has changed since.",
            ));
            let ready = sealed.job.is_none() && page.report().is_some();
            let again = ui.add_enabled(ready, egui::Button::new(tr("Judge this one")));
            targets.note("reveal:again", ui, &again);
            if again.clicked() {
                commands.push(Command::Reveal);
            }
            if sealed.job.is_some() {
                motion::busy_ui(ui);
            }
        });
    }
    effects_ui(reveal, ui);
    numbers_ui(reveal, ui);
    rule_ui(reveal, ui);
}

fn effects_ui(reveal: &Reveal, ui: &mut egui::Ui) {
    ui.strong(tr("Effects"));
    if reveal.rows.is_empty() {
        ui.label(tr("Nothing was hidden, and nothing was added: right."));
    } else if reveal.truth.hidden.is_empty() {
        ui.label(tr("Nothing was hidden."));
    }
    for Row { effect, mark } in &reveal.rows {
        let name = name_of(*effect);
        let (color, text) = match mark {
            Mark::Right => (theme::NOISE, msg!("{}: found", name)),
            Mark::Alike(other) => (
                theme::NOISE,
                msg!(
                    "{}: found as {}, which this record cannot tell from it",
                    name,
                    name_of(*other)
                ),
            ),
            Mark::Missed => (theme::MODEL, msg!("{}: missed", name)),
            Mark::Wrong => (theme::MODEL, msg!("{}: wrong, it is not there", name)),
        };
        ui.label(RichText::new(tr(text)).color(theme::readable(ui, color)));
    }
}

fn numbers_ui(reveal: &Reveal, ui: &mut egui::Ui) {
    if reveal.numbers.is_empty() {
        return;
    }
    ui.add_space(8.0);
    ui.strong(tr("Numbers"));
    if ui.available_width() < TABLE {
        for number in &reveal.numbers {
            let [name, truth, found, error, marks] = cells(number);
            ui.strong(tr(name));
            ui.label(tr(msg!("Truth {}, your model {}.", truth, found)));
            let marks = msg!("Marks {}.", marks);
            ui.label(tr(if error.is_empty() {
                marks
            } else {
                msg!("Error {}.", error).and(marks)
            }));
        }
        return;
    }
    egui::Grid::new("truth_and_model")
        .num_columns(5)
        .striped(true)
        .show(ui, |ui| {
            for title in ["", "truth", "your model", "error", "marks"] {
                ui.small(tr(title));
            }
            ui.end_row();
            for number in &reveal.numbers {
                for (i, cell) in cells(number).into_iter().enumerate() {
                    let cell = ui.label(tr(cell));
                    if i == 0 && number.effect.is_none() {
                        cell.on_hover_text(tr(BASELINE));
                    }
                }
                ui.end_row();
            }
        });
}

/// Name, truth, value of the model, error and marks of a number.
fn cells(number: &Compared) -> [Message; 5] {
    let owner = number.effect.map_or("baseline", name_of);
    // The truth is written as what was found, so that their digits can be compared.
    let (truth, found): (Message, Message) = match number.found {
        Some((value, error)) => (
            written_like(number.truth, (value, error), &number.unit).into(),
            with_error(value, error, &number.unit),
        ),
        None => (
            quantity(number.truth, &number.unit).into(),
            "not in your model".into(),
        ),
    };
    // 0.0 rather than -0.0.
    let percent = number.error().map(|e| (1000.0 * e).round() / 10.0 + 0.0);
    [
        msg!("{} ({})", Message::name(&number.symbol), owner),
        truth,
        found,
        percent.map_or_else(Message::default, |p| format!("{p:+.1} %").into()),
        format!("{:.0} %", 100.0 * number.mark).into(),
    ]
}

fn rule_ui(reveal: &Reveal, ui: &mut egui::Ui) {
    let [effects, most_effects] = reveal.effect_points;
    let [numbers, most_numbers] = reveal.number_points;
    ui.add_space(8.0);
    ui.label(tr(msg!(
        "{} of {} points for the effects: the share of right ones among all that are hidden or were added.",
        fixed(effects, 0),
        fixed(most_effects, 0)
    )));
    ui.label(tr(msg!(
        "{} of {} points for the numbers: full marks within 5 % or two standard errors, none if they are a further 50 \
         % off.",
        fixed(numbers, 0),
        fixed(most_numbers, 0)
    )));
}
