//! A load behind a gap, known by the contacts that the motor felt.
//!
//! A load that flies freely between contacts is lost soon by a simulation from its beginning: every contact
//! multiplies what was wrong before it. The contacts themselves say where it is: at the end of the gap when
//! one begins, and faster afterwards by the momentum that the motor lost. A Kalman filter (1960) joins both
//! with its free flight.

use super::Model;
use super::flight::Slowing;
use crate::order::median;

/// A contact of the motor with the load, as the motor felt it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenContact {
    /// When it began and ended, s.
    pub begin: f64,
    pub end: f64,
    /// From the begin to the centre of the push, s.
    pub centre: f64,
    /// Position and velocity of the motor at the begin.
    pub position: f64,
    pub velocity: f64,
    /// 1 where the motor pushes the load forwards, else -1.
    pub side: f64,
    /// Velocity that the motor lost, and its standard deviation.
    pub jump: f64,
    pub jump_noise: f64,
    /// Whether the load flew before, so that its place is told by the begin; else the push goes on.
    pub free: bool,
    /// Where the motor was farthest on either side since the contact before, in order of time.
    pub turns: [Option<Turn>; 2],
}

impl SeenContact {
    /// Where the load is when it begins.
    pub fn load_at(&self, half_gap: f64) -> f64 {
        self.position - self.side * half_gap
    }
}

/// What decides how a load moves between contacts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Play {
    /// Half gap, rad or m.
    pub half_gap: f64,
    /// Inertia of the motor over that of the load.
    pub ratio: f64,
    /// Friction of the free load.
    pub slowing: Slowing,
}

impl Play {
    /// Velocity of a load with velocity `v` after the push of a contact. Its dry friction takes a part from the push of
    /// a load at rest; one that moves was slowed by it on its way to the centre of the push.
    fn pushed(&self, v: f64, contact: &SeenContact) -> f64 {
        let gained = self.ratio * contact.jump;
        if v == 0.0 {
            let lost = self.slowing.dry * contact.centre;
            gained.signum() * (gained.abs() - lost).max(0.0)
        } else {
            v + gained
        }
    }
}

/// How well a contact tells the load's place and momentum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sharpness {
    /// Standard deviation of the place where a contact begins, rad or m.
    pub place: f64,
    /// Standard deviation of its begin, s.
    pub late: f64,
    /// Relative standard deviation of the momentum.
    pub momentum: f64,
}

/// Position and velocity of the load with their covariance (xx, xv, vv).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadState {
    /// Position.
    pub x: f64,
    /// Velocity.
    pub v: f64,
    /// Covariance.
    pub covariance: [f64; 3],
}

/// Where the motor turned round between two contacts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// When, s.
    pub time: f64,
    /// The motor's position there.
    pub position: f64,
    /// 1 where it turned at its largest position, -1 at its smallest.
    pub side: f64,
}

/// Standard deviations of its place by which a load must lie within the way of the motor to have been pushed along.
const PASSED: f64 = 3.0;

/// How far a contact lies from where the load was expected.
#[derive(Clone, Copy, Debug)]
pub struct Surprise {
    /// Measured minus expected position of the motor.
    pub value: f64,
    /// Its variance.
    pub variance: f64,
}

impl LoadState {
    /// At rest in `x`.
    pub fn at_rest(x: f64, sharpness: &Sharpness) -> Self {
        Self {
            x,
            v: 0.0,
            covariance: [sharpness.place.powi(2), 0.0, 0.0],
        }
    }

    /// Flies on for `time` seconds.
    pub fn fly(&mut self, slowing: &Slowing, time: f64) {
        let flight = slowing.flight(self.v, time.max(0.0));
        self.x += flight.way;
        self.v = flight.velocity;
        let (a, b) = (flight.way_by_velocity, flight.velocity_by_velocity);
        let [xx, xv, vv] = self.covariance;
        self.covariance = [xx + a * (2.0 * xv + a * vv), b * (xv + a * vv), b * b * vv];
    }

