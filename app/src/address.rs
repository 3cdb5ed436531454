//! Where links come from and go to: the address bar of the browser. A native window has none.

/// The whole link for what stands behind `#`. A native app knows of no page on the web: there it is the part
/// that both take.
#[cfg(not(target_arch = "wasm32"))]
pub fn whole(link: &str) -> String {
    format!("#{link}")
}

/// The whole link for what stands behind `#`.
#[cfg(target_arch = "wasm32")]
pub fn whole(link: &str) -> String {
    let address = web_sys::window().and_then(|w| w.location().href().ok());
    let address = address.unwrap_or_default();
    let page = address.split('#').next().unwrap_or_default();
    format!("{page}#{link}")
}

/// The same; the address bar shows it too.
pub fn of(link: &str) -> String {
    #[cfg(target_arch = "wasm32")]
    if let Some(history) = web_sys::window().and_then(|w| w.history().ok()) {
        // It only matters to who copies the link from there.
        let null = wasm_bindgen::JsValue::NULL;
        let _ = history.replace_state_with_url(&null, "", Some(&format!("#{link}")));
    }
    whole(link)
}

/// What the address bar last said.
#[cfg(target_arch = "wasm32")]
#[derive(Default)]
pub struct Address(String);

#[cfg(target_arch = "wasm32")]
impl Address {
    /// A link that stands in the address bar since the last look.
    pub fn changed(&mut self) -> Option<String> {
        let fragment = web_sys::window()?.location().hash().ok()?;
        if fragment == self.0 {
            return None;
        }
        self.0.clone_from(&fragment);
        (fragment.len() > 1).then_some(fragment)
    }
}
