//! The shell around the pages.

/// The app: what is saved, what runs, and the pages.
#[derive(Default)]
pub struct HysteronApp {}

impl HysteronApp {
    /// A fresh app.
    pub fn new(_cc: &eframe::CreationContext<'_>) -> Self {
        Self::default()
    }
}

impl eframe::App for HysteronApp {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        egui::CentralPanel::default().show(ui, |ui| {
            ui.heading("Hysteron");
            ui.label("ε β τ ω ζ λ µ Σ Δ ∞ ≈ ≤ ² ³ · − ± × √ ° ½ → ∂ ẋ ⁻ ₁ ₂ ↺ ☀ 🌙");
        });
    }
}
