//! What a plot gives away: its picture and its numbers. Its menu notes the wish; the next frame, in which no
//! menu covers the plot, fulfils it.

use egui::{Context, Id, Pos2, Rect, UiBuilder, Vec2, vec2};
use hysteron_core::message::Message;
use hysteron_core::msg;

use crate::export::Table;
use crate::language::tr;

/// Size of the ground of the button's dots and how far that is below the middle of it, points; and how much it covers of
/// what lies beneath.
const DOTS: Vec2 = vec2(22.0, 12.0);
const DOTS_BELOW: Vec2 = vec2(0.0, 4.0);
const GROUND: f32 = 0.8;

/// Least side of the button of a menu, points.
const BUTTON: f32 = 24.0;

/// What may be asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    Png,
    Svg,
    Csv,
}

impl Form {
    const ALL: [(Self, &'static str); 3] = [
        (Self::Png, "Picture of this plot (PNG)"),
        (Self::Svg, "Picture of this plot (SVG)"),
        (Self::Csv, "Data of this plot (CSV)"),
    ];
}

/// A plot that was asked for.
#[derive(Clone, Debug)]
pub struct Given {
    pub form: Form,
    /// Its axes, in English; they are the name of the file.
    pub axes: [String; 2],
    /// Where it is, points.
    pub place: Rect,
    /// Its curves, if its numbers were asked for.
    pub table: Option<Table>,
}

/// The axes of the plots on the screen, and what was asked of which.
#[derive(Clone, Debug, Default)]
struct Plots {
    axes: Vec<[String; 2]>,
    wish: Option<(Id, Form)>,
    given: Option<Given>,
}

fn with<R>(ctx: &Context, act: impl FnOnce(&mut Plots) -> R) -> R {
    ctx.data_mut(|data| act(data.get_temp_mut_or_default(Id::unique("plots"))))
}

/// Forgets the plots of the last frame.
pub fn clear(ctx: &Context) {
    with(ctx, |plots| plots.axes.clear());
}

/// The axes of the plots of this frame, x and y, in English.
pub fn axes(ctx: &Context) -> Vec<[String; 2]> {
    with(ctx, |plots| plots.axes.clone())
}

/// The plot that was asked for, once.
pub fn given(ctx: &Context) -> Option<Given> {
    with(ctx, |plots| plots.given.take())
}

/// Whether the numbers of a plot are wished for.
pub fn wants_numbers(ctx: &Context, plot: Id) -> bool {
    with(ctx, |plots| plots.wish == Some((plot, Form::Csv)))
}

/// Whether anything of a plot is wished for.
pub fn wished(ctx: &Context, plot: Id) -> bool {
    with(ctx, |plots| {
        plots.wish.is_some_and(|(wished, _)| wished == plot)
    })
}

/// Draws the menu of a plot in its lower right corner, opens it if it is asked for, and gives what was wished for.
pub fn ui(
    ui: &mut egui::Ui,
    plot: Id,
    axes: &[Message; 2],
    start: Pos2,
    inner: Rect,
    (table, asked): (Option<Table>, bool),
) {
    let ctx = ui.ctx().clone();
    with(&ctx, |plots| {
        let english = axes.each_ref().map(Message::to_string);
        plots.axes.push(english.clone());
        if let Some((_, form)) = plots.wish.take_if(|(wished, _)| *wished == plot) {
            // Labels of the last ticks reach a little beyond the frame; those of x stand below it.
            let end = inner.max + vec2(10.0, 44.0);
            plots.given = Some(Given {
                form,
                axes: english,
                place: Rect::from_min_max(start, end),
                table,
            });
        }
    });
    let side = ui.spacing().interact_size.y.max(BUTTON);
    let corner = Rect::from_min_max(inner.max - vec2(side, side), inner.max);
    // On a ground of its own: three dots on a curve would be read as data.
    let ground = ui.visuals().extreme_bg_color.gamma_multiply(GROUND);
    let dots = Rect::from_center_size(corner.center() + DOTS_BELOW, DOTS);
    ui.painter().rect_filled(dots, 4.0, ground);
    let mut child = ui.new_child(UiBuilder::new().id_salt(plot).max_rect(corner));
    child.spacing_mut().button_padding = vec2(2.0, 0.0);
    child.spacing_mut().item_spacing = vec2(0.0, 0.0);
    let name = tr(msg!("Menu of the plot: {} over {}", &axes[1], &axes[0]));
    let button = egui::Button::new(egui::RichText::new("…").size(18.0))
        .frame(false)
        .min_size(vec2(side, side));
    let (response, _) =
        egui::containers::menu::MenuButton::from_button(button).ui(&mut child, |ui| {
            for (form, label) in Form::ALL {
                if ui.button(tr(label)).clicked() {
                    with(&ctx, |plots| plots.wish = Some((plot, form)));
                    ctx.request_repaint();
                    ui.close();
                }
            }
        });
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &name));
    if asked {
        // The next Tab goes to the first of its lines.
        response.request_focus();
        egui::Popup::open_id(&ctx, egui::Popup::default_response_id(&response));
    }
    response.on_hover_text(tr("Save this plot"));
}
