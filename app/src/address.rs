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
    /// What was kept of it. A page that is loaded again goes on where it was left: the link in its address is not
    /// shown once more, over what was done since.
    pub fn resumed(kept: Option<String>) -> Self {
        Self(kept.filter(|_| is_resumed()).unwrap_or_default())
    }

    /// What is to be kept of it.
    pub fn kept(&self) -> &str {
        &self.0
    }

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

/// Whether this is the page of before, loaded again or come back to, and no new visit.
#[cfg(target_arch = "wasm32")]
fn is_resumed() -> bool {
    use web_sys::PerformanceNavigation as Way;
    let performance = web_sys::window().and_then(|w| w.performance());
    let way = performance.map(|p| p.navigation().type_());
    way.is_some_and(|way| [Way::TYPE_RELOAD, Way::TYPE_BACK_FORWARD].contains(&way))
}
