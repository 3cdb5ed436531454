//! Fig. 8 of the paper: the two masses as a block diagram whose blocks light up by mode.

use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Stroke, Ui, pos2, vec2};
use hysteron_core::drive::{Event, EventKind, Mass, Side};

use super::plots::{CONTACT, LOAD};
use super::scene::Scene;
use crate::language::tr;
use crate::theme;

/// Height of the diagram, points.
pub const HEIGHT: f32 = 150.0;

/// How long an impact stays lit, periods of the relay.
const LIT: f64 = 0.15;

/// Rows of the play: its two ends and the way between them.
const ROWS: usize = 3;

/// What each part of the drive does at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Modes {
    /// The relay pushes up.
    pub up: bool,
    /// The motor sticks.
    pub motor_sticks: bool,
    /// The load sticks.
    pub load_sticks: bool,
    /// The end of the gap at which the masses touch or have just hit each other.
    pub contact: Option<Side>,
}

/// The modes at a time, by the events up to it; `flash`: how long an impact counts as a contact, s; `u`: the torque.
pub fn modes(events: &[Event], clock: f64, flash: f64, u: f64) -> Modes {
    let past = &events[..events.partition_point(|e| e.time <= clock)];
    let last = |of: &dyn Fn(&EventKind) -> bool| past.iter().rev().find(|e| of(&e.kind));
    let sticks = |mass: Mass| {
        let of =
            |kind: &EventKind| *kind == EventKind::Stick(mass) || *kind == EventKind::Move(mass);
        last(&of).is_some_and(|e| e.kind == EventKind::Stick(mass))
    };
    let touching = last(&|kind| {
        matches!(
            kind,
            EventKind::Impact(..) | EventKind::Touch(_) | EventKind::Part(_)
        )
    });
    let contact = touching.and_then(|e| match e.kind {
        EventKind::Touch(side) => Some(side),
        EventKind::Impact(side, _) if clock - e.time <= flash => Some(side),
        _ => None,
    });
    Modes {
        up: u > 0.0,
        motor_sticks: sticks(Mass::Motor),
        load_sticks: sticks(Mass::Load),
        contact,
    }
}

/// Draws the diagram at a time of a simulation.
pub fn ui(ui: &mut Ui, scene: &Scene, clock: f64) {
    let Some(now) = scene.now(clock) else {
        return;
    };
    let modes = modes(&scene.run.events, clock, LIT * scene.period(), now.torque);
    ui.strong(tr("Fig. 8: two masses and the play between them"));
    let (rect, _) =
        ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), egui::Sense::hover());
    let painter = ui.painter_at(rect);
    let drawn = Drawn {
        painter,
        line: ui.visuals().text_color(),
        dark: ui.visuals().faint_bg_color,
        frame: ui.visuals().weak_text_color(),
    };
    drawn.all(rect, modes);
}

struct Drawn {
    painter: Painter,
    line: Color32,
    dark: Color32,
    frame: Color32,
}

impl Drawn {
    fn all(&self, rect: Rect, modes: Modes) {
        // Relay, motor, play, load; between them the wires.
        let wire = (0.06 * rect.width()).clamp(18.0, 60.0);
        let width = ((rect.width() - 3.0 * wire) / 4.0).min(190.0);
        let left = rect.center().x - 0.5 * (4.0 * width + 3.0 * wire);
        let y = rect.center().y;
        let place = |i: usize| {
            let x = left + i as f32 * (width + wire);
            Rect::from_x_y_ranges(x..=x + width, y - 27.0..=y + 27.0)
        };
        let [relay, motor, play, load] = [0, 1, 2, 3].map(place);
        self.block(
            relay,
            "relay (2)",
            if modes.up { "pushes up" } else { "pushes down" },
            Some(theme::INPUT),
        );
        self.block(
            motor,
            "motor: v1, x1",
            if modes.motor_sticks {
                "sticks"
            } else {
                "moves"
            },
            (!modes.motor_sticks).then_some(theme::MEASURED),
        );
        let tall = play.expand2(vec2(0.0, 14.0));
        self.play(tall, modes.contact);
        self.block(
            load,
            "load: v2, x2",
            if modes.load_sticks { "sticks" } else { "moves" },
            (!modes.load_sticks).then_some(LOAD),
        );
        self.wire(relay.right_center(), motor.left_center(), "u");
        self.wire(motor.right_center(), tall.left_center(), "d");
        self.wire(tall.right_center(), load.left_center(), "F");
        // The velocity back to the relay, the load's position back to the play, the force back to the motor.
        self.back(
            motor.center_top() - vec2(0.2 * width, 0.0),
            relay.center_top(),
            -26.0,
            "v1",
        );
        self.back(
            load.center_bottom(),
            tall.center_bottom() + vec2(0.25 * width, 0.0),
            22.0,
            "x2",
        );
        self.back(
            tall.center_bottom() - vec2(0.25 * width, 0.0),
            motor.center_bottom(),
            22.0,
            "-F",
        );
    }

