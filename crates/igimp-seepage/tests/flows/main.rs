//! GOAL: flows through soil, full and with a free surface, steady and in time, are those of closed forms.

mod common;
mod confined;
mod cost;
mod dams;
mod infiltration;
mod transient;
mod unconfined;
mod wells;
