//! An actuator that remembers: what it does depends on the commands before.

/// How it remembers. Forces are in the unit of the input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Actuator {
    /// It moves towards the command at this rate at most, input unit per s; above 0.
    Rate(f64),
    /// A valve that sticks and slips (He, Wang, Pottmann and Qin 2007; after Choudhury, Thornhill and Shah 2005, whose
    /// `J` is the jump and whose `S` is the jump and twice the distance).
    Stiction {
        /// How far the stem stays behind the command; at least 0.
        behind: f64,
        /// By how much it slips when it breaks loose, beyond that; at least 0, and 0 is play.
        jump: f64,
    },
}

/// An actuator on its way through a record.
#[derive(Clone, Debug)]
pub(super) struct Remembering {
    actuator: Actuator,
    /// What it gives.
    now: f64,
    /// The command of the sample before.
    told: f64,
    /// The push on a stem that sticks.
    pushed: f64,
}

impl Remembering {
    /// At rest under a command that did not change.
    pub fn new(actuator: Actuator, before: f64) -> Self {
        Self {
            actuator,
            now: before,
            told: before,
            pushed: 0.0,
        }
    }

    /// What it gives, in the mean, in `h` seconds under this command.
    pub fn after(&mut self, command: f64, h: f64) -> f64 {
        match self.actuator {
            Actuator::Rate(rate) => self.towards(command, rate, h),
            Actuator::Stiction { behind, jump } => {
                let push = self.pushed + (command - self.told);
                self.told = command;
                if push.abs() > behind + jump {
                    self.now = command - push.signum() * behind;
                    self.pushed = push.signum() * behind;
                } else {
                    self.pushed = push;
                }
                self.now
            }
        }
    }

    fn towards(&mut self, command: f64, rate: f64, h: f64) -> f64 {
        let way = command - self.now;
        let moving = way.abs() / rate;
        if moving >= h {
            let from = self.now;
            self.now += way.signum() * rate * h;
            return f64::midpoint(from, self.now);
        }
        // It arrives on the way and stays.
        let mean = command - way * 0.5 * moving / h;
        self.now = command;
        mean
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn from_rest(actuator: Actuator, commands: &[f64]) -> Vec<f64> {
        let mut remembering = Remembering::new(actuator, 0.0);
        let given = commands.iter().map(|u| remembering.after(*u, 1.0));
        given.collect()
    }

    #[test]
    fn a_limited_rate_arrives_on_a_straight_line_and_stays() {
        let means = from_rest(Actuator::Rate(0.4), &[1.0, 1.0, 1.0, 1.0, -1.0]);
        let exact = [0.2, 0.6, 0.95, 1.0, 0.8];
        assert!(
            means.iter().zip(exact).all(|(a, b)| (a - b).abs() < 1e-12),
            "{means:?}"
        );
    }

    #[test]
    fn stiction_without_a_jump_is_play() {
        let commands: Vec<f64> = (0..200)
            .map(|k| libm::sin(0.1 * f64::from(k)) * (1.0 + 0.01 * f64::from(k)))
            .collect();
        let valve = from_rest(
            Actuator::Stiction {
                behind: 0.3,
                jump: 0.0,
            },
            &commands,
        );
        let mut play: f64 = 0.0;
        for (u, v) in commands.iter().zip(valve) {
            play = play.clamp(u - 0.3, u + 0.3);
            assert!((play - v).abs() < 1e-12, "{play}, {v}");
        }
    }

    #[test]
    fn a_stem_that_sticks_slips_by_its_jump() {
        let actuator = Actuator::Stiction {
            behind: 0.2,
            jump: 0.2,
        };
        // It breaks loose at 0.4.
        assert_eq!(
            from_rest(actuator, &[0.3, 0.39, 0.41]),
            [0.0, 0.0, 0.41 - 0.2]
        );
    }
}