    fn block(&self, rect: Rect, name: &str, mode: &str, lit: Option<Color32>) {
        self.fill(rect, lit);
        let color = if lit.is_some() {
            Color32::BLACK
        } else {
            self.line
        };
        self.text(rect.center() - vec2(0.0, 9.0), name, color);
        self.text(rect.center() + vec2(0.0, 9.0), mode, color);
    }

    /// The play operator: its ends and the way between them, one of which is lit.
    fn play(&self, rect: Rect, contact: Option<Side>) {
        let height = rect.height() / ROWS as f32;
        for (i, (name, of)) in [
            ("upper end", Some(Side::Upper)),
            ("in the gap", None),
            ("lower end", Some(Side::Lower)),
        ]
        .into_iter()
        .enumerate()
        {
            let top = rect.top() + i as f32 * height;
            let row = Rect::from_x_y_ranges(rect.x_range(), top..=top + height - 2.0);
            let color = if of.is_some() { CONTACT } else { theme::SHADE };
            let lit = (contact == of).then_some(color);
            self.fill(row, lit);
            let color = if lit.is_some() {
                Color32::BLACK
            } else {
                self.line
            };
            self.text(row.center(), name, color);
        }
    }

    fn fill(&self, rect: Rect, lit: Option<Color32>) {
        self.painter.rect(
            rect,
            4.0,
            lit.unwrap_or(self.dark),
            Stroke::new(1.0, self.frame),
            egui::StrokeKind::Inside,
        );
    }

    fn text(&self, at: Pos2, text: &str, color: Color32) {
        let font = FontId::proportional(12.0);
        self.painter
            .text(at, Align2::CENTER_CENTER, tr(text), font, color);
    }

    fn wire(&self, from: Pos2, to: Pos2, name: &str) {
        self.painter
            .arrow(from, to - from, Stroke::new(1.2, self.line));
        let middle = from + 0.5 * (to - from) - vec2(0.0, 9.0);
        self.name(middle, name);
    }

    /// From one block round to another: out by `away`, across, and in.
    fn back(&self, from: Pos2, to: Pos2, away: f32, name: &str) {
        let y = if away < 0.0 {
            from.y.min(to.y) + away
        } else {
            from.y.max(to.y) + away
        };
        let stroke = Stroke::new(1.2, self.line);
        self.painter.line_segment([from, pos2(from.x, y)], stroke);
        self.painter
            .line_segment([pos2(from.x, y), pos2(to.x, y)], stroke);
        self.painter
            .arrow(pos2(to.x, y), vec2(0.0, to.y - y), stroke);
        self.name(pos2(0.5 * (from.x + to.x), y - 7.0), name);
    }

    /// A symbol, the same in every language.
    fn name(&self, at: Pos2, name: &str) {
        let font = FontId::proportional(12.0);
        self.painter
            .text(at, Align2::CENTER_CENTER, name, font, self.line);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn event(time: f64, kind: EventKind) -> Event {
        Event {
            time,
            kind,
            x1: 0.0,
            v1: 0.0,
            x2: 0.0,
            v2: 0.0,
        }
    }

    #[test]
    fn modes_follow_the_events() {
        let events = [
            event(1.0, EventKind::Stick(Mass::Load)),
            event(2.0, EventKind::Touch(Side::Upper)),
            event(2.5, EventKind::Move(Mass::Load)),
            event(3.0, EventKind::Part(Side::Upper)),
            event(4.0, EventKind::Impact(Side::Lower, 0.1)),
        ];
        let at = |clock: f64| modes(&events, clock, 0.1, 1.0);
        assert!(at(1.5).load_sticks && at(1.5).contact.is_none());
        assert_eq!(at(2.2).contact, Some(Side::Upper));
        assert!(!at(2.7).load_sticks);
        assert_eq!(at(3.5).contact, None);
        assert_eq!(at(4.05).contact, Some(Side::Lower));
        assert_eq!(at(4.2).contact, None);
    }
}
