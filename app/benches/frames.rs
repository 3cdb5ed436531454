//! How much work of its own a frame takes while someone drags: every slider and every number of every page in turn, and
//! the pointer, the wheel and a drag over what is only looked at, 60 frames a second, so that what runs beside them has
//! time to bring its results; and the shapes cut into triangles, as for a software rasteriser. What paints them is not
//! measured; nor, on Linux, is the time that the thread waited for a processor. What else the machine did meanwhile is
//! no work of the app: so a drag with a frame above 16 ms is made again, and counts as slow if it is so every time. Of
//! each page it prints the median, 95 % and 99 % of the frames and the worst, and the last two as shares of 8 and of 16
//! ms; it fails at none.
//!
//! ```text
//! cargo bench -p hysteron --bench frames
//! cargo bench -p hysteron --bench frames -- --short   some sliders and numbers of every page, in fewer frames
//! ```

use std::time::{Duration, Instant};

use egui::accesskit::{Node, TreeUpdate};
use egui::{
    Context, Event, Modifiers, MouseWheelSource, MouseWheelUnit, PointerButton, Pos2, RawInput,
    Rect, Role, TouchPhase, Vec2,
};
use hysteron::HysteronApp;

/// The window: so tall that most controls are in view, points.
const WINDOW: Vec2 = Vec2::new(1280.0, 1400.0);

/// How much is measured.
#[derive(Clone, Copy)]
struct Extent {
    /// Frames of a drag from one end to the other.
    frames: usize,
    /// Times that a drag is made before it counts as slow.
    tries: usize,
    /// Most sliders and numbers of a page; of more, some from top to bottom.
    controls: usize,
}

const FULL: Extent = Extent {
    frames: 40,
    tries: 4,
    controls: usize::MAX,
};
const SHORT: Extent = Extent {
    frames: 8,
    tries: 3,
    controls: 8,
};

/// What is slow, and what 99 frames of 100 shall stay below: half of a picture is for what paints it.
const SLOW: Duration = Duration::from_millis(16);
const USUAL: Duration = Duration::from_millis(8);

/// Frames, and the time between them, that what was opened is given to be computed.
const SETTLE: usize = 400;
const PAUSE: Duration = Duration::from_millis(5);

/// Time between two pictures at 60 a second.
const FRAME: Duration = Duration::from_micros(16_667);

/// What is opened: a name, a link, and buttons that are pressed then.
type Place = (&'static str, &'static str, &'static [&'static str]);

/// Every slider and number there is dragged.
const PLACES: [Place; 18] = [
    ("start", "v1;start", &[]),
    ("explore", "v1;explore", &[]),
    ("explore, Fig. 5", "v1;explore;explore.figure=5", &[]),
    (
        "explore, on and off",
        "v1;explore;explore.controller=three_positions",
        &[],
    ),
    ("explore, servo", "v1;explore;explore.controller=servo", &[]),
    ("maps", "v1;maps", &[]),
    ("tune, relay", "v1;tune", &[]),
    ("tune, ultimate gain", "v1;tune;tune.step=ultimate", &[]),
    ("tune, phase margin", "v1;tune;tune.step=adaptation", &[]),
    ("tune, model", "v1;tune;tune.step=model", &[]),
    ("tune, rules", "v1;tune;tune.step=rules", &[]),
    ("tune, loops", "v1;tune;tune.step=loops", &[]),
    ("tune, numbers", "v1;tune;tune.measured.from=numbers", &[]),
    ("backlash", "v1;backlash", &[]),
    (
        "backlash, measured",
        "v1;backlash;backlash.file=drive-10",
        &[],
    ),
    (
        "mystery, drive",
        "v1;mystery;mystery.by_hand=true",
        &[
            "mystery:hide:coulomb_friction",
            "mystery:hide:input_delay",
            "mystery:hide:cogging",
        ],
    ),
    (
        "mystery, process",
        "v1;mystery;mystery.by_hand=true;mystery.experiment=%22process_stairs%22",
        &["mystery:hide:saturation", "mystery:hide:input_delay"],
    ),
    // Its parameters are set by hand.
    ("compare, by hand", DIAGNOSIS, &["look:time"]),
];

/// A measurement with its model.
const DIAGNOSIS: &str =
    "v1;compare;compare.file=drive-02;compare.effects=%5B%22coulomb_friction%22%5D";

