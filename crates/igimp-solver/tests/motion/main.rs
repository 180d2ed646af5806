//! Rigid bodies and motion: one program, as every one compiles the equations anew.

#[path = "../body_support/mod.rs"]
mod body_support;
mod contact;
mod contact_in_space;
mod dynamics;
mod free_field;
mod granular;
mod ground;
mod impact;
mod pendulum;
