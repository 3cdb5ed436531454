//! Colours and sizes. One quantity has one colour everywhere (Okabe and Ito's colour-blind-safe set).

use egui::{Color32, FontId};

use crate::language::{Said, tr, tr_number};

/// What was measured.
pub const MEASURED: Color32 = Color32::from_rgb(0x56, 0xB4, 0xE9);
/// What the model says.
pub const MODEL: Color32 = Color32::from_rgb(0xD5, 0x5E, 0x00);
/// What the model before said.
pub const BEFORE: Color32 = Color32::from_rgb(0x00, 0x72, 0xB2);
/// The difference.
pub const RESIDUAL: Color32 = Color32::from_rgb(0xCC, 0x79, 0xA7);
/// The measurement noise.
pub const NOISE: Color32 = Color32::from_rgb(0x00, 0x9E, 0x73);
/// The relay's output.
pub const INPUT: Color32 = Color32::from_rgb(0xE6, 0x9F, 0x00);
/// What the describing function predicts.
pub const DESCRIBING: Color32 = Color32::from_rgb(0xE6, 0x9F, 0x00);
/// The exact solution.
pub const EXACT: Color32 = Color32::from_rgb(0x00, 0x9E, 0x73);
/// The simulation.
pub const SIMULATED: Color32 = Color32::from_rgb(0x56, 0xB4, 0xE9);
/// Where the model fails.
pub const SHADE: Color32 = Color32::from_rgb(0xF0, 0xE4, 0x42);

/// What is wrong, in dark words on a light ground.
const WARNING: Color32 = Color32::from_rgb(0xB0, 0x3A, 0x00);
const ERROR: Color32 = Color32::from_rgb(0xB4, 0x00, 0x00);

/// Sizes of what is read, of what stands small beside it and of what is typed, points, and the height of a capital in
/// them.
const BODY: f32 = 14.5;
const SMALL: f32 = 12.0;
const TYPED: f32 = 13.0;
const CAPITAL: f32 = 0.73;

/// Capitals that go one above the other into the width of a projector's picture: where that is 2 m, they are 25 mm
/// high. A low window has this height at least, points.
const CAPITALS: f32 = 80.0;
const LOWEST: f32 = 470.0;
const MOST_ZOOM: f32 = 8.0;

/// A change of the size that is seen.
const LEAST_CHANGE: f32 = 0.01;

/// How the app looks as a whole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Look {
    /// Light on dark.
    #[default]
    Dark,
    /// Dark on light.
    Light,
    /// Dark on white and everything larger, for the back row of a lecture hall.
    Projector,
}

impl Look {
    /// All of them, in the order of the menu.
    pub const ALL: [Self; 3] = [Self::Dark, Self::Light, Self::Projector];

    /// Its name in the menu and where it is kept.
    pub fn name(self) -> &'static str {
        match self {
            Self::Dark => "Dark",
            Self::Light => "Light",
            Self::Projector => "Projector",
        }
    }

    /// The look of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|l| l.name() == name)
    }

    /// That of the rest of the desktop.
    pub fn of_system(ctx: &egui::Context) -> Self {
        match ctx.system_theme() {
            Some(egui::Theme::Light) => Self::Light,
            _ => Self::Dark,
        }
    }

    /// The next one.
    pub fn next(self) -> Self {
        match self {
            Self::Dark => Self::Light,
            Self::Light => Self::Projector,
            Self::Projector => Self::Dark,
        }
    }

    /// How much larger everything is than usual in a window of this size, in points of the system: on a projector's
    /// screen a capital has the same height, however many points the screen has.
    fn zoom(self, size: egui::Vec2) -> f32 {
        if self == Self::Projector {
            let high = size.x / (CAPITALS * CAPITAL * BODY);
            high.min(size.y / LOWEST).clamp(1.0, MOST_ZOOM)
        } else {
            1.0
        }
    }

    /// Makes everything as large as the window wants it.
    pub fn fit(self, ctx: &egui::Context) {
        let zoom = self.zoom(ctx.content_rect().size() * ctx.zoom_factor());
        if (zoom / ctx.zoom_factor() - 1.0).abs() > LEAST_CHANGE {
            ctx.set_zoom_factor(zoom);
        }
    }

    /// Makes the app look so.
    pub fn apply(self, ctx: &egui::Context) {
        ctx.set_theme(match self {
            Self::Dark => egui::Theme::Dark,
            Self::Light | Self::Projector => egui::Theme::Light,
        });
        ctx.style_mut_of(egui::Theme::Light, |style| {
            let [text, ground, field] = match self {
                Self::Projector => [Color32::BLACK, Color32::WHITE, Color32::from_gray(236)],
                _ => [20, 248, 255].map(Color32::from_gray),
            };
            style.visuals.override_text_color = Some(text);
            style.visuals.panel_fill = ground;
            style.visuals.text_edit_bg_color = Some(field);
            // egui's orange is too faint on white.
            style.visuals.warn_fg_color = WARNING;
            style.visuals.error_fg_color = ERROR;
            // Nothing is small from the back row.
            let [small, typed] = match self {
                Self::Projector => [BODY; 2],
                _ => [SMALL, TYPED],
            };
            let styles = &mut style.text_styles;
            styles.insert(egui::TextStyle::Small, FontId::proportional(small));
            styles.insert(egui::TextStyle::Monospace, FontId::monospace(typed));
        });
        self.fit(ctx);
    }
}

