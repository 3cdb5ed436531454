//! The page as a vector picture: what egui has drawn, shape by shape.

use std::fmt::Write as _;

use egui::epaint::{ClippedShape, ColorMode, PathStroke, TextShape};
use egui::{Color32, FontFamily, Mesh, Pos2, Rect, Shape, Stroke};

/// The shapes of a layer at this place as an SVG file on this ground. Pictures made of pixels (the colours of a
/// parameter map) are left out: SVG is for lines and words.
pub fn picture<'a>(
    shapes: impl Iterator<Item = &'a ClippedShape>,
    size: Rect,
    ground: Color32,
) -> String {
    let mut svg = Svg::default();
    let mut clip = None;
    for clipped in shapes {
        let seen = clipped.clip_rect.intersect(size);
        let bounds = clipped.shape.visual_bounding_rect();
        if !seen.is_positive() || (bounds.is_finite() && !bounds.intersects(size)) {
            continue;
        }
        if clip != Some(clipped.clip_rect) {
            if clip.is_some() {
                svg.body.push_str("</g>\n");
            }
            svg.clip(clipped.clip_rect);
            clip = Some(clipped.clip_rect);
        }
        svg.shape(&clipped.shape);
    }
    if clip.is_some() {
        svg.body.push_str("</g>\n");
    }
    let (x, y, w, h) = (size.min.x, size.min.y, size.width(), size.height());
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{x} {y} {w} {h}\" width=\"{w}\" height=\"{h}\">\n\
         <rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" {}/>\n<defs>\n{}</defs>\n{}</svg>\n",
        paint("fill", ground),
        svg.clips,
        svg.body
    )
}

#[derive(Default)]
struct Svg {
    clips: String,
    number: usize,
    body: String,
}

impl Svg {
    /// Opens a group that draws within a rectangle.
    fn clip(&mut self, rect: Rect) {
        self.number += 1;
        let id = self.number;
        let _ = writeln!(
            self.clips,
            "<clipPath id=\"c{id}\">{}</clipPath>",
            rect_tag(rect, 0.0, "")
        );
        let _ = writeln!(self.body, "<g clip-path=\"url(#c{id})\">");
    }

    fn shape(&mut self, shape: &Shape) {
        match shape {
            Shape::Noop | Shape::Callback(_) => {}
            Shape::Vec(shapes) => shapes.iter().for_each(|s| self.shape(s)),
            Shape::Circle(c) => {
                let style = format!("{} {}", paint("fill", c.fill), stroke(c.stroke));
                let (x, y, r) = (c.center.x, c.center.y, c.radius);
                self.tag(
                    &format!("circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{r:.2}\""),
                    &style,
                );
            }
            Shape::Ellipse(e) => {
                let style = format!("{} {}", paint("fill", e.fill), stroke(e.stroke));
                let (x, y, rx, ry) = (e.center.x, e.center.y, e.radius.x, e.radius.y);
                let place =
                    format!("ellipse cx=\"{x:.2}\" cy=\"{y:.2}\" rx=\"{rx:.2}\" ry=\"{ry:.2}\"");
                self.tag(&place, &style);
            }
            Shape::LineSegment { points, stroke: s } => {
                self.path(points, false, "fill=\"none\"", &stroke(*s));
            }
            Shape::Path(p) => self.filled(&p.points, p.closed, p.fill, &p.stroke),
            Shape::Band(b) => {
                let upper = b.points.iter().map(|p| Pos2::new(p.x, p.y.min));
                let lower = b.points.iter().rev().map(|p| Pos2::new(p.x, p.y.max));
                let points: Vec<Pos2> = upper.chain(lower).collect();
                self.path(&points, true, &paint("fill", b.fill), &stroke(b.stroke));
            }
            Shape::Rect(r) => {
                let style = format!("{} {}", paint("fill", r.fill), stroke(r.stroke));
                let corner = f32::from(r.corner_radius.nw);
                let tag = rect_tag(r.rect, corner, &style);
                self.body.push_str(&tag);
                self.body.push('\n');
            }
            Shape::Text(t) => self.text(t),
            Shape::Mesh(mesh) => self.mesh(mesh),
            Shape::QuadraticBezier(b) => {
                self.filled(&b.flatten(None), b.closed, b.fill, &b.stroke);
            }
            Shape::CubicBezier(b) => {
                self.filled(&b.flatten(None), b.closed, b.fill, &b.stroke);
            }
        }
    }

