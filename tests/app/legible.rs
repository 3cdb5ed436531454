//! Whether what is said can be read: contrast on what lies beneath it, and size on a projector's picture.

use std::collections::BTreeSet;

use crate::support::ui::{App, TALL, app, show, wear};
use egui::epaint::{Color32, Shape, TextShape};
use egui::{Pos2, Rect};
use egui_kittest::kittest::NodeT as _;

/// A projector's picture, points of the system, and how wide it hangs on the wall, mm.
const PICTURE: [f32; 2] = [1920.0, 1080.0];
const WALL: f32 = 2000.0;

/// Height of a capital as a share of the size of its letters.
const CAPITAL: f32 = 0.73;

/// Least height of a capital on the wall, and of one in an index or an exponent, mm.
const READ: f32 = 25.0;
const SCRIPT: f32 = 15.0;

/// Contrast that small text needs (WCAG 2.2, 1.4.3).
const READABLE: f32 = 4.5;

/// Every page, and some in other states.
const PLACES: [&str; 19] = [
    "v1;start;start.paused=20",
    "v1;lessons",
    "v1;explore;explore.paused=20;explore.margin=true",
    "v1;explore;explore.figure=3",
    "v1;explore;loop.relay.hysteresis=0;loop.plant.denominator=1,1",
    "v1;explore;explore.controller=three_positions",
    "v1;explore;explore.controller=servo",
    "v1;maps",
    "v1;tune",
    "v1;tune;tune.step=rules",
    "v1;tune;tune.step=loops",
    "v1;tune;tune.measured.from=record;tune.measured.file=process-02",
    "v1;backlash;backlash.paused=1",
    "v1;backlash;backlash.figure=7",
    "v1;mystery",
    "v1;mystery;mystery.by_hand=true",
    "v1;compare",
    "v1;compare;compare.file=drive-02",
    "v1;compare;compare.file=drive-02;compare.effects=%5B%22coulomb_friction%22%5D",
];

