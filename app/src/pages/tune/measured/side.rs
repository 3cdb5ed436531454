//! The panel beside: where the test comes from, and what is wanted of it.

use hysteron_core::msg;
use hysteron_core::tuning::measured::{AmplitudeConvention, Form};

use super::tables::form_name;
use super::{BUILT_IN, From, Measured};
use crate::desk::Desk;
use crate::files::{Held, TEST};
use crate::language::tr;
use crate::recent::measurement;
use crate::widgets::typed::Typed;

/// Lines of the field for pasted text.
const LINES: usize = 4;

/// Decimals and largest size of a number that was read off a test.
const DECIMALS: usize = 4;
const LARGEST: f64 = 1e9;

impl Measured {
    /// Which test: simulated, recorded, or only its numbers.
    pub fn source_ui(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        ui.horizontal_wrapped(|ui| {
            for (from, name, hint) in [
                (
                    From::Simulation,
                    "Simulated",
                    "The page runs the test on the plant of Explore",
                ),
                (
                    From::Record,
                    "Measured",
                    "A record of a relay test, or the log of an auto-tuner",
                ),
                (
                    From::Numbers,
                    "Only numbers",
                    "Amplitude, period, levels and hysteresis, as read off a test",
                ),
            ] {
                let button = ui
                    .selectable_label(self.from == from, tr(name))
                    .on_hover_text(tr(hint));
                desk.targets.note(format!("from:{name}"), ui, &button);
                if button.clicked() {
                    self.from = from;
                }
            }
        });
    }

    pub fn side_ui(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        match self.from {
            From::Record => self.files_ui(ui, desk),
            _ => self.numbers_ui(ui),
        }
        ui.separator();
        self.wishes_ui(ui);
    }

    fn files_ui(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        if let Some(file) = &self.file {
            ui.strong(&file.name);
        }
        ui.horizontal_wrapped(|ui| {
            if ui
                .button(tr("Open a file ..."))
                .on_hover_text(tr(
                    "Or drop it on this window: a table with time, input and output, or a log of Klipper, Marlin, \
                     ESPHome, Mycodo or Home Assistant",
                ))
                .clicked()
            {
                self.files.entrance.open_dialog(ui.ctx(), TEST);
            }
            let button = ui
                .button(tr(msg!("Open {}", BUILT_IN.id)))
                .on_hover_text(tr("A relay test on a rig: a lag with a dead time."));
            desk.targets.note(format!("test:{}", BUILT_IN.id), ui, &button);
            if button.clicked() {
                self.open(Held::from(&BUILT_IN));
            }
        });
        if let Some(recent) = desk.recent.ui(ui, measurement, &mut desk.targets) {
            self.files.entrance.reopen(ui.ctx(), &recent);
        }
        let label = ui.label(tr("Or paste a log or a table:"));
        ui.add(
            egui::TextEdit::multiline(&mut self.pasted)
                .desired_rows(LINES)
                .desired_width(f32::INFINITY)
                .code_editor(),
        )
        .labelled_by(label.id);
        let some = !self.pasted.trim().is_empty();
        if ui
            .add_enabled(some, egui::Button::new(tr("Read it")))
            .clicked()
        {
            self.open_pasted();
        }
    }

    fn numbers_ui(&mut self, ui: &mut egui::Ui) {
        let readings = &mut self.readings;
        let half = readings.convention == AmplitudeConvention::Half;
        egui::Grid::new("readings").num_columns(2).show(ui, |ui| {
            number_ui(ui, "amplitude", &mut readings.amplitude, "");
            ui.label("");
            ui.vertical(|ui| {
                if ui.radio(half, tr("half of peak to peak")).clicked() {
                    readings.convention = AmplitudeConvention::Half;
                }
                if ui.radio(!half, tr("peak to peak")).clicked() {
                    readings.convention = AmplitudeConvention::PeakToPeak;
                }
            });
            ui.end_row();
            if let Some([up, down]) = &mut readings.half_periods {
                number_ui(ui, "time up [s]", up, "s");
                number_ui(ui, "time down [s]", down, "s");
                readings.period = *up + *down;
            } else {
                number_ui(ui, "period [s]", &mut readings.period, "s");
            }
            number_ui(ui, "input while down", &mut readings.levels[0], "");
            number_ui(ui, "input while up", &mut readings.levels[1], "");
            number_ui(ui, "hysteresis", &mut readings.hysteresis, "");
        });
        let mut differ = readings.half_periods.is_some();
        if ui
            .checkbox(&mut differ, tr("it is up longer than down, or shorter"))
            .changed()
        {
            readings.half_periods = differ.then_some([0.5 * readings.period; 2]);
        }
        ui.small(tr("The hysteresis is half the distance between the outputs at which the relay switches. Tuners \
                     differ in what they call amplitude: two widely used ones arrive at an ultimate gain twice as \
                     large as it should be."));
    }

    fn wishes_ui(&mut self, ui: &mut egui::Ui) {
        ui.strong(tr("Gains"));
        let name = |form: Option<Form>| form.map_or("as the source has it", form_name);
        let chosen = &mut self.wishes.form;
        egui::ComboBox::from_label(tr("form"))
            .selected_text(tr(name(*chosen)))
            .width(200.0)
            .show_ui(ui, |ui| {
                let all = std::iter::once(None).chain(Form::ALL.map(Some));
                for form in all {
                    ui.selectable_value(chosen, form, tr(name(form)));
                }
            });
        ui.small(tr(form_words(chosen.unwrap_or_default())));
        optional_ui(
            ui,
            "full scale of the input",
            &mut self.wishes.full_scale,
            255.0,
        );
        optional_ui(ui, "set point of the test", &mut self.wishes.target, 0.0);
    }
}

/// A number with its name.
fn number_ui(ui: &mut egui::Ui, name: &'static str, value: &mut f64, unit: &str) {
    let label = ui.label(tr(name));
    let speed = 0.01 * value.abs().max(0.01);
    let field = Typed::new(*value, unit, -LARGEST..=LARGEST, DECIMALS);
    let field = field.field(ui.ctx(), value).speed(speed);
    ui.add(field).labelled_by(label.id);
    ui.end_row();
}

/// A number that may be left to the page.
fn optional_ui(ui: &mut egui::Ui, name: &'static str, value: &mut Option<f64>, normal: f64) {
    ui.horizontal(|ui| {
        let mut given = value.is_some();
        if ui.checkbox(&mut given, tr(name)).changed() {
            *value = given.then_some(normal);
        }
        if let Some(value) = value {
            let field = Typed::new(*value, "", -LARGEST..=LARGEST, DECIMALS);
            ui.add(field.field(ui.ctx(), value));
        }
    });
}

/// What a form is.
fn form_words(form: Form) -> &'static str {
    match form {
        Form::Parallel => "kp + ki/s + kd s, in the units of the record",
        Form::Ideal => "kp (1 + 1/(ti s) + td s), in the units of the record",
        Form::Series => "kp (1 + 1/(ti s)) (1 + td s), in the units of the record",
        Form::Klipper => "pid_Kp, pid_Ki and pid_Kd: parallel, the output from 0 to 255",
        Form::Marlin => "P, I and D of M301: parallel, the output from 0 to 255",
        Form::Esphome => "kp, ki and kd of a climate: parallel, the output up to 1",
    }
}
