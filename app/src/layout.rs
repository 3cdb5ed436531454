//! How a page divides its window.

use crate::theme;

/// Width below which everything stands in one column, points.
pub const NARROW: f32 = 700.0;

/// Share of a small window that the controls beside the plots have, and what they need at least, points.
const SIDE_SHARE: f32 = 0.4;
const LEAST_SIDE: f32 = 340.0;

/// Width of two plots side by side below which they stand under each other, points.
const PAIR: f32 = 500.0;

/// Height of the plot that stays in view above what scrolls in a narrow window, and of the window that has room for it,
/// points.
pub const PINNED: f32 = 190.0;
const ROOM_TO_PIN: f32 = 560.0;

/// Whether a narrow window is so high that a plot can stay in view above its sliders.
pub fn pins(ui: &egui::Ui) -> bool {
    ui.available_height() >= ROOM_TO_PIN
}

/// Width of the controls beside the plots: as much as they like, but in a small window the plots come first.
pub fn side(ui: &egui::Ui, liked: f32) -> f32 {
    liked.min((SIDE_SHARE * ui.available_width()).max(LEAST_SIDE))
}

/// Most of a window that a panel has that someone has made wider.
const MOST_SIDE: f32 = 0.6;

/// The panel whose edge can be dragged.
#[derive(Default)]
pub struct Side {
    /// Its width where someone has dragged it, points.
    pub chosen: Option<f32>,
    /// Its width in the last frame, points.
    last: Option<f32>,
}

impl Side {
    /// Its width at first: as it was chosen, or else as it likes.
    pub fn width(&self, ui: &egui::Ui, liked: f32) -> f32 {
        let most = MOST_SIDE * ui.available_width();
        self.chosen.map_or(side(ui, liked), |width| width.min(most))
    }

    /// Says how wide it is now. A window that is made smaller changes it too, but without the pointer.
    pub fn note(&mut self, ui: &egui::Ui, width: f32) {
        let last = self.last.replace(width);
        let changed = last.is_some_and(|last| last != width);
        if changed && ui.input(|i| i.pointer.any_down()) {
            self.chosen = Some(width);
        }
    }
}

/// What stands at the side of a page and scrolls: whatever is in it, the edge of its panel stays where it is.
pub fn side_ui(ui: &mut egui::Ui, name: &str, content: impl FnOnce(&mut egui::Ui)) {
    theme::scroll(name).show(ui, |ui| {
        let mut room = ui.available_rect_before_wrap();
        let mut inner = ui.new_child(egui::UiBuilder::new().max_rect(room));
        content(&mut inner);
        room.max.y = inner.min_rect().bottom();
        ui.advance_cursor_after_rect(room);
    });
}

/// Whether two plots have room side by side.
pub fn room_for_two(ui: &egui::Ui) -> bool {
    ui.available_width() >= PAIR
}

/// Cards side by side, all as high as the highest; the place of the one that was pressed beside what is on it.
pub fn row(
    ui: &mut egui::Ui,
    name: impl std::hash::Hash + std::fmt::Debug,
    count: usize,
    mut content: impl FnMut(&mut egui::Ui, usize, &mut Foot),
) -> Option<usize> {
    // How high that is was seen in the last frame.
    let id = egui::Id::unique(name);
    let height = ui.data(|data| data.get_temp(id)).unwrap_or(0.0);
    let mut highest = 0.0_f32;
    let mut pressed = None;
    ui.columns(count, |columns| {
        for (place, ui) in columns.iter_mut().enumerate() {
            let card = card(ui, height, |ui, foot| content(ui, place, foot));
            highest = highest.max(card.height);
            pressed = pressed.or(card.pressed.then_some(place));
        }
    });
    if highest != height {
        ui.data_mut(|data| data.insert_temp(id, highest));
        ui.ctx().request_repaint();
    }
    pressed
}

/// Where a card ends.
pub struct Foot {
    bottom: f32,
    /// What was left free above what stands there, points.
    free: f32,
}

impl Foot {
    /// Has what follows stand there, if it is so high, points: so that the buttons of a row stand in line.
    pub fn room(&mut self, ui: &mut egui::Ui, height: f32) {
        self.free = (self.bottom - ui.cursor().top() - height).max(0.0);
        ui.add_space(self.free);
    }
}

/// A card that was drawn.
pub struct Card {
    /// Height that its content needs, points.
    height: f32,
    /// Whether it was pressed where there is no button on it.
    pub pressed: bool,
}

/// A card of this height at least, which is pressed as a whole: keys and screen readers have the button on it.
pub fn card(ui: &mut egui::Ui, least: f32, content: impl FnOnce(&mut egui::Ui, &mut Foot)) -> Card {
    let whole = egui::UiBuilder::new().sense(egui::Sense::CLICK);
    let shown = ui.scope_builder(whole, |ui| {
        let mut frame = egui::Frame::group(ui.style());
        if ui.response().contains_pointer() {
            frame.stroke = ui.visuals().widgets.hovered.bg_stroke;
        }
        // Words that could be selected would take the click.
        ui.style_mut().interaction.selectable_labels = false;
        let framed = frame.show(ui, |ui| {
            ui.set_width(ui.available_width());
            let mut foot = Foot {
                bottom: ui.cursor().top() + least,
                free: 0.0,
            };
            // A column would stretch the words from edge to edge.
            let rows = egui::Layout::top_down(egui::Align::LEFT);
            ui.with_layout(rows, |ui| content(ui, &mut foot));
            let content = ui.min_rect();
            ui.expand_to_include_y(content.top() + least);
            content.height() - foot.free
        });
        framed.inner
    });
    let hand = egui::CursorIcon::PointingHand;
    Card {
        height: shown.inner,
        pressed: shown.response.on_hover_cursor(hand).clicked(),
    }
}