/// There the pointer goes over the page, the wheel turns, and the plots are dragged.
const LOOKS: [Place; 10] = [
    ("explore, plots", "v1;explore", &[]),
    ("maps, plots", "v1;maps", &[]),
    ("lessons", "v1;lessons", &[]),
    (
        "tune, measured",
        "v1;tune;tune.measured.from=record;tune.measured.file=process-02",
        &[],
    ),
    ("backlash, plots", "v1;backlash", &[]),
    ("compare, over time", DIAGNOSIS, &["look:time"]),
    (
        "compare, beside before",
        DIAGNOSIS,
        &["look:time", "before"],
    ),
    ("compare, places", DIAGNOSIS, &["look:places"]),
    ("compare, fingerprint", DIAGNOSIS, &["look:fingerprint"]),
    ("mystery, list", "v1;mystery;mystery.by_hand=true", &[]),
];

/// What is said of a measurement that is opened.
const OPENING: &str = "compare, opening";

/// Lines from the left to the right on which the pointer goes over a page, and how far the wheel turns in a frame.
const LINES: usize = 8;
const WHEEL: f32 = 30.0;

/// An app in a window of its own.
struct Bench {
    ctx: Context,
    app: HysteronApp,
    extent: Extent,
    time: f64,
    frames: Vec<Duration>,
}

impl Bench {
    fn new(link: &str, buttons: &[&str], extent: Extent) -> Self {
        let mut bench = Self {
            ctx: Context::default(),
            app: HysteronApp::default(),
            extent,
            time: 0.0,
            frames: Vec::new(),
        };
        bench.frame(Vec::new());
        let opened = bench.app.open_link(&bench.ctx, link);
        assert_eq!(opened, Ok(()), "{link}");
        bench.settle();
        while bench.app.hook_state()["busy"] == true && !buttons.is_empty() {
            bench.settle();
        }
        for button in buttons {
            bench.press(button);
        }
        bench
    }