/// Type sizes and spacing.
pub fn apply(ctx: &egui::Context) {
    // The default greys are too faint to read from afar.
    ctx.style_mut_of(egui::Theme::Dark, |style| {
        style.visuals.override_text_color = Some(Color32::from_gray(225));
        style.visuals.error_fg_color = Color32::from_rgb(0xFF, 0x70, 0x70);
    });
    ctx.all_styles_mut(|style| {
        use egui::TextStyle;
        for (text, size) in [
            (TextStyle::Body, BODY),
            (TextStyle::Button, BODY),
            (TextStyle::Small, SMALL),
            (TextStyle::Heading, 20.0),
        ] {
            style.text_styles.insert(text, FontId::proportional(size));
        }
        style.number_formatter = egui::style::NumberFormatter::new(|value, decimals| {
            tr_number(egui::emath::format_with_decimals_in_range(value, decimals))
        });
        style.spacing.item_spacing = egui::vec2(8.0, 6.0);
        style.spacing.button_padding = egui::vec2(10.0, 4.0);
        style.spacing.interact_size.y = ROW;
        style.spacing.slider_width = 150.0;
    });
}

/// Least height of what is pressed with a finger, points.
const FINGER: f32 = 40.0;

/// Height of a button of [`apply`]: all that stands in a row with one is as high, so that it stands at the same height.
const ROW: f32 = 25.0;

/// Makes what is pressed as large as a finger needs it, or as a mouse does.
pub fn fit_to_fingers(ctx: &egui::Context, fingers: bool) {
    let usual = egui::style::Spacing::default();
    ctx.all_styles_mut(|style| {
        let spacing = &mut style.spacing;
        if fingers {
            spacing.interact_size.y = FINGER;
            spacing.icon_width = 22.0;
            spacing.icon_width_inner = 13.0;
        } else {
            spacing.interact_size.y = ROW;
            spacing.icon_width = usual.icon_width;
            spacing.icon_width_inner = usual.icon_width_inner;
        }
    });
}

/// Text that goes on from line to line, with a button or two in it: its first line is no higher than the others.
pub fn running_text<R>(ui: &mut egui::Ui, text: impl FnOnce(&mut egui::Ui) -> R) -> R {
    ui.scope(|ui| {
        let pressed = std::mem::replace(&mut ui.spacing_mut().interact_size.y, 0.0);
        let row = ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().interact_size.y = pressed;
            text(ui)
        });
        row.inner
    })
    .inner
}

/// A field for a line of text; it stands in the middle of its height.
pub fn line(text: &mut String) -> egui::TextEdit<'_> {
    egui::TextEdit::singleline(text).align(egui::Align2::LEFT_CENTER)
}