    fn tag(&mut self, start: &str, style: &str) {
        let _ = writeln!(self.body, "<{start} {style}/>");
    }

    fn path(&mut self, points: &[Pos2], closed: bool, fill: &str, stroke: &str) {
        let mut d = String::new();
        for (i, p) in points.iter().enumerate() {
            let command = if i == 0 { 'M' } else { 'L' };
            let _ = write!(d, "{command}{:.2} {:.2}", p.x, p.y);
        }
        if closed {
            d.push('Z');
        }
        self.tag(&format!("path d=\"{d}\""), &format!("{fill} {stroke}"));
    }

    fn filled(&mut self, points: &[Pos2], closed: bool, fill: Color32, stroke: &PathStroke) {
        self.path(points, closed, &paint("fill", fill), &path_stroke(stroke));
    }

    /// Triangles of one colour each; a mesh with a texture is a picture of pixels.
    fn mesh(&mut self, mesh: &Mesh) {
        if mesh.texture_id != egui::TextureId::default() {
            return;
        }
        for triangle in mesh.indices.chunks_exact(3) {
            let corners: Vec<_> = triangle
                .iter()
                .filter_map(|i| mesh.vertices.get(*i as usize))
                .collect();
            if let Some(first) = corners.first() {
                let points: Vec<Pos2> = corners.iter().map(|v| v.pos).collect();
                self.path(&points, true, &paint("fill", first.color), "");
            }
        }
    }

    /// Words, row by row, each as wide as on the screen whatever font the reader has.
    fn text(&mut self, text: &TextShape) {
        let sections = &text.galley.job.sections;
        let Some(format) = sections.first().map(|s| &s.format) else {
            return;
        };
        let plain = if format.color == Color32::PLACEHOLDER {
            text.fallback_color
        } else {
            format.color
        };
        let color = text.override_text_color.unwrap_or(plain);
        let family = match format.font_id.family {
            FontFamily::Monospace => "monospace",
            _ => "sans-serif",
        };
        for row in &text.galley.rows {
            // Nothing breaks here any more.
            let space = |c| if c == '\u{a0}' { ' ' } else { c };
            let words: String = row.glyphs.iter().map(|g| space(g.chr)).collect();
            let Some(first) = row.glyphs.first().filter(|_| !words.trim().is_empty()) else {
                continue;
            };
            let at = row.pos + first.pos.to_vec2();
            // The row itself also has the space before its first word.
            let last = row.glyphs.last().unwrap_or(first);
            let width = last.pos.x + last.advance_width - first.pos.x;
            let turn = if text.angle == 0.0 {
                String::new()
            } else {
                format!(" rotate({:.2})", text.angle.to_degrees())
            };
            let _ = writeln!(
                self.body,
                "<text transform=\"translate({:.2} {:.2}){turn}\" x=\"{:.2}\" y=\"{:.2}\" font-family=\"{family}\" \
                 font-size=\"{}\" textLength=\"{:.2}\" lengthAdjust=\"spacingAndGlyphs\" {}>{}</text>",
                text.pos.x,
                text.pos.y,
                at.x,
                at.y,
                format.font_id.size,
                width,
                paint("fill", color),
                escaped(&words)
            );
        }
    }
}

fn rect_tag(rect: Rect, corner: f32, style: &str) -> String {
    let (x, y, w, h) = (
        rect.min.x,
        rect.min.y,
        rect.width().max(0.0),
        rect.height().max(0.0),
    );
    format!(
        "<rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"{w:.2}\" height=\"{h:.2}\" rx=\"{corner}\" {style}/>"
    )
}

/// A colour as an attribute.
fn paint(name: &str, color: Color32) -> String {
    let [r, g, b, a] = color.to_srgba_unmultiplied();
    match a {
        0 => format!("{name}=\"none\""),
        255 => format!("{name}=\"#{r:02x}{g:02x}{b:02x}\""),
        _ => format!(
            "{name}=\"#{r:02x}{g:02x}{b:02x}\" {name}-opacity=\"{:.3}\"",
            f32::from(a) / 255.0
        ),
    }
}

fn stroke(stroke: Stroke) -> String {
    if stroke.is_empty() {
        return String::new();
    }
    format!(
        "{} stroke-width=\"{}\"",
        paint("stroke", stroke.color),
        stroke.width
    )
}

fn path_stroke(path: &PathStroke) -> String {
    match path.color {
        ColorMode::Solid(color) => stroke(Stroke::new(path.width, color)),
        ColorMode::UV(_) => String::new(),
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}
