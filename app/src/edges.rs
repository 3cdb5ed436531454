//! The way out of the page by keys: on the web, Tab after the last control goes on to the browser, and Shift+Tab before
//! the first goes back to it. egui goes round and round, and eframe keeps Tab from the browser while the canvas has the
//! keyboard.

use egui::{Event, Id, Key, Modifiers, Rect, Sense, Ui};

/// Stands before the first control: whether the keys go beyond it.
pub fn before(ui: &Ui) -> bool {
    passed(ui, Id::unique("edge_before"), Modifiers::SHIFT)
}

/// Stands behind the last control: whether the keys go beyond it.
pub fn behind(ui: &Ui) -> bool {
    passed(ui, Id::unique("edge_behind"), Modifiers::NONE)
}

/// An edge is there only for who goes out: whoever comes in meets the first control.
fn passed(ui: &Ui, edge: Id, modifiers: Modifiers) -> bool {
    let tab = |event: &Event| matches!(event, Event::Key { key: Key::Tab, pressed: true, modifiers: held, .. } if *held == modifiers);
    let reached = |ui: &Ui| ui.memory(|memory| memory.has_focus(edge));
    if !reached(ui) && !ui.input(|input| input.events.iter().any(tab)) {
        return false;
    }
    ui.interact(Rect::ZERO, edge, Sense::focusable_noninteractive());
    let passed = reached(ui);
    if passed {
        ui.memory_mut(|memory| memory.surrender_focus(edge));
    }
    passed
}

/// Gives the keyboard to an element at this end of the page, from which the next Tab is the browser's; `None` where the
/// page has none, and the keys go round.
#[cfg(target_arch = "wasm32")]
pub fn leave(on: bool) -> Option<()> {
    use crate::language::tr;
    use wasm_bindgen::JsCast as _;

    let document = web_sys::window()?.document()?;
    let body = document.body()?;
    let edge = document.get_element_by_id("hysteron-edge")?;
    edge.set_text_content(Some(&tr(if on {
        "End of the page: Tab continues, Shift+Tab goes back."
    } else {
        "Beginning of the page: Shift+Tab continues, Tab goes back."
    })));
    // Beyond the field that eframe has added for typing.
    let next = if on { None } else { body.first_child() };
    body.insert_before(&edge, next.as_ref()).ok()?;
    edge.dyn_into::<web_sys::HtmlElement>().ok()?.focus().ok()
}

#[cfg(test)]
mod tests {
    use egui::{Context, RawInput};

    use super::*;

    /// A frame with two buttons: which edge is passed, and which button has the keyboard.
    fn frame(ctx: &Context, tab: Option<Modifiers>) -> ([bool; 2], Option<usize>) {
        let key = |modifiers| Event::Key {
            key: Key::Tab,
            physical_key: None,
            pressed: true,
            repeat: false,
            modifiers,
        };
        let input = RawInput {
            events: tab.map(key).into_iter().collect(),
            ..RawInput::default()
        };
        let mut seen = ([false; 2], None);
        let mut output = ctx.run_ui(input, |ui| {
            let before = before(ui);
            let buttons = [ui.button("first"), ui.button("last")];
            seen = (
                [before, behind(ui)],
                buttons.iter().position(egui::Response::has_focus),
            );
        });
        output.textures_delta.clear();
        seen
    }

    #[test]
    fn tab_goes_out_at_the_end_and_shift_tab_at_the_beginning() {
        let ctx = Context::default();
        let tab = |modifiers| {
            let (now, _) = frame(&ctx, Some(modifiers));
            let (then, focused) = frame(&ctx, None);
            ([now[0] || then[0], now[1] || then[1]], focused)
        };
        let inside = [false; 2];
        assert_eq!(tab(Modifiers::NONE), (inside, Some(0)));
        assert_eq!(tab(Modifiers::NONE), (inside, Some(1)));
        assert_eq!(tab(Modifiers::NONE), ([false, true], None));
        // Back again, and out where one came in.
        assert_eq!(tab(Modifiers::SHIFT), (inside, Some(1)));
        assert_eq!(tab(Modifiers::SHIFT), (inside, Some(0)));
        assert_eq!(tab(Modifiers::SHIFT), ([true, false], None));
        assert_eq!(tab(Modifiers::NONE), (inside, Some(0)));
    }
}