/// What a page scrolls; by its own name, since pages stand in the same place and would scroll together. It is as wide
/// as its panel: a panel that was made wider stays so when there is little in it.
pub fn scroll(name: &str) -> egui::ScrollArea {
    egui::ScrollArea::vertical()
        .id_salt(name)
        .auto_shrink([false, true])
}

/// Draws a ring around what has the keyboard: plots and frameless buttons show nothing of it by themselves. A text
/// field has its caret.
pub fn focus_ring(ctx: &egui::Context) {
    let focused = ctx.memory(egui::Memory::focused);
    let Some(response) = focused.and_then(|id| ctx.read_response(id)) else {
        return;
    };
    if ctx.text_edit_focused() {
        return;
    }
    let color = ctx.global_style().visuals.selection.stroke.color;
    // What is scrolled away has no ring.
    let seen = response.interact_rect.expand(RING);
    ctx.layer_painter(response.layer_id)
        .with_clip_rect(seen)
        .rect_stroke(response.rect, 4.0, (RING, color), egui::StrokeKind::Outside);
}

/// Width of the ring around what has the keyboard, points.
const RING: f32 = 2.0;

/// Has the buttons that follow stand back behind the pages: without a ground until they are pointed at.
pub fn quiet(ui: &mut egui::Ui) {
    let widgets = &mut ui.visuals_mut().widgets;
    widgets.inactive.weak_bg_fill = Color32::TRANSPARENT;
    widgets.noninteractive.weak_bg_fill = Color32::TRANSPARENT;
}

/// Share of the colour of words that the lines of a grid have: they are fainter than any curve.
const GRID: f32 = 0.3;

/// Colour of the lines of a grid.
pub fn grid(visuals: &egui::Visuals) -> Color32 {
    visuals.text_color().gamma_multiply(GRID)
}

/// Height below which a window is low: one with few lines, as on a projector or a phone that lies on its side. There
/// the plots come first, points.
const LOW: f32 = 560.0;

/// Whether the window is low.
pub fn is_low(ctx: &egui::Context) -> bool {
    ctx.content_rect().height() < LOW
}

/// Size of the letters of a page's answer, where there is room for it and in a low window, points.
const ANSWER: f32 = 24.0;
const LOW_ANSWER: f32 = 20.0;

/// Size of the letters of a page's answer in this window, points.
pub fn answer_size(ctx: &egui::Context) -> f32 {
    if is_low(ctx) { LOW_ANSWER } else { ANSWER }
}

/// The large answer of a page.
pub fn answer_ui<'a>(ui: &mut egui::Ui, text: impl Into<Said<'a>>) {
    let text = egui::RichText::new(tr(text))
        .size(answer_size(ui.ctx()))
        .strong();
    let answer = ui.add(egui::Label::new(text).wrap());
    tell(&answer);
}

/// The same while the next one is computed for what is set now: it is fainter, and says so.
pub fn answer_of_before_ui<'a>(ui: &mut egui::Ui, text: impl Into<Said<'a>>) {
    let color = ui.visuals().weak_text_color();
    let text = egui::RichText::new(tr(text))
        .size(answer_size(ui.ctx()))
        .color(color);
    let answer = ui.add(egui::Label::new(text).wrap());
    tell(&answer);
    // Beside the next line, so that nothing moves while a slider is dragged.
    let at = egui::pos2(ui.max_rect().right(), answer.rect.bottom());
    let font = egui::TextStyle::Small.resolve(ui.style());
    let saying = tr("Computing for what is set now ...");
    let color = ui.visuals().text_color();
    ui.painter()
        .text(at, egui::Align2::RIGHT_TOP, saying, font, color);
}

/// Has a screen reader say a text whenever it changes, as soon as it says nothing else.
pub fn tell(text: &egui::Response) {
    text.ctx.accesskit_node_builder(text.id, |node| {
        node.set_live(egui::accesskit::Live::Polite);
    });
}

/// A curve's colour as text, which needs more contrast: lighter on a dark ground, darker on a light one.
pub fn readable(ui: &egui::Ui, color: Color32) -> Color32 {
    if ui.visuals().dark_mode {
        color.lerp_to_gamma(Color32::WHITE, 0.1)
    } else {
        color.lerp_to_gamma(Color32::BLACK, 0.4)
    }
}

