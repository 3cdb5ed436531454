//! The app as a user works it; one module a page or habit.

#[path = "../support"]
mod support {
    pub mod mat;
    pub mod pulses;
    pub mod source;
    pub mod ui;
}

mod access;
mod backlash;
mod care;
mod compare;
mod explore;
mod german;
mod habits;
mod journeys;
mod legible;
mod lessons;
mod links;
mod looks;
mod mapping;
mod mystery;
mod pages;
mod plots;
mod program;
mod shell;
mod tune;
mod words;