    /// One frame; its work is noted.
    fn frame(&mut self, events: Vec<Event>) -> Option<TreeUpdate> {
        self.time += FRAME.as_secs_f64();
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, WINDOW)),
            time: Some(self.time),
            events,
            ..RawInput::default()
        };
        let (begin, waited) = (Instant::now(), waited());
        let mut output = self.ctx.run_ui(input, |ui| self.app.frame_ui(ui));
        let triangles = self.ctx.tessellate(output.shapes, output.pixels_per_point);
        let elapsed = begin.elapsed();
        self.frames
            .push(elapsed.saturating_sub(self::waited().saturating_sub(waited)));
        drop(triangles);
        // Nothing is painted.
        output.textures_delta.clear();
        output.platform_output.accesskit_update
    }

    /// Waits until nothing is computed any more; the estimate of a gap may go on beside the drag.
    fn settle(&mut self) {
        for _ in 0..SETTLE {
            self.frame(Vec::new());
            if self.app.hook_state()["busy"] == false {
                return;
            }
            std::thread::sleep(PAUSE);
        }
    }

    /// The controls that can be dragged: their names and places.
    fn controls(&mut self) -> Vec<(String, Rect)> {
        self.ctx.enable_accesskit();
        self.frame(Vec::new());
        let tree = self.frame(Vec::new());
        self.ctx.disable_accesskit();
        let nodes = tree.map(|t| t.nodes).unwrap_or_default();
        let window = Rect::from_min_size(Pos2::ZERO, WINDOW);
        // A control is named by itself or by the label beside it.
        let named = |node: &Node| {
            let beside = node.labelled_by().first();
            let label = beside.and_then(|id| nodes.iter().find(|(i, _)| i == id));
            let name = node
                .label()
                .or(label.and_then(|(_, l)| l.value().or(l.label())));
            format!("{:?} {}", node.role(), name.unwrap_or_default())
        };
        let draggable = |node: &Node| matches!(node.role(), Role::Slider | Role::SpinButton);
        nodes
            .iter()
            .filter(|(_, node)| draggable(node))
            .filter_map(|(_, node)| {
                let b = node.bounds()?;
                let [x0, y0, x1, y1] = [b.x0, b.y0, b.x1, b.y1].map(|v| v as f32);
                let place = Rect::from_min_max(Pos2::new(x0, y0), Pos2::new(x1, y1));
                window.contains_rect(place).then(|| (named(node), place))
            })
            .collect()
    }

    /// Drags from the left end of a place to its right end; the times of the frames.
    fn drag(&mut self, place: Rect) -> Vec<Duration> {
        let at = |share: f32| Pos2::new(place.left() + share * place.width(), place.center().y);
        self.pull(|share| at(0.02 + 0.96 * share))
    }

    /// Drags to the right and back again, on a plot if there is one.
    fn sway(&mut self, at: f32) -> Vec<Duration> {
        let y = 0.4 * WINDOW.y;
        self.pull(|share| {
            let way = 1.0 - (2.0 * share - 1.0).abs();
            Pos2::new((at + 0.1 * way) * WINDOW.x, y)
        })
    }

    /// The frames of a drag along a path.
    fn pull(&mut self, path: impl Fn(f32) -> Pos2) -> Vec<Duration> {
        self.frame(vec![Event::PointerMoved(path(0.0))]);
        self.frame(vec![button(path(0.0), true)]);
        let frames = self.paced(|share| Event::PointerMoved(path(share)));
        self.frame(vec![button(path(1.0), false)]);
        frames
    }

    /// The frames of a movement: an event for every picture.
    fn paced(&mut self, event: impl Fn(f32) -> Event) -> Vec<Duration> {
        self.frames.clear();
        let begin = Instant::now();
        let frames = self.extent.frames;
        for i in 1..=frames {
            // The window waits for the next picture.
            std::thread::sleep((FRAME * i as u32).saturating_sub(begin.elapsed()));
            self.frame(vec![event(i as f32 / frames as f32)]);
        }
        std::mem::take(&mut self.frames)
    }

    /// Presses a button by its name in the state for tests.
    fn press(&mut self, name: &str) {
        let at = self.app.hook_state()["targets"][name].clone();
        let [x, y] = [0, 1].map(|i| at[i].as_f64().expect("a button") as f32);
        let at = Pos2::new(x, y);
        for event in [Event::PointerMoved(at), button(at, true), button(at, false)] {
            self.frame(vec![event]);
        }
        self.settle();
    }

    /// The pointer goes over the page on a line.
    fn hover(&mut self, line: usize) -> Vec<Duration> {
        let y = WINDOW.y * (line as f32 + 0.5) / LINES as f32;
        self.paced(|share| Event::PointerMoved(Pos2::new(share * WINDOW.x, y)))
    }

    /// The wheel turns where the pointer is, down and up again.
    fn turn(&mut self, at: f32) -> Vec<Duration> {
        self.frame(vec![Event::PointerMoved(Pos2::new(
            at * WINDOW.x,
            0.6 * WINDOW.y,
        ))]);
        self.paced(|share| Event::MouseWheel {
            unit: MouseWheelUnit::Point,
            delta: Vec2::new(0.0, if share < 0.5 { -WHEEL } else { WHEEL }),
            source: MouseWheelSource::Wheel,
            phase: TouchPhase::Move,
            modifiers: Modifiers::NONE,
        })
    }
}

/// The pointer's button goes down or up.
fn button(pos: Pos2, pressed: bool) -> Event {
    Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    }
}

/// The frames of the first movement without a slow one, else of the last.
fn least(extent: Extent, mut movement: impl FnMut() -> Vec<Duration>) -> Vec<Duration> {
    let mut frames = Vec::new();
    for _ in 0..extent.tries {
        frames = movement();
        if frames.iter().all(|f| *f <= SLOW) {
            break;
        }
    }
    frames
}

/// How long this thread has waited for a processor so far (Documentation/scheduler/sched-stats.rst of Linux).
fn waited() -> Duration {
    let stat = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let waited = stat.split_whitespace().nth(1);
    Duration::from_nanos(waited.and_then(|w| w.parse().ok()).unwrap_or(0))
}

fn milliseconds(time: Duration) -> f64 {
    1e3 * time.as_secs_f64()
}