/// Width of a button with its gap, points.
pub fn button_width(ui: &egui::Ui, name: &'static str) -> f32 {
    button_width_of(ui, &tr(name))
}

/// The same of a name in the language that is spoken.
pub fn button_width_of(ui: &egui::Ui, text: &str) -> f32 {
    let font = egui::TextStyle::Button.resolve(ui.style());
    let around = 2.0 * ui.spacing().button_padding.x + ui.spacing().item_spacing.x;
    text_width(ui, text.to_owned(), font) + around
}

/// Letters in a drawing: of this size, but none smaller than what is small elsewhere.
pub fn letters(ui: &egui::Ui, size: f32) -> FontId {
    let small = egui::TextStyle::Small.resolve(ui.style()).size;
    FontId::proportional(size.max(small))
}

/// Width of a text in one line, points.
pub fn text_width(ui: &egui::Ui, text: String, font: FontId) -> f32 {
    let color = Color32::PLACEHOLDER;
    ui.painter().layout_no_wrap(text, font, color).size().x
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance of a colour (WCAG 2.1).
    fn luminance(color: Color32) -> f32 {
        let part = |value: u8| {
            let c = f32::from(value) / 255.0;
            if c <= 0.040_45 {
                c / 12.92
            } else {
                ((c + 0.055) / 1.055).powf(2.4)
            }
        };
        0.2126 * part(color.r()) + 0.7152 * part(color.g()) + 0.0722 * part(color.b())
    }

    /// Contrast of a colour on a ground, 1 to 21.
    fn contrast(color: Color32, ground: Color32) -> f32 {
        let [a, b] = [ground.blend(color), ground].map(luminance);
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    fn visuals(look: Look) -> egui::Visuals {
        let ctx = egui::Context::default();
        apply(&ctx);
        look.apply(&ctx);
        let theme = match look {
            Look::Dark => egui::Theme::Dark,
            Look::Light | Look::Projector => egui::Theme::Light,
        };
        ctx.style_of(theme).visuals.clone()
    }

    #[test]
    fn words_stand_out_from_their_ground_in_each_look() {
        for look in Look::ALL {
            let visuals = visuals(look);
            let ground = visuals.panel_fill;
            for (what, color) in [
                ("text", visuals.text_color()),
                ("weak text", visuals.weak_text_color()),
                ("warning", visuals.warn_fg_color),
                ("error", visuals.error_fg_color),
            ] {
                let contrast = contrast(color, ground);
                assert!(contrast >= 4.5, "{}: {what} {contrast:.1}", look.name());
            }
        }
    }

    #[test]
    fn the_grid_is_fainter_than_any_curve() {
        for look in Look::ALL {
            let visuals = visuals(look);
            let ground = visuals.extreme_bg_color;
            let lines = contrast(grid(&visuals), ground);
            for curve in [MEASURED, MODEL, BEFORE, RESIDUAL, NOISE, INPUT] {
                let curve = contrast(curve, ground);
                assert!(curve > lines, "{}: {curve:.1} and {lines:.1}", look.name());
            }
        }
    }

    #[test]
    fn a_capital_is_25_millimetres_high_where_the_picture_is_2_metres_wide() {
        for [width, height] in [
            [1024.0, 768.0],
            [1280.0, 800.0],
            [1920.0, 1080.0],
            [3840.0, 2160.0],
        ] {
            let zoom = Look::Projector.zoom(egui::vec2(width, height));
            let capital = 0.73 * 14.5 * zoom * 2000.0 / width;
            assert!(capital > 24.99, "{width} x {height}: {capital} mm");
            assert!(height / zoom >= 470.0, "{width} x {height}: room for it");
        }
        // A phone is no projector's picture; a wide and low one is not filled by three lines.
        assert_eq!(Look::Projector.zoom(egui::vec2(390.0, 844.0)), 1.0);
        assert!(Look::Projector.zoom(egui::vec2(2560.0, 600.0)) < 1.3);
        assert_eq!(Look::Dark.zoom(egui::vec2(3840.0, 2160.0)), 1.0);
    }
}
