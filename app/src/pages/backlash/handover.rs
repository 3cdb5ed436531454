//! Equations (10) and (11) over time: the distance of the masses, and the momentum that an impact hands over and keeps.

use egui::Ui;
use egui_plot::{HLine, Line, LineStyle, VLine};
use hysteron_core::drive::Drive;

use super::plots::{CONTACT, LOAD};
use super::scene::Scene;
use super::units::MILLI;
use crate::language::tr;
use crate::layout;
use crate::theme;
use crate::widgets::chart::{Shape, caption_ui, curve, still};

/// Periods of the relay that are shown up to now.
const PERIODS: f64 = 4.0;

/// What is drawn: distance `x1 - x2` in mrad, and momenta in mN m s, over the time in s.
struct Handover {
    distance: Vec<[f64; 2]>,
    motor: Vec<[f64; 2]>,
    load: Vec<[f64; 2]>,
    both: Vec<[f64; 2]>,
}

/// Samples and events from one time to another.
fn handover(scene: &Scene, drive: &Drive, from: f64, to: f64) -> Handover {
    let run = &scene.run;
    let samples = run.time.partition_point(|t| *t < from)..run.time.partition_point(|t| *t <= to);
    let events =
        run.events.partition_point(|e| e.time < from)..run.events.partition_point(|e| e.time <= to);
    let sampled = samples.map(|i| [run.time[i], run.x1[i], run.v1[i], run.x2[i], run.v2[i]]);
    let mut states: Vec<[f64; 5]> = sampled
        .chain(
            run.events[events]
                .iter()
                .map(|e| [e.time, e.x1, e.v1, e.x2, e.v2]),
        )
        .collect();
    states.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let (j1, j2) = (MILLI * drive.motor.inertia, MILLI * drive.load.inertia);
    let of = |value: &dyn Fn(&[f64; 5]) -> f64| states.iter().map(|s| [s[0], value(s)]).collect();
    Handover {
        distance: of(&|s| MILLI * (s[1] - s[3])),
        motor: of(&|s| j1 * s[2]),
        load: of(&|s| j2 * s[4]),
        both: of(&|s| j1 * s[2] + j2 * s[4]),
    }
}

/// Distance and momenta in the last periods before now, of a simulation.
pub fn ui(ui: &mut Ui, scene: &Scene, clock: f64, height: f32) {
    let Some(input) = scene.input() else {
        return;
    };
    let span = PERIODS * scene.period();
    let to = clock.max(span);
    let drawn = handover(scene, &input.drive, to - span, to);
    let beta = MILLI * input.drive.half_gap;
    if layout::room_for_two(ui) {
        ui.columns(2, |columns| {
            distance_ui(&mut columns[0], &drawn, beta, clock, height);
            momentum_ui(&mut columns[1], &drawn, clock, height);
        });
    } else {
        distance_ui(ui, &drawn, beta, clock, height);
        momentum_ui(ui, &drawn, clock, height);
    }
    ui.small(tr(
        "An impact hands momentum from one mass to the other and keeps the sum, equation (11); only the torque and friction change that.",
    ));
}

fn distance_ui(ui: &mut Ui, drawn: &Handover, beta: f64, clock: f64, height: f32) {
    caption_ui(
        ui,
        "Distance d",
        &[
            ("d = x1 - x2", theme::MEASURED, Shape::Line),
            ("ends of the gap", CONTACT, Shape::Dashes),
        ],
    );
    still("distance", "time [s]", "d = x1 - x2 [mrad]", height).show(ui, |plot| {
        plot.line(
            Line::new(tr("d = x1 - x2"), curve(&drawn.distance))
                .color(theme::MEASURED)
                .width(2.0),
        );
        for end in [-beta, beta] {
            plot.hline(
                HLine::new(tr("ends of the gap"), end)
                    .color(CONTACT)
                    .style(LineStyle::dashed_dense()),
            );
        }
        plot.vline(VLine::new(tr("now"), clock).color(theme::INPUT).width(1.0));
    });
}

fn momentum_ui(ui: &mut Ui, drawn: &Handover, clock: f64, height: f32) {
    caption_ui(
        ui,
        "Momentum",
        &[
            ("motor J1 v1", theme::MEASURED, Shape::Line),
            ("load J2 v2", LOAD, Shape::Line),
            ("both", theme::MODEL, Shape::Line),
        ],
    );
    still("momentum", "time [s]", "momentum [mN m s]", height).show(ui, |plot| {
        for (name, values, color, width) in [
            ("motor J1 v1", &drawn.motor, theme::MEASURED, 1.5),
            ("load J2 v2", &drawn.load, LOAD, 1.5),
            ("both", &drawn.both, theme::MODEL, 2.5),
        ] {
            plot.line(Line::new(tr(name), curve(values)).color(color).width(width));
        }
        plot.vline(VLine::new(tr("now"), clock).color(theme::INPUT).width(1.0));
    });
}
