//! Which effect is hidden? A bench that makes a measurement whose truth is sealed.

mod choices;
mod machines;
mod made;
mod picture;

use hysteron_core::effect::EffectId;
use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_core::mystery::{Choice, Experiment, Pick, Request, SHORTEST_WORD};
use hysteron_core::report::sha256;
use serde::{Deserialize, Serialize};
use web_time::SystemTime;

use crate::command::Command;
use crate::desk::Desk;
use crate::export::Table;
use crate::jobs::{Job, ended};
use crate::language::tr;
use crate::layout;
use crate::motion;
use crate::page::{Hint, Offer, Page, Settable, View};
use crate::theme;

use hysteron_work::tasks::MysteryTask;
use machines::MACHINES;
use made::{Asked, Product};

/// The page. What is chosen and the word are no settings: a link of this page tells neither.
#[derive(Default)]
pub struct Bench {
    experiment: Experiment,
    /// Whether the page chooses what to hide, or the teacher.
    by_hand: bool,
    /// What the teacher chose on each machine, in the order of the menu. Undo goes from one machine to the other,
    /// and an effect of both has another range on each.
    picks: [Vec<Pick>; MACHINES.len()],
    word: String,
    /// Whether the word can be read: a class may look on.
    legible: bool,
    job: Option<Job<MysteryTask>>,
    /// What the mystery that is being made was asked to be.
    asked: Option<Asked>,
    message: Option<Message>,
    made: Option<Product>,
    /// Mysteries that were made since the app started.
    count: u32,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// What is measured, and how.
    experiment: Experiment,
    /// Whether the teacher chooses what to hide.
    by_hand: bool,
}

impl Bench {
    /// Why nothing can be made now.
    fn obstacle(&self) -> Option<Message> {
        let letters = self.word.trim().chars().count();
        (letters < SHORTEST_WORD)
            .then(|| msg!("The password needs at least {} characters.", SHORTEST_WORD))
    }

    fn make(&mut self, ctx: &egui::Context) {
        self.message = None;
        self.count += 1;
        let (experiment, choice) = self.chosen();
        self.asked = Some((experiment, choice.clone()));
        let request = Request {
            experiment,
            choice,
            word: self.word.clone(),
            salt: salt(self.count),
        };
        self.job = Some(Job::run(ctx, MysteryTask(request)));
    }

    /// What a mystery that is made now is asked to be.
    fn chosen(&self) -> Asked {
        let choice = if self.by_hand {
            Choice::Chosen(self.picks().clone())
        } else {
            Choice::Surprise
        };
        (self.experiment, choice)
    }

    fn pick(&self, effect: EffectId) -> Option<&Pick> {
        self.picks().iter().find(|p| p.effect == effect)
    }

    /// Place of what is measured among the machines.
    fn machine(&self) -> usize {
        let kind = self.experiment.kind();
        MACHINES.iter().position(|m| m.0 == kind).unwrap_or(0)
    }

    fn picks(&self) -> &Vec<Pick> {
        &self.picks[self.machine()]
    }

    fn picks_mut(&mut self) -> &mut Vec<Pick> {
        let machine = self.machine();
        &mut self.picks[machine]
    }

    fn page_ui(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        theme::answer_ui(ui, "Which effect is hidden?");
        ui.label(tr(
            "The bench hides physics in a drive or a process and records it. The truth travels with the record, \
             sealed with your password: solve the mystery, then reveal it."));
        ui.add_space(6.0);
        if self.made.is_none() {
            picture::ui(ui, self.experiment);
            ui.add_space(10.0);
        }
        if ui.available_width() < layout::NARROW {
            self.teacher_ui(ui, desk);
            self.record_ui(ui, desk);
        } else {
            ui.columns_const(|[left, right]| {
                left.vertical(|ui| self.teacher_ui(ui, desk));
                right.vertical(|ui| self.record_ui(ui, desk));
            });
        }
    }

    /// What to hide, and in what.
    fn teacher_ui(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        self.choices_ui(ui, desk);
        ui.add_space(10.0);
        self.make_ui(ui, desk);
        ui.add_space(6.0);
    }

    /// What came of it, and what a student does with it.
    fn record_ui(&self, ui: &mut egui::Ui, desk: &mut Desk) {
        if let Some(made) = &self.made {
            let changed = made.asked.as_ref() != Some(&self.chosen());
            made::ui(made, changed, ui, desk);
            ui.add_space(6.0);
        }
        student_ui(ui, desk);
    }