    /// How far `contact` lies from where this state expects it.
    pub fn surprise(
        &self,
        contact: &SeenContact,
        half_gap: f64,
        sharpness: &Sharpness,
    ) -> Surprise {
        // A contact is placed in time, so that its place is the less certain the faster they meet.
        let lateness = sharpness.late * (contact.velocity - self.v);
        Surprise {
            value: contact.load_at(half_gap) - self.x,
            variance: self.covariance[0] + sharpness.place.powi(2) + lateness * lateness,
        }
    }

    /// Share of a surprise that goes into position and velocity.
    fn gain(&self, surprise: &Surprise) -> [f64; 2] {
        [
            self.covariance[0] / surprise.variance,
            self.covariance[1] / surprise.variance,
        ]
    }

    /// Takes in a surprise; gives the gain with which it did.
    pub fn meet(&mut self, surprise: &Surprise) -> [f64; 2] {
        let [gx, gv] = self.gain(surprise);
        self.x += gx * surprise.value;
        self.v += gv * surprise.value;
        let [xx, xv, vv] = self.covariance;
        self.covariance = [xx - gx * xx, xv - gx * xv, vv - gv * xv];
        [gx, gv]
    }

    /// Whether the motor went through the load, which cannot be: touches too light to be seen pushed it along, and it
    /// is lost. What is within the noise of places is no such thing.
    pub fn is_passed(&self, turn: &Turn, half_gap: f64, sharpness: &Sharpness) -> bool {
        let within = turn.side * (turn.position - self.x) - half_gap;
        within > PASSED * (self.covariance[0] + sharpness.place.powi(2)).sqrt()
    }

    /// Takes up the momentum of a contact.
    pub fn push(&mut self, contact: &SeenContact, play: &Play, sharpness: &Sharpness) {
        let ratio = play.ratio;
        self.v = play.pushed(self.v, contact);
        self.covariance[2] += (ratio * sharpness.momentum * contact.jump).powi(2)
            + (ratio * contact.jump_noise).powi(2);
    }
}

/// A load that was seen through its contacts.
#[derive(Clone, Debug, PartialEq)]
pub struct SeenLoad {
    contacts: Vec<SeenContact>,
    /// What explains them best.
    play: Play,
    sharpness: Sharpness,
    errors: [f64; 3],
    /// For each contact, the gains with which it is taken in, and the state after its push.
    gains: Vec<[f64; 2]>,
    after: Vec<LoadState>,
}

/// Where the load is believed to be.
pub(super) enum Sight {
    /// Flying freely with this position and velocity.
    Free(f64, f64),
    /// In a contact that began then, where it had this position and velocity.
    Touching {
        /// When the contact began, s.
        begin: f64,
        /// Position there.
        x: f64,
        /// Velocity there.
        v: f64,
    },
}

impl SeenLoad {
    /// From contacts in order of time and what explains them best, with the relative standard errors of the load's
    /// inertia, viscous and dry friction; `None` without any.
    pub fn new(
        contacts: Vec<SeenContact>,
        play: Play,
        sharpness: Sharpness,
        errors: [f64; 3],
    ) -> Option<Self> {
        let x = contacts.first()?.load_at(play.half_gap);
        let mut state = LoadState::at_rest(x, &sharpness);
        let (mut gains, mut after) = (Vec::new(), Vec::new());
        let mut now = f64::NEG_INFINITY;
        for contact in &contacts {
            state.fly(&play.slowing, passed(now, contact.begin));
            let surprise = state.surprise(contact, play.half_gap, &sharpness);
            gains.push(if contact.free {
                state.meet(&surprise)
            } else {
                [0.0; 2]
            });
            state.fly(&play.slowing, contact.centre);
            state.push(contact, &play, &sharpness);
            after.push(state);
            now = contact.begin + contact.centre;
        }
        Some(Self {
            contacts,
            play,
            sharpness,
            errors,
            gains,
            after,
        })
    }

    /// What explains the contacts best.
    pub fn play(&self) -> &Play {
        &self.play
    }

    /// Standard errors of the load's inertia, viscous and dry friction, as shares of these.
    pub fn errors(&self) -> [f64; 3] {
        self.errors
    }

    /// Usual time from the begin of a contact to the centre of its push, s.
    pub fn usual_push(&self) -> f64 {
        let mut centres: Vec<f64> = self.contacts.iter().map(|c| c.centre).collect();
        median(&mut centres)
    }

