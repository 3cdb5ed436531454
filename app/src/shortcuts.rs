//! Keys: one table for what they do and for the sheet that says so.

use egui::{Event, Key, KeyboardShortcut, Modifiers};

use crate::command::Command;
use crate::language::tr;
use crate::widgets::chart_cursor;
use hysteron_core::message::Message;
use hysteron_core::msg;

/// A key and what it asks for.
struct Shortcut {
    keys: &'static [KeyboardShortcut],
    sentence: &'static str,
    command: Command,
}

const PLAIN: Modifiers = Modifiers::NONE;
const COMMAND: Modifiers = Modifiers::COMMAND;
const COMMAND_SHIFT: Modifiers = Modifiers::COMMAND.plus(Modifiers::SHIFT);

const fn key(modifiers: Modifiers, key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(modifiers, key)
}

/// All but those of the pages, which are numbered in the order of their tabs; in the order of the sheet.
const SHORTCUTS: [Shortcut; 9] = [
    Shortcut {
        keys: &[key(COMMAND, Key::Z)],
        sentence: "Undo the last change",
        command: Command::Undo,
    },
    Shortcut {
        keys: &[key(COMMAND_SHIFT, Key::Z), key(COMMAND, Key::Y)],
        sentence: "Redo the last change you undid",
        command: Command::Redo,
    },
    Shortcut {
        keys: &[key(COMMAND, Key::O)],
        sentence: "Open a file",
        command: Command::AskForFile,
    },
    Shortcut {
        keys: &[key(PLAIN, Key::P)],
        sentence: "Play or pause",
        command: Command::Play,
    },
    Shortcut {
        keys: &[key(PLAIN, Key::R)],
        sentence: "Reset this page",
        command: Command::Reset,
    },
    Shortcut {
        keys: &[key(PLAIN, Key::L)],
        sentence: "Copy a link to this page as it is; paste a link to open it",
        command: Command::CopyLink,
    },
    Shortcut {
        keys: &[key(PLAIN, Key::T)],
        sentence: "Next look: dark, light, projector",
        command: Command::NextLook,
    },
    Shortcut {
        keys: &[
            key(PLAIN, Key::F1),
            key(PLAIN, Key::Questionmark),
            key(PLAIN, Key::H),
        ],
        sentence: "Show or hide this sheet",
        command: Command::Sheet,
    },
    Shortcut {
        keys: &[key(PLAIN, Key::Escape)],
        sentence: "Close whatever is on top",
        command: Command::Close,
    },
];

/// Keys of the pages, by their tabs.
const PAGES: [Key; 9] = [
    Key::Num1,
    Key::Num2,
    Key::Num3,
    Key::Num4,
    Key::Num5,
    Key::Num6,
    Key::Num7,
    Key::Num8,
    Key::Num9,
];

/// What the keys of this frame ask for. A text field keeps its keys.
pub fn pressed(ctx: &egui::Context, pages: &[&'static str], commands: &mut Vec<Command>) {
    if ctx.text_edit_focused() {
        return;
    }
    // A menu or a list lies over everything else; egui closes it. A plot takes its cursor away.
    let kept = egui::Popup::is_any_open(ctx) || chart_cursor::live(ctx).is_some();
    ctx.input_mut(|input| {
        for shortcut in &SHORTCUTS {
            if kept && shortcut.command == Command::Close {
                continue;
            }
            if shortcut.keys.iter().any(|k| consume(input, *k)) {
                commands.push(shortcut.command.clone());
            }
        }
        for (key, page) in PAGES.iter().zip(pages) {
            if consume(input, KeyboardShortcut::new(PLAIN, *key)) {
                commands.push(Command::Go(page));
            }
        }
    });
}

/// Keys as they are named.
fn names(keys: &str) -> Message {
    let rest = |with: &str| keys.strip_prefix(with).map(Message::name);
    if let Some(key) = rest("Ctrl+Shift+") {
        msg!("Ctrl+Shift+{}", key)
    } else if let Some(key) = rest("Ctrl+") {
        msg!("Ctrl+{}", key)
    } else if let Some(key) = rest("Shift+Cmd+") {
        msg!("Shift+Cmd+{}", key)
    } else if let Some(key) = rest("Cmd+") {
        msg!("Cmd+{}", key)
    } else {
        Message::words(keys.to_owned())
    }
}

/// Takes a key where it is pressed with just these modifiers: a digit with Shift is another sign. Where a keyboard
/// needs Shift for the question mark, it must not count.
fn consume(input: &mut egui::InputState, wanted: KeyboardShortcut) -> bool {
    let KeyboardShortcut {
        modifiers: wished,
        logical_key,
    } = wanted;
    let before = input.events.len();
    input.events.retain(|event| {
        let Event::Key {
            key,
            modifiers,
            pressed: true,
            ..
        } = event
        else {
            return true;
        };
        let shifted = logical_key == Key::Questionmark || modifiers.shift == wished.shift;
        *key != logical_key || !shifted || !modifiers.matches_logically(wished)
    });
    input.events.len() < before
}

/// The sheet; false when it was closed.
pub fn sheet_ui(ctx: &egui::Context, titles: &[&'static str]) -> bool {
    let mut open = true;
    egui::Window::new(tr("Keyboard"))
        .open(&mut open)
        .collapsible(false)
        .resizable(false)
        .anchor(egui::Align2::CENTER_CENTER, egui::Vec2::ZERO)
        .show(ctx, |ui| {
            egui::Grid::new("shortcuts")
                .num_columns(2)
                // Nothing is pressed here, and all of it has room on a small screen.
                .min_row_height(0.0)
                .striped(true)
                .show(ui, |ui| {
                    for (key, title) in PAGES.iter().zip(titles) {
                        ui.strong(tr(key.symbol_or_name()));
                        ui.label(tr(*title));
                        ui.end_row();
                    }
                    for shortcut in &SHORTCUTS {
                        let named: Vec<String> = shortcut
                            .keys
                            .iter()
                            .map(|k| match k.logical_key {
                                Key::Questionmark => "?".to_owned(),
                                _ => ctx.format_shortcut(k),
                            })
                            .collect();
                        let said: Vec<String> = named.iter().map(|keys| tr(names(keys))).collect();
                        ui.strong(said.join(&format!("  {}  ", tr("or"))));
                        ui.label(tr(shortcut.sentence));
                        ui.end_row();
                    }
                });
            ui.separator();
            ui.label(tr(
                "Tab moves from control to control; the arrow keys move a slider.",
            ));
            ui.label(tr(
                "Double-click a slider, or press Delete, to reset it; click its number to type one.",
            ));
            ui.label(tr("Zoom a plot with Ctrl and the mouse wheel, with two fingers, or by dragging a box with the right button."));
            ui.label(tr(
                "A zoomed plot can be dragged; a double click shows all of it again.",
            ));
            ui.label(tr(
                "In a plot the arrow keys read off the curves, with Shift in larger steps; Up and Down go to the next curve.",
            ));
            ui.label(tr("There, + and - zoom, Ctrl with an arrow key moves the plot, Home shows all of it, Enter opens its menu and Escape leaves it."));
            ui.label(tr("Drop a file on the window to open it."));
        });
    open
}
