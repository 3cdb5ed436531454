//! What stands below the plots of a relay loop: equation (3) in the z-form, and the loop with play.

use crate::support::ui::{app, show, texts};

#[test]
fn equation_3_in_z_and_the_loop_with_play_stand_beside_the_exact_cycle() {
    let mut harness = app("explore", [1280.0, 1500.0]);
    show(&mut harness, "v1;explore;explore.paused=2");
    let all = texts(&harness);
    let says = |part: &str| all.iter().any(|t| t.contains(part));
    assert!(says("Equation (3), in z") && says("ε/k"), "{all:?}");
    assert!(says("Play between plant and relay") && says("N of the play"));
}
