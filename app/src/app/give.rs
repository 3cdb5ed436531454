//! What the app gives away: pictures and numbers, of a page and of a plot.

use std::sync::mpsc::Sender;

use egui::{Context, Rect};
use hysteron_core::message::Message;

use super::HysteronApp;
use crate::export::{self, Table};
use crate::save::{self, GivenFile};
use crate::widgets::chart_menu::{self, Form, Given};

/// Where files go.
#[derive(Clone)]
struct Exit {
    said: Sender<Message>,
    diverted: Option<Sender<GivenFile>>,
}

impl Exit {
    fn text(&self, ctx: &Context, document: save::Document) {
        match &self.diverted {
            // Who has diverted them and is gone wants none.
            Some(there) => drop(there.send((document.name, document.text.into_bytes()))),
            None => save::save(ctx, document, &self.said),
        }
    }

    fn picture(&self, ctx: &Context, name: &str, bytes: Vec<u8>) {
        match &self.diverted {
            Some(there) => drop(there.send((format!("{name}.png"), bytes))),
            None => save::save_png(ctx, name, bytes, &self.said),
        }
    }
}

impl HysteronApp {
    /// Sends files here that would be saved by a dialog or as a download.
    pub fn divert_files(&mut self, there: Sender<GivenFile>) {
        self.diverted = Some(there);
    }

    fn exit(&self) -> Exit {
        Exit {
            said: self.said.0.clone(),
            diverted: self.diverted.clone(),
        }
    }

    /// The page in front as a picture of lines; to be asked for within the frame, after drawing.
    pub fn svg(&self, ui: &egui::Ui) -> String {
        picture(ui, ui.ctx().content_rect())
    }

    /// The numbers behind the page in front.
    pub fn tables(&self) -> Vec<Table> {
        let front = self.pages.get(self.front);
        front.map_or_else(Vec::new, |p| p.view.offer().tables.all())
    }

    pub(super) fn save_text(&self, ctx: &Context, document: save::Document) {
        self.exit().text(ctx, document);
    }

    pub(super) fn save_svg(&self, ui: &egui::Ui, name: &str, place: Rect) {
        let document = save::Document {
            name: format!("{name}.svg"),
            kind: "Picture",
            media: "image/svg+xml",
            text: picture(ui, place),
        };
        self.exit().text(ui.ctx(), document);
    }

    pub(super) fn save_png(&self, ctx: &Context, name: &str, place: Rect) {
        let (exit, again, name) = (self.exit(), ctx.clone(), name.to_owned());
        let scale = ctx.pixels_per_point();
        ctx.request_screenshot(move |image| {
            let size = egui::vec2(image.width() as f32, image.height() as f32) / scale;
            let place = place.intersect(Rect::from_min_size(egui::Pos2::ZERO, size));
            let part = place
                .is_positive()
                .then(|| image.region(&place, Some(scale)));
            exit.picture(&again, &name, export::png(part.as_ref().unwrap_or(&image)));
        });
    }

    pub(super) fn save_table(&self, ctx: &Context, name: &str, table: &Table) {
        let document = save::Document {
            name: format!("{name}.csv"),
            kind: "Table",
            media: "text/csv;charset=utf-8",
            text: table.csv(),
        };
        self.exit().text(ctx, document);
    }

    /// Gives what the menu of a plot was asked for; after drawing.
    pub(super) fn give_plots(&self, ui: &egui::Ui) {
        let Some(given) = chart_menu::given(ui.ctx()) else {
            return;
        };
        let name = self.name_of(&given);
        match given.form {
            Form::Svg => self.save_svg(ui, &name, given.place),
            Form::Png => self.save_png(ui.ctx(), &name, given.place),
            Form::Csv => {
                // A picture has no curves: its numbers are those of its page.
                let own = given.table.filter(|t| !t.columns.is_empty());
                if let Some(table) = own.or_else(|| self.tables().into_iter().next()) {
                    self.save_table(ui.ctx(), &name, &table);
                }
            }
        }
    }

    /// Such as `explore-output-y-over-time`.
    fn name_of(&self, given: &Given) -> String {
        let page = self.pages.get(self.front).map_or("", |p| p.id);
        let [x, y] = &given.axes;
        let plain = |axis: &str| {
            let name = axis.split(" [").next().unwrap_or_default();
            let words = name.split(|c: char| !c.is_alphanumeric());
            words
                .filter(|w| !w.is_empty())
                .collect::<Vec<_>>()
                .join("-")
        };
        format!("{page}-{}-over-{}", plain(y), plain(x))
    }
}

/// What is drawn at a place of the page, as lines and words.
fn picture(ui: &egui::Ui, place: Rect) -> String {
    let ground = ui.visuals().panel_fill;
    ui.ctx().graphics(|graphics| {
        let shapes = graphics
            .get(ui.layer_id())
            .into_iter()
            .flat_map(egui::layers::PaintList::all_entries);
        export::svg(shapes, place, ground)
    })
}