    /// Variances and covariance of the load's position and velocity at a time in s, from the contacts that began
    /// before.
    pub fn covariance(&self, time: f64) -> [f64; 3] {
        let known = self.contacts.partition_point(|c| c.begin <= time);
        let Some(last) = known.checked_sub(1) else {
            return [self.sharpness.place.powi(2), 0.0, 0.0];
        };
        let contact = &self.contacts[last];
        let mut state = self.after[last];
        state.fly(&self.play.slowing, time - contact.begin - contact.centre);
        state.covariance
    }
}

/// Lower triangular root (xx, vx, vv) of a covariance (xx, xv, vv).
pub(super) fn root([xx, xv, vv]: [f64; 3]) -> [f64; 3] {
    let x = xx.sqrt();
    let slope = if x > 0.0 { xv / x } else { 0.0 };
    [x, slope, (vv - slope * slope).max(0.0).sqrt()]
}

/// Seconds from `now`, which may be before all time.
fn passed(now: f64, until: f64) -> f64 {
    if now.is_finite() { until - now } else { 0.0 }
}

/// Follows a seen load through the record with the values of a model.
pub(super) struct Tracker<'s> {
    seen: &'s SeenLoad,
    play: Play,
    next: usize,
    /// Position and velocity at the time `now`.
    x: f64,
    v: f64,
    now: f64,
    /// Position and velocity when the last contact began.
    met: (f64, f64),
}

impl<'s> Tracker<'s> {
    /// Before the record begins; `None` for a model without a gap.
    pub fn new(seen: &'s SeenLoad, model: &Model) -> Option<Self> {
        let load = model.load.as_ref().filter(|l| l.coupling.half_gap > 0.0)?;
        let half_gap = load.coupling.half_gap;
        let play = Play {
            half_gap,
            ratio: model.inertia / load.inertia,
            slowing: Slowing {
                viscous: load.viscous / load.inertia,
                dry: load.dry_friction / load.inertia,
            },
        };
        Some(Self::with(seen, play))
    }

    /// The same with this play.
    pub fn with(seen: &'s SeenLoad, play: Play) -> Self {
        let first = seen.contacts.first().map(|c| c.load_at(play.half_gap));
        let x = first.unwrap_or(0.0);
        Self {
            seen,
            play,
            next: 0,
            x,
            v: 0.0,
            now: f64::NEG_INFINITY,
            met: (x, 0.0),
        }
    }

    /// Where the load is at a time in s, not before the last one asked for.
    pub fn at(&mut self, time: f64) -> Sight {
        let contacts = &self.seen.contacts;
        while let Some(contact) = contacts.get(self.next).filter(|c| c.begin <= time) {
            self.fly(passed(self.now, contact.begin));
            if contact.free {
                let place = contact.load_at(self.play.half_gap);
                let [gx, gv] = self.seen.gains[self.next];
                let surprise = place - self.x;
                self.x += gx * surprise;
                self.v += gv * surprise;
            }
            self.met = (self.x, self.v);
            self.fly(contact.centre);
            self.v = self.play.pushed(self.v, contact);
            self.now = contact.begin + contact.centre;
            self.next += 1;
        }
        let last = self.next.checked_sub(1).map(|k| &contacts[k]);
        if let Some(contact) = last.filter(|c| time < c.end.max(c.begin + 2.0 * c.centre)) {
            let (x, v) = self.met;
            return Sight::Touching {
                begin: contact.begin,
                x,
                v,
            };
        }
        let flight = self
            .play
            .slowing
            .flight(self.v, passed(self.now, time).max(0.0));
        Sight::Free(self.x + flight.way, flight.velocity)
    }

    /// The deviations with which the load, free at this time in s, would meet the next contact that begins before
    /// `until`; none in a contact, or where there is none.
    pub fn next_met(&mut self, time: f64, until: f64) -> Option<[f64; 2]> {
        let Sight::Free(x, v) = self.at(time) else {
            return None;
        };
        let next = self.seen.contacts.get(self.next);
        let contact = next.filter(|c| c.free && c.begin < until)?;
        let [xx, xv, vv] = self.seen.covariance(time);
        let flight = self.play.slowing.flight(v, contact.begin - time);
        let a = flight.way_by_velocity;
        let place = contact.load_at(self.play.half_gap);
        let surprise = place - x - flight.way;
        let share = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
        let variance = xx + a * (2.0 * xv + a * vv);
        let moved = [
            share(xx + a * xv, variance) * surprise,
            share(xv + a * vv, variance) * surprise,
        ];
        let [l, slope, rest] = root([xx, xv, vv]);
        let first = share(moved[0], l);
        Some([first, share(moved[1] - slope * first, rest)])
    }

