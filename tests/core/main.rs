//! What the core promises, from import to verdict, checked from outside; one module a subject.

#[path = "../support/mod.rs"]
mod support;

mod at_rest;
mod blind_bench;
mod by_hand;
mod describing_function;
mod discovery;
mod doors;
mod drifting_records;
mod drive;
mod drive_contact;
mod drive_figures;
mod drive_measured;
mod drive_random;
mod few_stretches;
mod figures;
mod fingerprints;
mod gap;
mod gap_coverage;
mod hidden_effects;
mod hunting;
mod import;
mod import_mat;
mod limit_cycles;
mod lost_rows;

mod explained;
mod measured_tuning;
mod missing_force;
mod mystery;
mod next_experiment;
mod on_off;
mod other_machines;
mod outcomes;
mod own_effect;
mod parameter_maps;
mod plants;
mod random_forces;
mod real_drive;
mod real_records;
mod records;
mod relay_loops;
mod report;
mod rests;
mod scenario_text;
mod screen;
mod sensors;
mod simulation;
mod slow_and_short;
mod surroundings;
mod tuning;
mod tuning_coverage;
mod tuning_logs;
mod tuning_loop;
mod user_model;
