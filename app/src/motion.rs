//! Whether things may move by themselves. Who has asked their system for less motion, or chosen so in the menu,
//! sees nothing move that they have not started.

use egui::{Context, Id, Ui};

fn id() -> Id {
    Id::unique("reduced motion")
}

/// Whether nothing may move by itself.
pub fn reduced(ctx: &Context) -> bool {
    ctx.data(|data| data.get_temp(id()).unwrap_or(false))
}

/// Lets things move by themselves, or not.
pub fn reduce(ctx: &Context, reduced: bool) {
    ctx.data_mut(|data| data.insert_temp(id(), reduced));
    let usual = egui::Style::default();
    ctx.all_styles_mut(|style| {
        if reduced {
            style.animation_time = 0.0;
            style.scroll_animation = egui::style::ScrollAnimation::none();
        } else {
            style.animation_time = usual.animation_time;
            style.scroll_animation = usual.scroll_animation;
        }
    });
}

/// What the system asks for: on the web the media query `prefers-reduced-motion`. A window system has no
/// common way to ask.
#[cfg(target_arch = "wasm32")]
pub fn of_system() -> bool {
    let query = web_sys::window().and_then(|w| {
        let query = w.match_media("(prefers-reduced-motion: reduce)");
        query.ok().flatten()
    });
    query.is_some_and(|q| q.matches())
}

#[cfg(not(target_arch = "wasm32"))]
pub fn of_system() -> bool {
    false
}

/// Shows that something is computed.
pub fn busy_ui(ui: &mut Ui) {
    if reduced(ui.ctx()) {
        ui.label("...");
    } else {
        ui.spinner();
    }
}
