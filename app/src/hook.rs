//! What the app shows, as a JSON value, for tests: a canvas has no widgets to ask.

use std::collections::BTreeMap;

use egui::{Pos2, Response};

/// Centres of the visible buttons by name, in points.
#[derive(Debug, Default)]
pub struct Targets(BTreeMap<String, Pos2>);

impl Targets {
    /// Notes where a button is, if it can be seen.
    pub fn note(&mut self, name: impl Into<String>, ui: &egui::Ui, response: &Response) {
        if ui.clip_rect().contains(response.rect.center()) {
            self.0.insert(name.into(), response.rect.center());
        }
    }

    /// Notes a place that can be dragged.
    pub fn note_place(&mut self, name: impl Into<String>, at: Pos2) {
        self.0.insert(name.into(), at);
    }

    /// Forgets the last frame.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// As a JSON object of `[x, y]`.
    pub fn to_json(&self) -> serde_json::Value {
        self.0
            .iter()
            .map(|(name, p)| (name.clone(), serde_json::json!([p.x, p.y])))
            .collect()
    }
}

/// Writes the state where the page's tests read it.
#[cfg(target_arch = "wasm32")]
pub fn publish(state: &serde_json::Value) {
    if let Some(window) = web_sys::window() {
        let text = wasm_bindgen::JsValue::from_str(&state.to_string());
        // Only a frozen window object could refuse; then there is nobody to tell.
        let _ = js_sys::Reflect::set(&window, &"hysteron_state".into(), &text);
    }
}