/// Relative luminance (WCAG 2.2).
fn luminance(color: Color32) -> f32 {
    let [r, g, b] = [color.r(), color.g(), color.b()].map(|v| {
        let v = f32::from(v) / 255.0;
        if v <= 0.04045 {
            v / 12.92
        } else {
            ((v + 0.055) / 1.055).powf(2.4)
        }
    });
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

fn contrast(a: Color32, b: Color32) -> f32 {
    let (a, b) = (luminance(a), luminance(b));
    (a.max(b) + 0.05) / (a.min(b) + 0.05)
}

/// All that was painted in the last frame, in its order, and where it was cut off.
fn painted(harness: &App) -> Vec<(Rect, Shape)> {
    fn collect(clip: Rect, shape: &Shape, all: &mut Vec<(Rect, Shape)>) {
        match shape {
            Shape::Vec(shapes) => shapes.iter().for_each(|s| collect(clip, s, all)),
            shape => all.push((clip, shape.clone())),
        }
    }
    let mut all = Vec::new();
    for clipped in &harness.output().shapes {
        collect(clipped.clip_rect, &clipped.shape, &mut all);
    }
    all
}

/// Texts in view with the ground on which each stands. Over a picture of many colours there is none.
fn texts(harness: &App) -> Vec<(TextShape, Color32)> {
    let panel = harness.ctx.global_style().visuals.panel_fill;
    let mut below: Vec<(Rect, Option<Color32>)> = Vec::new();
    let mut texts = Vec::new();
    for (clip, shape) in painted(harness) {
        match shape {
            Shape::Rect(rect) => below.push((clip.intersect(rect.rect), Some(rect.fill))),
            Shape::Mesh(mesh) => below.push((clip.intersect(mesh.calc_bounds()), None)),
            Shape::Text(text) => {
                let at: Pos2 = text.visual_bounding_rect().center();
                let mut grounds = below.iter().filter(|(rect, _)| rect.contains(at));
                let ground =
                    grounds.try_fold(panel, |ground, (_, fill)| Some(ground.blend((*fill)?)));
                let said = !text.galley.job.text.trim().is_empty();
                if let Some(ground) = ground.filter(|_| said && clip.contains(at)) {
                    texts.push((text, ground));
                }
            }
            _ => {}
        }
    }
    texts
}

/// The colour in which a text stands on its ground.
fn color(text: &TextShape, ground: Color32) -> Color32 {
    let format = text.galley.job.sections.first().map(|s| s.format.color);
    let own = format.filter(|color| *color != Color32::PLACEHOLDER);
    let color = text.override_text_color.or(own);
    let color = color.unwrap_or(text.fallback_color);
    ground.blend(color.gamma_multiply(text.opacity_factor))
}

/// Places of what cannot be pressed now, which is fainter for that.
fn disabled(harness: &App) -> Vec<Rect> {
    let nodes = harness.root().children_recursive();
    let nodes = nodes.filter(|n| n.accesskit_node().is_disabled());
    nodes.map(|n| n.rect().expand(2.0)).collect()
}

/// Texts that do not stand out from what lies beneath them.
fn faint(harness: &App) -> BTreeSet<String> {
    let disabled = disabled(harness);
    let faint = texts(harness).into_iter().filter_map(|(text, ground)| {
        let at = text.visual_bounding_rect().center();
        if disabled.iter().any(|rect| rect.contains(at)) {
            return None;
        }
        let color = color(&text, ground);
        let contrast = contrast(color, ground);
        let words = &text.galley.job.text;
        (contrast < READABLE).then(|| format!("{words}: {color:?} on {ground:?}, {contrast:.1}"))
    });
    faint.collect()
}

#[test]
fn every_text_stands_out_from_what_lies_beneath_it_in_every_look() {
    for look in ["Dark", "Light", "Projector"] {
        let mut harness = app("start", PICTURE);
        wear(&mut harness, look);
        for place in PLACES {
            show(&mut harness, place);
            let count = texts(&harness).len();
            assert!(count > 15, "{look}: {place}: {count} texts");
            assert_eq!(faint(&harness), BTreeSet::new(), "{look}: {place}");
        }
    }
}

#[test]
fn warnings_stand_out_from_every_ground() {
    for look in ["Dark", "Light", "Projector"] {
        let mut harness = app("start", TALL);
        wear(&mut harness, look);
        let visuals = harness.ctx.global_style().visuals.clone();
        for color in [visuals.warn_fg_color, visuals.error_fg_color] {
            for ground in [
                visuals.panel_fill,
                visuals.window_fill,
                visuals.faint_bg_color,
            ] {
                if ground.a() == 255 {
                    let contrast = contrast(color, ground);
                    assert!(contrast >= READABLE, "{look}: {color:?}: {contrast}");
                }
            }
        }
    }
}

/// A part of a typeset equation: its indices and exponents are smaller.
fn is_script(text: &str) -> bool {
    text.chars().count() <= 8 && !text.contains(' ')
}

#[test]
fn on_a_projectors_picture_everything_is_read_from_the_back_row() {
    let mut harness = app("start", PICTURE);
    wear(&mut harness, "Projector");
    let mut small = BTreeSet::new();
    for place in PLACES {
        show(&mut harness, place);
        let millimetres = CAPITAL * harness.ctx.zoom_factor() * WALL / PICTURE[0];
        for (text, _) in texts(&harness) {
            let words = &text.galley.job.text;
            let sections = text.galley.job.sections.iter();
            let sizes = sections.map(|section| section.format.font_id.size);
            let height = millimetres * sizes.fold(f32::INFINITY, f32::min);
            let least = if is_script(words) { SCRIPT } else { READ };
            if height < least - 0.01 {
                small.insert(format!("{place}: {words}: {height:.1} mm"));
            }
        }
    }
    assert!(small.is_empty(), "{small:#?}");
}
