//! What stands below the plots of a relay loop: equation (3) in the z-form, and the loop with play.

use crate::support::ui::{app, picture, show, texts};

#[test]
fn equation_3_in_z_and_the_loop_with_play_stand_beside_the_exact_cycle() {
    let mut harness = app("explore", [1280.0, 1500.0]);
    show(&mut harness, "v1;explore;explore.paused=2");
    let all = texts(&harness);
    let says = |part: &str| all.iter().any(|t| t.contains(part));
    // The default: 1/(s + 1)^3, k = 1, eps = 0.1; half of 4.78767194204541 s.
    assert!(
        says("2.393836 s, -H(-1) = 0.100000000 and ε/k = 0.100000000"),
        "{all:?}"
    );
    assert!(says("Play between plant and relay") && says("before the play"));
    picture(&mut harness, "explore_further");
}
