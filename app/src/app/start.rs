//! How the app starts: a window on a native machine, a canvas on the web.

#[cfg(not(target_arch = "wasm32"))]
use std::path::PathBuf;

use super::HysteronApp;
#[cfg(target_arch = "wasm32")]
use crate::language::{self, Language, tr};
#[cfg(not(target_arch = "wasm32"))]
use crate::theme;

/// What to say where no window can be opened.
#[cfg(not(target_arch = "wasm32"))]
const NO_DISPLAY: &str = "no display to open a window on: use the web page (cargo xtask web && cargo xtask serve) \
     or the command line (hysteron diagnose FILE.csv), as here";

/// Opens the window, with this file if there is one, and returns when it is closed.
///
/// # Errors
/// One line for the terminal where no window can be opened.
#[cfg(not(target_arch = "wasm32"))]
pub fn run_native(file: Option<PathBuf>) -> Result<(), String> {
    if !display_exists() {
        return Err(NO_DISPLAY.to_owned());
    }
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Hysteron")
            .with_app_id("hysteron")
            .with_inner_size([1280.0, 800.0])
            .with_min_inner_size([360.0, 400.0])
            .with_drag_and_drop(true)
            .with_icon(icon()),
        ..Default::default()
    };
    eframe::run_native(
        "hysteron",
        options,
        Box::new(|context| {
            let mut app = HysteronApp::restored(context);
            if let Some(file) = file {
                app.open_path(&context.egui_ctx, &file);
            }
            Ok(Box::new(app))
        }),
    )
    .map_err(|e| format!("{NO_DISPLAY} ({})", one_line(&e.to_string())))
}

/// The loop of a relay with hysteresis, as on the page's tab.
#[cfg(not(target_arch = "wasm32"))]
fn icon() -> egui::IconData {
    const SIDE: u32 = 32;
    const GROUND: [u8; 4] = [0x1b, 0x1b, 0x1b, 0xff];
    let [r, g, b, a] = theme::MEASURED.to_array();
    let on_line = |x: u32, y: u32| {
        let near = |v: u32, line: u32| v.abs_diff(line) < 2;
        (near(y, 24) && (4..22).contains(&x))
            || (near(y, 8) && (11..28).contains(&x))
            || ((near(x, 12) || near(x, 20)) && (8..=24).contains(&y))
    };
    let pixels = (0..SIDE * SIDE).map(|i| (i % SIDE, i / SIDE));
    egui::IconData {
        rgba: pixels
            .flat_map(|(x, y)| if on_line(x, y) { [r, g, b, a] } else { GROUND })
            .collect(),
        width: SIDE,
        height: SIDE,
    }
}

#[cfg(not(target_arch = "wasm32"))]
fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// X11 and Wayland name their display in the environment; other systems always have one.
#[cfg(not(target_arch = "wasm32"))]
fn display_exists() -> bool {
    let set = |name| std::env::var_os(name).is_some_and(|v| !v.is_empty());
    !cfg!(all(unix, not(target_os = "macos")))
        || ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"]
            .into_iter()
            .any(set)
}

/// Starts the app on the canvas `hysteron-canvas`; a failure is written into the element `hysteron-error`.
#[cfg(target_arch = "wasm32")]
pub fn run_web() {
    use wasm_bindgen::JsCast as _;
    eframe::WebLogger::init(log::LevelFilter::Warn).ok();
    let Some(document) = web_sys::window().and_then(|w| w.document()) else {
        return;
    };
    let canvas = document
        .get_element_by_id("hysteron-canvas")
        .and_then(|e| e.dyn_into::<web_sys::HtmlCanvasElement>().ok());
    let Some(canvas) = canvas else {
        log::error!("the page has no canvas with the id hysteron-canvas");
        return;
    };
    wasm_bindgen_futures::spawn_local(async move {
        let started = eframe::WebRunner::new()
            .start(
                canvas,
                eframe::WebOptions::default(),
                Box::new(|context| Ok(Box::new(HysteronApp::restored(context)))),
            )
            .await;
        if started.is_ok()
            && let Some(message) = document.get_element_by_id("hysteron-message")
        {
            message.remove();
        }
        if let Err(error) = started {
            log::error!("the app did not start: {error:?}");
            language::speak(Language::of_system());
            if let Some(place) = document.get_element_by_id("hysteron-error") {
                place.set_text_content(Some(&tr(
                    "Hysteron needs a browser with WebGL 2, which could not be started here. Try a current Firefox, Chrome, Edge or Safari, and switch hardware acceleration on in its settings.",
                )));
            }
        }
    });
}