/// What is said of a place: a line, and a line for each movement that takes more than is usual; how many frames are
/// slow.
fn report(name: &str, movements: &[(String, Vec<Duration>)]) -> usize {
    let mut all: Vec<Duration> = movements.iter().flat_map(|m| m.1.clone()).collect();
    all.sort_unstable();
    let Some(last) = all.last() else {
        println!("{name:<24}{:>9}", 0);
        return 0;
    };
    let part = |all: &[Duration], share: f64| all[(share * (all.len() - 1) as f64) as usize];
    let at = |share: f64| milliseconds(part(&all, share));
    let late = |frames: &[Duration]| frames.iter().filter(|f| **f > SLOW).count();
    println!(
        "{name:<24}{:>9}{:>9}{:>7.2} ms{:>7.2} ms{:>7.2} ms{:>7.2} ms{:>9}{:>9.2}{:>9.2}",
        movements.len(),
        all.len(),
        at(0.5),
        at(0.95),
        at(0.99),
        milliseconds(*last),
        late(&all),
        at(0.99) / milliseconds(USUAL),
        milliseconds(*last) / milliseconds(SLOW)
    );
    for (label, frames) in movements {
        let mut frames = frames.clone();
        frames.sort_unstable();
        let Some(worst) = frames.last() else {
            continue;
        };
        let (late, usual) = (late(&frames), part(&frames, 0.99));
        if late > 0 || usual > USUAL {
            println!(
                "    {label}: 99 % {:.1} ms, {late} of {} above 16 ms, up to {:.1} ms",
                milliseconds(usual),
                frames.len(),
                milliseconds(*worst)
            );
        }
    }
    late(&all)
}

/// The pointer on every line of a page, the wheel and a drag on both sides of it; they leave it as it was.
fn looked_at((_, link, buttons): Place) -> Vec<(String, Vec<Duration>)> {
    let mut bench = Bench::new(link, buttons, FULL);
    let mut movements: Vec<_> = (0..LINES)
        .map(|line| (format!("line {line}"), least(FULL, || bench.hover(line))))
        .collect();
    for (side, at) in [("left", 0.3), ("right", 0.85)] {
        movements.push((format!("wheel, {side}"), least(FULL, || bench.turn(at))));
        movements.push((format!("drag, {side}"), least(FULL, || bench.sway(at))));
    }
    movements
}

/// A measurement is opened, and its diagnosis comes in.
fn opened() -> Vec<(String, Vec<Duration>)> {
    let mut bench = Bench::new("v1;compare", &[], FULL);
    bench.frames.clear();
    bench.press("builtin:drive-02");
    while bench.app.hook_state()["busy"] == true {
        bench.settle();
    }
    vec![("opening".to_owned(), std::mem::take(&mut bench.frames))]
}

fn main() {
    // A word chooses the places whose names have it.
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let short = arguments.iter().any(|a| a == "--short");
    let chosen = arguments.iter().find(|a| !a.starts_with('-'));
    let wanted = |place: &Place| chosen.is_none_or(|word| place.0.contains(word));
    let extent = if short { SHORT } else { FULL };
    println!(
        "{:<24}{:>9}{:>9}{:>10}{:>10}{:>10}{:>10}{:>9}{:>9}{:>9}",
        "page",
        "drags",
        "frames",
        "median",
        "95 %",
        "99 %",
        "worst",
        "> 16 ms",
        "99 %/8",
        "worst/16"
    );
    let mut slow = 0;
    for (name, link, buttons) in PLACES.into_iter().filter(wanted) {
        // Each drag is on a page of its own: it would leave another behind.
        let mut controls = Bench::new(link, buttons, extent).controls();
        let step = controls.len().div_ceil(extent.controls).max(1);
        controls = controls.into_iter().step_by(step).collect();
        let drag = |(label, place): (String, Rect)| {
            let frames = least(extent, || Bench::new(link, buttons, extent).drag(place));
            (label, frames)
        };
        slow += report(name, &controls.into_iter().map(drag).collect::<Vec<_>>());
    }
    if !short {
        for place in LOOKS.into_iter().filter(wanted) {
            slow += report(place.0, &looked_at(place));
        }
        if chosen.is_none_or(|word| OPENING.contains(word)) {
            slow += report(OPENING, &opened());
        }
    }
    match slow {
        0 => println!("16 ms are kept: no frame takes longer."),
        slow => println!(
            "16 ms are not kept: {slow} frames take longer, each time that they are drawn."
        ),
    }
}
