//! A relay loop, live: what is predicted beside what happens.

use egui_plot::{HLine, Legend, Line, LineStyle, MarkerShape, Plot, PlotPoints, Points};
use hysteron_core::explore::{ExploreData, ExploreInput, compute};
use hysteron_core::limit_cycle::Cycle;
use hysteron_core::plant::presets;
use hysteron_core::relay::Relay;

use super::{Desk, View};
use crate::theme;

/// The page: what is set, and what follows from it.
#[derive(Default)]
pub struct Explore {
    preset: usize,
    input: ExploreInput,
    /// Result for the input beside it.
    computed: Option<(ExploreInput, Result<ExploreData, String>)>,
}

impl Explore {
    /// Computes anew if something was changed.
    fn update(&mut self) {
        if self
            .computed
            .as_ref()
            .is_none_or(|(input, _)| *input != self.input)
        {
            let result = compute(&self.input).map_err(|e| e.to_string());
            self.computed = Some((self.input.clone(), result));
        }
    }

    fn controls_ui(&mut self, ui: &mut egui::Ui) {
        ui.add_space(4.0);
        let all = presets();
        egui::ComboBox::from_label("plant")
            .selected_text(all.get(self.preset).map_or("", |p| p.name))
            .width(220.0)
            .show_ui(ui, |ui| {
                for (index, preset) in all.iter().enumerate() {
                    if ui
                        .selectable_label(self.preset == index, preset.name)
                        .clicked()
                    {
                        self.preset = index;
                        self.input.plant = preset.plant.clone();
                    }
                }
            });
        if let Some(preset) = all.get(self.preset) {
            ui.small(preset.sentence);
        }
        ui.monospace(formula(&self.input));
        ui.separator();
        ui.strong("Relay");
        let relay = &mut self.input.relay;
        let normal = Relay::default();
        slider_ui(
            ui,
            &mut relay.gain,
            0.1..=5.0,
            normal.gain,
            "gain k",
            "How strongly the relay pushes",
        );
        slider_ui(
            ui,
            &mut relay.hysteresis,
            0.0..=1.0,
            normal.hysteresis,
            "hysteresis ε",
            "How far the output must pass zero before the relay switches",
        );
        slider_ui(
            ui,
            &mut relay.asymmetry,
            -0.6..=0.6,
            normal.asymmetry,
            "asymmetry a",
            "How much stronger it pushes up than down",
        );
        slider_ui(
            ui,
            &mut relay.delay,
            0.0..=2.0,
            normal.delay,
            "delay [s]",
            "How late the switch takes effect",
        );
        ui.small("Double-click a slider to reset it.");
    }

    fn results_ui(&self, ui: &mut egui::Ui, height: f32) {
        match &self.computed {
            Some((input, Ok(data))) => {
                theme::answer_ui(ui, &data.text);
                ui.label("Try more hysteresis: what happens to period and amplitude?");
                let narrow = ui.available_width() < 600.0;
                if narrow {
                    nyquist_plot(ui, data, height);
                    time_plot(ui, input, data, height);
                    phase_plot(ui, data, height);
                    table_ui(ui, data);
                } else {
                    ui.columns(2, |columns| {
                        nyquist_plot(&mut columns[0], data, height - 12.0);
                        phase_plot(&mut columns[1], data, height - 12.0);
                    });
                    time_plot(ui, input, data, height - 12.0);
                }
            }
            Some((_, Err(error))) => {
                ui.colored_label(ui.visuals().warn_fg_color, error);
            }
            None => {}
        }
    }
}

impl View for Explore {
    fn id(&self) -> &'static str {
        "explore"
    }

    fn title(&self) -> &'static str {
        "Explore a relay loop"
    }

    fn hook_state(&self) -> serde_json::Value {
        serde_json::json!({"busy": false})
    }

    fn ui(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        self.input.clone_from(&desk.relay_loop);
        self.page_ui(ui);
        desk.relay_loop.clone_from(&self.input);
    }
}

