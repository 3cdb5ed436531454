//! What several pages draw with: plots, sliders and fields, a form for columns, a playback, the plots of a relay loop.

pub mod chart;
mod chart_axes;
mod chart_caption;
pub mod chart_cursor;
mod chart_keys;
pub mod chart_menu;
mod chart_pen;
mod chart_reading;
pub mod chart_zoom;
pub mod columns;
pub mod controls;
pub mod equation;
pub mod playback;
pub mod relay_loop;
pub mod typed;
