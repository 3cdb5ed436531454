//! Models and gains as tables.

use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_core::tuning::measured::{
    FittedModel, Form, MeasuredTuning, Structure, TunedGains, Value,
};
use hysteron_core::uncertain::with_error;

use super::super::draw::{maybe, number, table};
use crate::language::{tr, tr_number};

/// What the models are, with two standard errors each.
pub fn models_ui(ui: &mut egui::Ui, tuning: &MeasuredTuning) {
    if tuning.models.is_empty() {
        return;
    }
    ui.add_space(6.0);
    ui.strong(tr("Models, with standard errors"));
    let heads = [
        "model",
        "gain",
        "lags [s]",
        "zero [s]",
        "dead time [s]",
        "missed [%]",
    ];
    table(ui, "measured models", &heads, |ui| {
        for model in &tuning.models {
            row_ui(ui, model);
        }
    });
    ui.small(tr(
        "Missed: the share of the output's motion that the model does not explain. A gain known no better than to \
         half its value is left out."));
}

/// Relative standard errors from which a gain, and any other value, is not told.
const VAGUE_GAIN: f64 = 0.5;
const VAGUE: f64 = 1.0;

fn told(value: &Value, vague: f64) -> Message {
    if value.std_error < vague * value.value.abs() {
        with_error(value.value, value.std_error, "1")
    } else {
        "-".into()
    }
}

fn row_ui(ui: &mut egui::Ui, model: &FittedModel) {
    let name = structure_name(model.structure);
    if model.preferred {
        ui.strong(tr(name));
    } else {
        ui.label(tr(name));
    }
    ui.label(tr(told(&model.gain, VAGUE_GAIN)));
    let lags: Vec<String> = model
        .time_constants
        .iter()
        .map(|t| tr(told(t, VAGUE)))
        .collect();
    ui.label(lags.join("; "));
    ui.label(tr(model
        .zero
        .as_ref()
        .map_or_else(|| "-".into(), |z| told(z, VAGUE))));
    ui.label(tr(told(&model.dead_time, VAGUE)));
    ui.label(tr_number(format!("{:.2}", 100.0 * model.left)));
    ui.end_row();
}

fn structure_name(structure: Structure) -> &'static str {
    match structure {
        Structure::Fopdt => "lag and dead time",
        Structure::Sopdt => "two lags and dead time",
        Structure::SopdtZero => "two lags, zero, dead time",
        Structure::Topdt => "three lags and dead time",
        Structure::Integrator => "integrator and dead time",
        Structure::IntegratorLag => "integrator, lag, dead time",
    }
}

/// What follows for a controller; a click shows its steps.
pub fn gains_ui(ui: &mut egui::Ui, tuning: &MeasuredTuning, chosen: &mut Option<String>) {
    let Some(first) = tuning.gains.first() else {
        return;
    };
    ui.add_space(6.0);
    ui.strong(tr(msg!("Gains, {} form", form_name(first.form))));
    let mut heads = vec!["rule", "kp", "ki [1/s]", "kd [s]"];
    if matches!(first.form, Form::Ideal | Form::Series) {
        heads = vec!["rule", "kp", "ti [s]", "td [s]"];
    }
    heads.extend(["phase margin [°]", "gain margin", "Ms"]);
    table(ui, "measured gains", &heads, |ui| {
        for gains in &tuning.gains {
            gains_row_ui(ui, gains, !tuning.models.is_empty(), chosen);
        }
    });
    if tuning.models.is_empty() {
        ui.small(tr(
            "Without a record there is no model to compute margins on.",
        ));
    } else {
        ui.small(tr(
            "Margins of the loop with the preferred model. Click a rule to see its steps.",
        ));
    }
}

fn gains_row_ui(ui: &mut egui::Ui, gains: &TunedGains, model: bool, chosen: &mut Option<String>) {
    let key = key(gains);
    let controller = gains.controller.to_uppercase();
    let name = Message::words(format!("{} {controller}", gains.name));
    if ui
        .selectable_label(chosen.as_ref() == Some(&key), tr(name))
        .clicked()
    {
        *chosen = Some(key);
    }
    ui.label(tr_number(number(gains.kp)));
    if matches!(gains.form, Form::Ideal | Form::Series) {
        ui.label(tr(maybe(gains.ti, "-")));
        ui.label(tr_number(number(gains.td)));
    } else {
        ui.label(tr_number(number(gains.ki)));
        ui.label(tr_number(number(gains.kd)));
    }
    if model && !gains.stable {
        ui.label(tr("unstable"));
        ui.end_row();
        return;
    }
    let phase = gains.phase_margin_deg.map(|p| tr_number(format!("{p:.0}")));
    ui.label(phase.unwrap_or_else(|| "-".to_owned()));
    ui.label(tr(maybe(gains.gain_margin, "-")));
    ui.label(tr(maybe(gains.max_sensitivity, "-")));
    ui.end_row();
}

/// How a choice among gains is called.
pub fn key(gains: &TunedGains) -> String {
    format!("{} {}", gains.rule, gains.controller)
}

/// A form in a list.
pub fn form_name(form: Form) -> &'static str {
    match form {
        Form::Parallel => "parallel",
        Form::Ideal => "ideal",
        Form::Series => "series",
        Form::Klipper => "Klipper",
        Form::Marlin => "Marlin",
        Form::Esphome => "ESPHome",
    }
}