impl Explore {
    fn page_ui(&mut self, ui: &mut egui::Ui) {
        let narrow = ui.available_width() < 700.0;
        if narrow {
            egui::CentralPanel::default().show(ui, |ui| {
                egui::ScrollArea::vertical().show(ui, |ui| {
                    self.controls_ui(ui);
                    self.update();
                    self.results_ui(ui, 260.0);
                });
            });
            return;
        }
        egui::Panel::left("loop")
            .default_size(350.0)
            .resizable(false)
            .show(ui, |ui| {
                egui::ScrollArea::vertical().show(ui, |ui| {
                    self.controls_ui(ui);
                    self.update();
                    if let Some((_, Ok(data))) = &self.computed {
                        ui.separator();
                        table_ui(ui, data);
                    }
                    equations_ui(ui);
                });
            });
        egui::CentralPanel::default().show(ui, |ui| {
            self.update();
            let height = ((ui.available_height() - 60.0) / 2.0).max(160.0);
            self.results_ui(ui, height);
        });
    }
}

fn slider_ui(
    ui: &mut egui::Ui,
    value: &mut f64,
    range: std::ops::RangeInclusive<f64>,
    normal: f64,
    label: &str,
    explanation: &str,
) {
    let slider = ui.add(egui::Slider::new(value, range).text(label).max_decimals(3));
    if slider.on_hover_text(explanation).double_clicked() {
        *value = normal;
    }
}

fn formula(input: &ExploreInput) -> String {
    let polynomial = |p: &[f64]| -> String {
        let n = p.len();
        let terms: Vec<String> = p
            .iter()
            .enumerate()
            .filter(|(_, c)| **c != 0.0)
            .map(|(i, c)| match (n - 1 - i, *c) {
                (0, c) => format!("{c}"),
                (1, 1.0) => "s".to_owned(),
                (1, c) => format!("{c} s"),
                (k, 1.0) => format!("s^{k}"),
                (k, c) => format!("{c} s^{k}"),
            })
            .collect();
        terms.join(" + ").replace("+ -", "- ")
    };
    let plant = &input.plant;
    let delay = if plant.dead_time > 0.0 {
        format!(" exp(-{} s)", plant.dead_time)
    } else {
        String::new()
    };
    format!(
        "P(s) = ({}) / ({}){delay}",
        polynomial(&plant.numerator),
        polynomial(&plant.denominator)
    )
}

/// Predictions beside the simulation.
fn table_ui(ui: &mut egui::Ui, data: &ExploreData) {
    let reference = data.exact.or(data.simulated);
    let describing = data
        .intersections
        .iter()
        .find(|i| i.cycle.stable == Some(true))
        .or(data.intersections.first());
    egui::Grid::new("predictions")
        .num_columns(4)
        .striped(true)
        .spacing([14.0, 4.0])
        .show(ui, |ui| {
            ui.label("");
            ui.strong("period [s]");
            ui.strong("amplitude");
            ui.strong("stable");
            ui.end_row();
            row_ui(
                ui,
                "Describing function",
                describing.map(|i| i.cycle),
                reference,
                theme::DESCRIBING,
            );
            row_ui(ui, "Exact", data.exact, reference, theme::EXACT);
            row_ui(ui, "Simulated", data.simulated, reference, theme::SIMULATED);
        });
    ui.small("Amplitude: half of peak to peak. In brackets: difference from the exact value.");
}

fn row_ui(
    ui: &mut egui::Ui,
    name: &str,
    cycle: Option<Cycle>,
    reference: Option<Cycle>,
    color: egui::Color32,
) {
    ui.colored_label(color, name);
    let Some(cycle) = cycle else {
        ui.label("none");
        ui.label("");
        ui.label("");
        ui.end_row();
        return;
    };
    let with_difference = |value: f64, exact: Option<f64>| {
        let difference = exact
            .map(|e| 100.0 * (value / e - 1.0))
            .filter(|d| d.abs() >= 0.05);
        difference.map_or(format!("{value:.4}"), |d| format!("{value:.4} ({d:+.1} %)"))
    };
    ui.label(with_difference(cycle.period, reference.map(|r| r.period)));
    ui.label(with_difference(
        cycle.amplitude,
        reference.map(|r| r.amplitude),
    ));
    ui.label(cycle.stable.map_or("?", |s| if s { "yes" } else { "no" }));
    ui.end_row();
}

