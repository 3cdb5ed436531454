//! Loops other than the plain relay: on-off controllers as they are built, drives with a controller, and files of them.

use hysteron_core::explore::{self, ExploreData, ExploreInput};
use hysteron_core::figures::{Check, checks};
use hysteron_core::hunting::{self, HuntingData};
use hysteron_core::message::Message;
use hysteron_core::on_off::{self, OnOffData, OnOffInput};
use hysteron_core::scenario::{AnyScenario, keys_of_run};

use crate::tasks::{
    LoopTask, News, OnOffTask, ReadScenario, ScenarioReport, ScenarioTask, ServoTask,
};
use crate::work::{Say, Work};

impl LoopTask {
    /// What there is to see, and what becomes of the figure's claim.
    ///
    /// # Errors
    /// Why the loop cannot be computed.
    pub fn view(&self) -> Result<(ExploreData, Vec<Check>), Message> {
        let data = explore::compute(&self.input)?;
        let claims = match self.figure {
            Some(number) => checks(number, &self.input, &data)?,
            None => Vec::new(),
        };
        Ok((data, claims))
    }
}

impl Work for LoopTask {
    fn run(self, say: Say<'_, (ExploreData, Vec<Check>)>) {
        tell(self.view(), say);
    }
}

impl Work for OnOffTask {
    fn run(self, say: Say<'_, OnOffData>) {
        tell(on_off::view(&self.0).map_err(Message::from), say);
    }
}

impl Work for ServoTask {
    fn run(self, say: Say<'_, HuntingData>) {
        tell(hunting::view(&self.0).map_err(Message::from), say);
    }
}

impl Work for ScenarioTask {
    fn run(self, say: Say<'_, ReadScenario>) {
        tell(read(&self.0), say);
    }
}

fn read(text: &str) -> Result<ReadScenario, Message> {
    let report = report(text)?;
    let shown: &[&str] = match &report {
        ScenarioReport::Loop(_) => &["noise"],
        ScenarioReport::OnOff(_) => &["initial"],
        ScenarioReport::Servo(_) => &[],
        // Its page runs it as the file says.
        ScenarioReport::Drive(_) => &["duration", "start", "step"],
    };
    let mut left_out = keys_of_run(text);
    left_out.retain(|key| !shown.contains(&key.as_str()));
    Ok(ReadScenario { report, left_out })
}

fn report(text: &str) -> Result<ScenarioReport, Message> {
    match AnyScenario::from_toml(text).map_err(Message::from)? {
        AnyScenario::Loop(scenario) => {
            let input = ExploreInput {
                plant: scenario.plant,
                relay: scenario.relay,
                noise: scenario.options.noise,
            };
            input.validate().map_err(Message::from)?;
            Ok(ScenarioReport::Loop(Box::new(input)))
        }
        AnyScenario::OnOff(scenario) => {
            let input = OnOffInput::of(&scenario.on_off).map_err(Message::from)?;
            Ok(ScenarioReport::OnOff(Box::new(input)))
        }
        AnyScenario::Servo(scenario) => Ok(ScenarioReport::Servo(Box::new(scenario.servo))),
        AnyScenario::Drive(drive) => Ok(ScenarioReport::Drive(drive)),
    }
}

/// Hands over what a computation came to.
fn tell<R>(result: Result<R, Message>, say: Say<'_, R>) {
    say(match result {
        Ok(report) => News::Report(Box::new(report)),
        Err(error) => News::Failed(error),
    });
}
