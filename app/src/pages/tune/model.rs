//! Step 4: a model from one asymmetric relay test.

use hysteron_core::message::{Message, fixed};
use hysteron_core::msg;
use hysteron_core::tuning::{AsymmetricTest, Model, TuningError};

use super::draw::{beside, number, run_ui, table};
use super::stage::{Seen, Stage};
use crate::language::tr;

pub const STAGE: Stage = Stage {
    id: "model",
    title: "Asymmetric test",
    question: "What does one test reveal if the relay pushes harder one way?",
    answer,
    next: "A rule turns it into a controller: step 5.",
    plot,
    ui,
};

fn answer(seen: Seen<'_>) -> Message {
    match &seen.report.asymmetric {
        Ok(AsymmetricTest {
            berner: Ok(model), ..
        }) => msg!("A model: {}.", words(model)),
        Ok(AsymmetricTest {
            berner: Err(error), ..
        })
        | Err(error) => msg!("No model: {}.", error),
    }
}

fn words(model: &Model) -> Message {
    match *model {
        Model::Lag {
            gain,
            time_constant,
            dead_time,
        } => msg!(
            "gain {}, lag {} s, dead time {} s",
            number(gain),
            number(time_constant),
            number(dead_time)
        ),
        Model::Integrating { gain, dead_time } => msg!(
            "an integrator, gain {} 1/s, dead time {} s",
            number(gain),
            number(dead_time)
        ),
    }
}

fn ui(ui: &mut egui::Ui, seen: Seen<'_>, height: f32, _rule: &mut String) {
    let Ok(found) = &seen.report.asymmetric else {
        ui.label(tr(
            "Give the relay some asymmetry: then the plant's input has a mean, which reveals the static gain."));
        return;
    };
    ui.label(tr(msg!(
        "The input now has a mean, which reveals the static gain; the half periods of {} s and {} s have the ratio \
         {}, which reveals how much of the lag is dead time: {} %.",
        number(found.test.on_time),
        number(found.test.off_time),
        number(found.half_period_ratio),
        fixed(100.0 * found.normalised_dead_time, 0)
    )));
    beside(
        ui,
        height,
        |ui, height| {
            if !seen.pinned {
                plot(ui, seen, height);
            }
        },
        |ui, _| table_ui(ui, found),
    );
}

fn plot(ui: &mut egui::Ui, seen: Seen<'_>, height: f32) {
    if let Ok(found) = &seen.report.asymmetric {
        run_ui(ui, "asymmetric run", &found.test, height);
    }
}

fn table_ui(ui: &mut egui::Ui, found: &AsymmetricTest) {
    table(
        ui,
        "models",
        &["", "gain", "lag [s]", "dead time [s]"],
        |ui| {
            row_ui(ui, "Berner et al. 2016", &found.berner);
            row_ui(ui, "Shen et al. 1996", &found.shen);
        },
    );
    for failed in [&found.berner, &found.shen] {
        if let Err(error) = failed {
            ui.small(tr(Message::from(error)));
        }
    }
    ui.small(tr(
        "Berner, Hägglund and Åström: from the half periods. Shen, Wu and Yu: through the points of the Nyquist \
         curve at 0 and at ω."));
    let point = &found.point;
    ui.label(tr(msg!(
        "Point of the Nyquist curve at ω = {} rad/s: {} {} j.",
        number(point.omega),
        number(point.value[0]),
        msg!(
            "{} {}",
            if point.value[1] < 0.0 { "-" } else { "+" },
            number(point.value[1].abs())
        )
    )));
    if let Some(gain) = found.static_gain {
        ui.label(tr(msg!("Static gain: {}.", number(gain))));
    }
}

fn row_ui(ui: &mut egui::Ui, name: &'static str, model: &Result<Model, TuningError>) {
    ui.label(tr(name));
    let cells: [Message; 3] = match model {
        Ok(Model::Lag {
            gain,
            time_constant,
            dead_time,
        }) => [gain, time_constant, dead_time].map(|value| number(*value).into()),
        Ok(Model::Integrating { gain, dead_time }) => [
            format!("{} 1/s", number(*gain)).into(),
            "integrator".into(),
            number(*dead_time).into(),
        ],
        Err(_) => ["none".into(), Message::default(), Message::default()],
    };
    for cell in cells {
        ui.label(tr(cell));
    }
    ui.end_row();
}
