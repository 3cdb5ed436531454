//! How a page divides its window.

/// Width below which everything stands in one column, points.
pub const NARROW: f32 = 700.0;

/// Share of a small window that the controls beside the plots have, and what they need at least, points.
const SIDE_SHARE: f32 = 0.4;
const LEAST_SIDE: f32 = 340.0;

/// Width of two plots side by side below which they stand under each other, points.
const PAIR: f32 = 500.0;

/// Width of the controls beside the plots: as much as they like, but in a small window the plots come first.
pub fn side(ui: &egui::Ui, liked: f32) -> f32 {
    liked.min((SIDE_SHARE * ui.available_width()).max(LEAST_SIDE))
}

/// Whether two plots have room side by side.
pub fn room_for_two(ui: &egui::Ui) -> bool {
    ui.available_width() >= PAIR
}
