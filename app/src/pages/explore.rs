//! tmp
#[derive(Default)]
pub struct Explore {}
impl Explore {
    pub fn ui(&mut self, ui: &mut egui::Ui) { ui.label("..."); }
}
