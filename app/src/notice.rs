//! What the app has to say in passing, at the foot of the window.

use crate::language::tr;
use crate::theme;
use hysteron_core::message::Message;

/// Time that a good word stays, s; a refusal stays until it is dismissed.
const SECONDS: f64 = 3.0;

/// One sentence.
#[derive(Clone, Debug, PartialEq)]
pub struct Notice {
    text: Message,
    /// When it goes by itself, s on egui's clock.
    until: Option<f64>,
}

impl Notice {
    /// Something went well.
    pub fn done(ctx: &egui::Context, text: impl Into<Message>) -> Self {
        Self {
            text: text.into(),
            until: Some(ctx.input(|i| i.time) + SECONDS),
        }
    }

    /// Something was refused.
    pub fn refused(text: impl Into<Message>) -> Self {
        Self {
            text: text.into(),
            until: None,
        }
    }

    /// The sentence.
    pub fn text(&self) -> &Message {
        &self.text
    }
}

/// Draws the notice, if there is one, at the foot of the page, and takes it away in time; `foot` is where the page ends
/// and what stands below it begins.
pub fn ui(ctx: &egui::Context, notice: &mut Option<Notice>, foot: f32) {
    let Some(shown) = notice else {
        return;
    };
    let mut gone = false;
    if let Some(until) = shown.until {
        let left = until - ctx.input(|i| i.time);
        gone = left <= 0.0;
        ctx.request_repaint_after(std::time::Duration::from_secs_f64(left.max(0.0)));
    }
    egui::Area::new(egui::Id::unique("notice"))
        .anchor(
            egui::Align2::CENTER_BOTTOM,
            egui::vec2(0.0, foot - ctx.content_rect().bottom() - 16.0),
        )
        .order(egui::Order::Foreground)
        .show(ctx, |ui| {
            egui::Frame::popup(ui.style()).show(ui, |ui| {
                ui.set_max_width(ctx.content_rect().width().min(560.0) - 32.0);
                theme::tell(&ui.label(tr(&shown.text)));
                if shown.until.is_none() {
                    gone |= ui.button(tr("Dismiss")).clicked();
                }
            });
        });
    if gone {
        *notice = None;
    }
}