    fn make_ui(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        ui.heading(tr("3. Your password seals it"));
        ui.horizontal_wrapped(|ui| {
            let label = ui.label(tr("Password"));
            let field = theme::line(&mut self.word)
                .password(!self.legible)
                .desired_width(240.0)
                .hint_text(tr("a few words are better than one"));
            let word = ui.add(field).labelled_by(label.id).on_hover_text(tr(
                "Anyone who has it can reveal the truth; without it nobody can, not even you",
            ));
            desk.targets.note("mystery:word", ui, &word);
            ui.checkbox(&mut self.legible, tr("Show the password"));
            ui.end_row();
            let obstacle = self.obstacle();
            let ready = obstacle.is_none() && self.job.is_none();
            let make = ui.add_enabled(ready, egui::Button::new(tr("Make the mystery")));
            desk.targets.note("mystery:make", ui, &make);
            let entered = word.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
            if make.clicked() || ready && entered {
                self.make(ui.ctx());
            }
            if self.job.is_some() {
                motion::busy_ui(ui);
                ui.label(tr("The bench is running ..."));
                if ui.button(tr("Cancel")).clicked() {
                    self.job = None;
                }
            } else if let Some(obstacle) = obstacle {
                ui.label(tr(obstacle));
            }
        });
        if let Some(message) = &self.message {
            ui.colored_label(ui.visuals().warn_fg_color, tr(message));
        }
    }
}

/// What a student does.
fn student_ui(ui: &mut egui::Ui, desk: &mut Desk) {
    egui::Frame::group(ui.style()).show(ui, |ui| {
        ui.set_width(ui.available_width());
        ui.heading(tr("Were you given a mystery?"));
        ui.label(tr(
            "Open its link, or drop its file on this window. Compare opens: add what is missing until only noise is \
             left. Then enter the password under Reveal: it shows the truth beside your model, with points for the \
             effects and for the numbers."));
        let go = ui.button(tr("Go to Compare"));
        desk.targets.note("mystery:student", ui, &go);
        if go.clicked() {
            desk.commands.push(Command::Go("compare"));
        }
    });
}

/// Bytes that were not used before: from the clock and the number of the mystery. They are no secret.
fn salt(count: u32) -> [u8; hysteron_core::mystery::SALT] {
    let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
    let nanos = now.map_or(0, |t| t.as_nanos());
    let digest = sha256(format!("{nanos} {count}").as_bytes());
    let mut salt = [0; hysteron_core::mystery::SALT];
    for (place, byte) in salt.iter_mut().zip(digest.bytes()) {
        *place = byte;
    }
    salt
}

/// The page as the registry has it.
pub fn page() -> Page {
    Page::new("mystery", "Mystery", Bench::default())
}

impl View for Bench {
    fn update(&mut self, _ctx: &egui::Context) {
        match ended(&mut self.job, |_, _| ()) {
            Some(Ok(made)) => self.made = Some(Product::of(made, self.asked.take())),
            Some(Err(text)) => self.message = Some(text),
            None => {}
        }
    }

    fn ui(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        egui::CentralPanel::default().show(ui, |ui| {
            theme::scroll("mystery").show(ui, |ui| self.page_ui(ui, desk));
        });
    }

    fn hook_state(&self) -> serde_json::Value {
        serde_json::json!({
            "busy": self.job.is_some(),
            "made": self.made.as_ref().map(|m| m.name.clone()),
            "message": self.message,
        })
    }

    fn offer(&self) -> Offer<'_> {
        Offer::new(self.hint(), self.table_names(), || self.tables())
    }
}

impl Settable for Bench {
    type Settings = Settings;

    fn set_to(&self) -> Settings {
        Settings {
            experiment: self.experiment,
            by_hand: self.by_hand,
        }
    }

    fn take(
        &mut self,
        _ctx: &egui::Context,
        settings: Settings,
        _desk: &Desk,
    ) -> Result<(), Message> {
        self.experiment = settings.experiment;
        self.by_hand = settings.by_hand;
        Ok(())
    }
}

impl Bench {
    /// What to try next.
    fn hint(&self) -> Hint {
        if self.made.is_some() {
            return Hint::say("Share the file or link. Solvers need your password.");
        }
        Hint::open(
            "Never looked for a hidden effect? Begin with a drive that loses momentum.",
            "v1;compare;compare.file=drive-02",
        )
    }

    /// Names of the tables that can be given now.
    fn table_names(&self) -> Vec<&'static str> {
        self.made.iter().map(|_| "mystery").collect()
    }

    /// The numbers behind what is shown.
    fn tables(&self) -> Vec<Table> {
        self.made.iter().map(made::table).collect()
    }
}
