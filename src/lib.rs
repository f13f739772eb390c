//! Fieldstone: a modelling language and a renderer for implicit surfaces.
//!
//! A script describes a tree of signed distance primitives; every node carries a sound Lipschitz constant; the tree
//! is compiled to closures that sphere tracing evaluates; the Whitted pipeline runs on top.
//!
//! `text -lang::load-> Scene -field::compile-> World -trace-> hits -shade-> colours -render-> Film -output-> bytes`
//!
//! The floors, from the ground up; a module imports only what lies below it:
//!
//! | floor | module | what lives there |
//! |---|---|---|
//! | 0 | [`num`] | `Number` and its types: f32, f64, wide lanes, dual, interval; vectors |
//! | 1 | [`catalogue`] | every primitive, combinator, modifier: declared once |
//! | 2 | [`scene`] | the typed tree with its certificates; materials, lights, camera |
//! | 3 | [`lang`], [`field`] | text to scene; scene to closures (strangers to each other) |
//! | 4 | [`trace`] | rays to hits: methods, analytic entries, verdicts |
//! | 5 | [`shade`] | the Whitted pipeline, by waves |
//! | 6 | [`render`] | camera to film: tiles, threads, statistics |
//! | 7 | [`output`] | film to bytes |
//! | 8 | [`cli`] | the command line |

pub mod catalogue;
pub mod cli;
pub mod field;
pub mod lang;
pub mod num;
pub mod output;
pub mod render;
pub mod scene;
pub mod shade;
pub mod trace;