    /// What `deviations` in units of the standard deviations of what contacts tell are in position and velocity.
    pub fn shift(&self, time: f64, deviations: [f64; 2]) -> [f64; 2] {
        let [x, slope, v] = root(self.seen.covariance(time));
        let [a, b] = deviations;
        [x * a, slope * a + v * b]
    }

    fn fly(&mut self, time: f64) {
        let flight = self.play.slowing.flight(self.v, time.max(0.0));
        self.x += flight.way;
        self.v = flight.velocity;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SLOWING: Slowing = Slowing {
        viscous: 2.0,
        dry: 0.05,
    };
    const PLAY: Play = Play {
        half_gap: 0.005,
        ratio: 0.8,
        slowing: SLOWING,
    };
    const SHARPNESS: Sharpness = Sharpness {
        place: 1e-5,
        late: 1e-4,
        momentum: 0.01,
    };

    fn contact(begin: f64, side: f64, load: f64, jump: f64) -> SeenContact {
        SeenContact {
            begin,
            end: begin,
            centre: 0.0,
            position: load + side * PLAY.half_gap,
            velocity: 0.0,
            side,
            jump,
            jump_noise: 1e-4,
            free: true,
            turns: [None; 2],
        }
    }

    /// The load is pushed at 0 s from rest at 0.01, flies for 0.2 s and meets the other end.
    fn seen() -> (SeenLoad, f64) {
        let speed = PLAY.ratio * 0.05;
        let met = 0.01 + SLOWING.flight(speed, 0.2).way;
        let contacts = vec![
            contact(0.0, 1.0, 0.01, 0.05),
            contact(0.2, -1.0, met, -0.02),
        ];
        (
            SeenLoad::new(contacts, PLAY, SHARPNESS, [0.0; 3]).unwrap(),
            speed,
        )
    }

    #[test]
    fn a_load_is_where_its_flight_led() {
        let (seen, speed) = seen();
        let mut tracker = Tracker::with(&seen, PLAY);
        let flight = SLOWING.flight(speed, 0.1);
        let Sight::Free(x, v) = tracker.at(0.1) else {
            panic!("no contact is on");
        };
        assert!((x - 0.01 - flight.way).abs() < 1e-15, "{x}");
        assert!((v - flight.velocity).abs() < 1e-15, "{v}");
        assert_eq!(tracker.next_met(0.1, 0.15), None);
        let deviations = tracker.next_met(0.1, 0.3).unwrap();
        assert!(deviations.iter().all(|d| d.abs() < 1e-9), "{deviations:?}");
    }

    #[test]
    fn with_a_wrong_gap_the_deviations_lead_to_the_contact() {
        let (seen, _) = seen();
        let wrong = Play {
            half_gap: 0.0052,
            ..PLAY
        };
        let mut tracker = Tracker::with(&seen, wrong);
        let Sight::Free(x, v) = tracker.at(0.1) else {
            panic!("no contact is on");
        };
        let [dx, dv] = {
            let deviations = tracker.next_met(0.1, 0.3).unwrap();
            tracker.shift(0.1, deviations)
        };
        let reached = x + dx + SLOWING.flight(v + dv, 0.1).way;
        let asked = seen.contacts[1].load_at(wrong.half_gap);
        // A wider gap is met later, by 0.4 mm here; the flight is not quite linear in the velocity.
        let left = (asked - reached) / 0.0004;
        assert!(left.abs() < 1e-3, "{left}");
    }

    #[test]
    fn what_is_known_of_a_load_fades_until_the_next_contact() {
        let (seen, _) = seen();
        let place = |time: f64| seen.covariance(time)[0];
        assert!(place(0.1) > place(0.05) && place(0.05) > place(0.01));
        assert!(place(0.21) < place(0.19));
    }
}