fn equations_ui(ui: &mut egui::Ui) {
    ui.collapsing("The equations", |ui| {
        ui.monospace("relay      u = -k h(y)\nbalance    P(jω) = -1/N(a)\n-1/N(a) = -π/(4k) [√(a² - ε²) + jε]\nexact      (I + e^(Ah)) x0 = k [G(h-L)\n             - e^(A(h-L)) G(L)],  C x0 = ε");
        ui.small("h: half period, L: all delays, G(t): step response of the state.");
    });
}

fn curve(points: &[[f64; 2]]) -> PlotPoints<'static> {
    points.iter().copied().collect()
}

fn nyquist_plot(ui: &mut egui::Ui, data: &ExploreData, height: f32) {
    let reach = data
        .intersections
        .iter()
        .flat_map(|i| i.point)
        .chain(data.inverse_df.iter().flatten().copied())
        .fold(0.1_f64, |m, v| m.max(v.abs()));
    Plot::new("nyquist")
        .height(height)
        .data_aspect(1.0)
        .default_x_bounds(-1.6 * reach, 1.0 * reach)
        .default_y_bounds(-1.1 * reach, 0.5 * reach)
        .x_axis_label("real part")
        .y_axis_label("imaginary part")
        .allow_scroll(false)
        .legend(Legend::default())
        .show(ui, |plot| {
            plot.line(
                Line::new("plant P(jω)", curve(&data.nyquist))
                    .color(theme::MEASURED)
                    .width(2.0),
            );
            plot.line(
                Line::new("relay -1/N(a)", curve(&data.inverse_df))
                    .color(theme::DESCRIBING)
                    .width(2.5)
                    .style(LineStyle::dashed_loose()),
            );
            let marks: Vec<[f64; 2]> = data.intersections.iter().map(|i| i.point).collect();
            plot.points(
                Points::new("predicted oscillation", curve(&marks))
                    .color(theme::MODEL)
                    .radius(6.0)
                    .shape(MarkerShape::Diamond),
            );
        });
}

fn phase_plot(ui: &mut egui::Ui, data: &ExploreData, height: f32) {
    Plot::new("phase")
        .height(height)
        .x_axis_label("output y")
        .y_axis_label("its rate dy/dt [1/s]")
        .allow_scroll(false)
        .legend(Legend::default())
        .show(ui, |plot| {
            plot.line(
                Line::new("from the start", curve(&data.phase))
                    .color(theme::SIMULATED.gamma_multiply(0.5))
                    .width(1.0),
            );
            plot.line(
                Line::new("limit cycle", curve(&data.cycle))
                    .color(theme::EXACT)
                    .width(3.0),
            );
        });
}

fn time_plot(ui: &mut egui::Ui, input: &ExploreInput, data: &ExploreData, height: f32) {
    Plot::new("time")
        .height(height)
        .x_axis_label("time [s]")
        .y_axis_label("output y, input u")
        .allow_scroll(false)
        .legend(Legend::default())
        .show(ui, |plot| {
            plot.line(
                Line::new("input u", curve(&data.input))
                    .color(theme::INPUT)
                    .width(1.2)
                    .allow_band(false),
            );
            let output: PlotPoints<'_> = data
                .time
                .iter()
                .zip(&data.output)
                .map(|(t, y)| [*t, *y])
                .collect();
            plot.line(
                Line::new("output y", output)
                    .color(theme::SIMULATED)
                    .width(2.5),
            );
            for eps in [input.relay.hysteresis, -input.relay.hysteresis] {
                plot.hline(
                    HLine::new("±ε", eps)
                        .color(theme::NOISE)
                        .style(LineStyle::dashed_dense()),
                );
            }
        });
}
