//! The relay, and what happens at instants that are known beforehand.

use super::DriveJob;
use crate::drive::trajectory::EventKind;

/// Share of the sampling time by which an instant may miss its sample by round-off.
const SAME_INSTANT: f64 = 1e-9;

impl DriveJob {
    /// The next instant that is known beforehand.
    pub(super) fn next_instant(&self) -> f64 {
        let mut next = self.duration;
        if let Some(look) = self.look {
            next = next.min(look);
        }
        if let Some((t, _)) = self.coming.front() {
            next = next.min(*t);
        }
        if let Some(t) = self.next_flip() {
            next = next.min(t);
        }
        next
    }

    pub(super) fn next_flip(&self) -> Option<f64> {
        let flip = self.relay?.flip?;
        Some((self.flips + 1) as f64 * flip)
    }

    /// Whether the velocity has jumped beyond the relay's threshold.
    pub(super) fn crossed(&self) -> bool {
        let (Some(relay), None) = (self.relay, self.look) else {
            return false;
        };
        if self.high {
            self.state.v1 < -relay.relay.hysteresis
        } else {
            self.state.v1 > relay.relay.hysteresis
        }
    }

    /// Whether a relay that looks now switches.
    pub(super) fn at_threshold(&self) -> bool {
        let eps = self.relay.map_or(0.0, |r| r.relay.hysteresis);
        if self.high {
            self.state.v1 <= -eps
        } else {
            self.state.v1 >= eps
        }
    }

    /// The velocity is at or beyond the threshold: the relay switches, a sampled one when it looks.
    pub(super) fn crossing(&mut self) {
        if let Some(sampling) = self.relay.and_then(|r| r.sampling) {
            self.look = Some((self.time / sampling - SAME_INSTANT).ceil() * sampling);
            return;
        }
        self.switch();
    }

    pub(super) fn switch(&mut self) {
        self.high = !self.high;
        self.note(if self.high {
            EventKind::SwitchUp
        } else {
            EventKind::SwitchDown
        });
        self.command();
    }

    /// Sends what the relay says now on its way.
    pub(super) fn command(&mut self) {
        let Some(relay) = self.relay else {
            return;
        };
        let u = relay.output(self.high, self.turned);
        if u == self.commanded {
            return;
        }
        self.commanded = u;
        if relay.relay.delay > 0.0 {
            self.coming.push_back((self.time + relay.relay.delay, u));
        } else {
            self.act(u);
        }
    }

    pub(super) fn act(&mut self, u: f64) {
        self.u = u;
        self.note(EventKind::Input(u));
        self.settle();
    }

    /// Whatever is due at this instant.
    pub(super) fn handle_instant(&mut self) {
        if let Some((t, u)) = self.coming.front().copied()
            && t <= self.time
        {
            self.coming.pop_front();
            self.act(u);
            return;
        }
        if self.next_flip().is_some_and(|t| t <= self.time) {
            self.flips += 1;
            self.turned = !self.turned;
            self.note(EventKind::Flip);
            match self.relay.and_then(|r| r.sampling) {
                Some(_) => self.crossing(),
                None => self.command(),
            }
            return;
        }
        if self.look.is_some_and(|t| t <= self.time) {
            self.look = None;
            if self.at_threshold() {
                self.switch();
            } else {
                self.command();
            }
            return;
        }
        if self.time >= self.duration {
            let s = self.state;
            let last = self.sampling.map(|d| self.samples as f64 * d);
            if last.is_some_and(|t| t <= self.duration) {
                self.note_sample(self.duration, s.x1, s.v1, s.v2, s.gap);
            }
            self.done = true;
        }
    }
}
