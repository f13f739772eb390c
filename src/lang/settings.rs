//! The statements that set the stage: camera, light, sky, fog, render.

use super::ast::Entry;
use super::machine::{Eval, Machine, Stop};
use super::report::Diagnostic;
use super::source::Word;
use super::terms::Terms;
use crate::scene::{
    Camera, Falloff, Fog, Light, Method, Projection, Sampling, Settings, Sky, Source,
};
use glam::DVec3;
use std::f64::consts::PI;

const POSITIVE: (&str, fn(f64) -> bool) = ("positive", |x| x > 0.0);
const NOT_NEGATIVE: (&str, fn(f64) -> bool) = ("zero or positive", |x| x >= 0.0);

impl<'a> Machine<'a> {
    /// `camera { ... }`
    pub fn camera(&mut self, word: &'a Word, entries: &'a [Entry]) -> Eval<Camera> {
        let known = ["eye", "at", "up", "fov", "projection", "height", "screen"];
        let mut terms = Terms::new(self, (&word.text, word.span), entries, &known);
        let default = Camera::default();
        let mut camera = Camera {
            eye: terms.vector(self, "eye", default.eye),
            at: terms.vector(self, "at", default.at),
            up: terms.vector(self, "up", default.up),
            projection: default.projection,
            screen: terms.pair(self, "screen", POSITIVE),
        };
        let kinds = [("perspective", false), ("orthographic", true)];
        let is_orthographic = terms.choice(self, "projection", &kinds, false);
        camera.projection = if is_orthographic {
            self.superfluous(&mut terms, "fov", "an orthographic camera has a `height`");
            let height = terms.number(self, "height", POSITIVE, 4.0);
            Projection::Orthographic { height }
        } else {
            self.superfluous(
                &mut terms,
                "height",
                "only a camera with `projection: \"orthographic\"` has a height",
            );
            if camera.screen.is_some() {
                self.superfluous(&mut terms, "fov", "`screen` sets the angle of view already");
            }
            let range = ("between 0deg and 180deg", |x: f64| 0.0 < x && x < PI);
            let fov = terms.angle(self, "fov", range, 40f64.to_radians());
            Projection::Perspective { fov }
        };
        self.check_line_of_sight(&mut terms, &camera);
        finish(terms, camera)
    }

    fn superfluous(&mut self, terms: &mut Terms<'a>, name: &str, help: &str) {
        if terms.get(name).is_some() {
            let message = format!("`{name}` of `{}` has no meaning here", terms.word);
            let error = Diagnostic::error(terms.place(name), message).help(help);
            terms.note(self, error);
        }
    }

    fn check_line_of_sight(&mut self, terms: &mut Terms<'a>, camera: &Camera) {
        if terms.is_broken {
            return;
        }
        let sight = (camera.at - camera.eye).normalize_or_zero();
        if sight == DVec3::ZERO {
            let error = Diagnostic::error(
                terms.place("at"),
                "`eye` and `at` of `camera` are the same point",
            );
            let error = error.help("the camera looks from `eye` to `at`");
            return terms.note(self, error);
        }
        let across = sight.cross(camera.up.normalize_or_zero());
        // Closer than this, which way is up would be a matter of rounding.
        const LEAST_SINE: f64 = 1e-9;
        if across.length() < LEAST_SINE {
            let message = "`up` of `camera` lies along the line of sight";
            let error = Diagnostic::error(terms.place("up"), message);
            terms.note(
                self,
                error.help("choose another direction, as in `up: [0, 0, -1]`"),
            );
        }
    }

    /// `light { ... }`
    pub fn light(&mut self, word: &'a Word, entries: &'a [Entry]) -> Eval<Light> {
        let known = [
            "toward",
            "position",
            "at",
            "angle",
            "softness",
            "falloff",
            "color",
            "intensity",
        ];
        let mut terms = Terms::new(self, (&word.text, word.span), entries, &known);
        let color = terms.color(self, "color", DVec3::ONE);
        let intensity = terms.number(self, "intensity", NOT_NEGATIVE, 1.0);
        let source = self.light_source(&mut terms);
        let light = Light {
            source,
            radiance: color * intensity,
        };
        finish(terms, light)
    }

    fn light_source(&mut self, terms: &mut Terms<'a>) -> Source {
        let is_spot = terms.get("angle").is_some();
        let toward = self.direction(terms, "toward");
        if terms.get("position").is_none() {
            for name in ["at", "angle", "softness", "falloff"] {
                self.superfluous(terms, name, "only a light with a `position` has it");
            }
            if toward.is_none() && !terms.is_broken {
                let error = Diagnostic::error(terms.span, "the light comes from nowhere");
                let help = "give `toward: [1, 2, 1]` (a direction) or `position: [5, 8, 3]`";
                terms.note(self, error.help(help));
            }
            let toward = toward.unwrap_or(DVec3::Y);
            return Source::Directional { toward };
        }
        let position = terms.vector(self, "position", DVec3::ZERO);
        let falloffs = [
            ("none", Falloff::None),
            ("inverse-square", Falloff::InverseSquare),
        ];
        let falloff = terms.choice(self, "falloff", &falloffs, Falloff::None);
        if !is_spot {
            for name in ["toward", "at", "softness"] {
                self.superfluous(
                    terms,
                    name,
                    "a spot light has an `angle`, a point light shines everywhere",
                );
            }
            return Source::Point { position, falloff };
        }
        if toward.is_some() {
            self.superfluous(terms, "at", "`toward` says already where the light shines");
        }
        let target = terms.vector(self, "at", DVec3::ZERO);
        let axis = toward.unwrap_or_else(|| (target - position).normalize_or_zero());
        if axis == DVec3::ZERO && !terms.is_broken {
            let message = "`position` and `at` of `light` are the same point";
            let error = Diagnostic::error(terms.place("at"), message);
            terms.note(
                self,
                error.help("a spot light shines from `position` to `at`"),
            );
        }
        let range = ("above 0deg and at most 180deg", |x: f64| 0.0 < x && x <= PI);
        let outer = 0.5 * terms.angle(self, "angle", range, PI / 4.0);
        let share = ("between 0 and 1", |x: f64| (0.0..=1.0).contains(&x));
        let softness = terms.number(self, "softness", share, 0.0);
        Source::Spot {
            position,
            axis,
            outer,
            inner: outer * (1.0 - softness),
            falloff,
        }
    }

    /// A direction with length 1.
    fn direction(&mut self, terms: &mut Terms<'a>, name: &str) -> Option<DVec3> {
        let (value, span) = terms.get(name)?;
        let direction = terms.vector(self, name, DVec3::Y);
        // Scaled first, so that neither huge nor tiny vectors overflow.
        let scaled = direction / direction.abs().max_element().max(f64::MIN_POSITIVE);
        let unit = scaled.normalize_or_zero();
        if unit == DVec3::ZERO && !terms.is_broken {
            let message = format!("`{name}` of `{}` must not be zero", terms.word);
            let error = Diagnostic::error(span, message).label(value.shown());
            terms.note(self, error);
        }
        Some(unit)
    }

    /// `sky { ... }`
    pub fn sky(&mut self, word: &'a Word, entries: &'a [Entry]) -> Eval<Sky> {
        let known = ["color", "horizon", "zenith"];
        let mut terms = Terms::new(self, (&word.text, word.span), entries, &known);
        if terms.get("color").is_some() {
            for name in ["horizon", "zenith"] {
                self.superfluous(
                    &mut terms,
                    name,
                    "give either `color`, or `horizon` and `zenith`",
                );
            }
        }
        let color = terms.color(self, "color", DVec3::ZERO);
        let horizon = terms.color(self, "horizon", color);
        let sky = Sky {
            horizon,
            // A sky with one of them is the same everywhere.
            zenith: terms.color(self, "zenith", horizon),
        };
        finish(terms, sky)
    }

    /// `fog { ... }`
    pub fn fog(&mut self, word: &'a Word, entries: &'a [Entry]) -> Eval<Fog> {
        let mut terms = Terms::new(
            self,
            (&word.text, word.span),
            entries,
            &["color", "density"],
        );
        let fog = Fog {
            color: terms.color(self, "color", DVec3::splat(0.5)),
            density: terms.number(self, "density", NOT_NEGATIVE, 0.02),
        };
        finish(terms, fog)
    }

    /// `render { ... }`
    pub fn render(&mut self, word: &'a Word, entries: &'a [Entry]) -> Eval<Settings> {
        let known = [
            "size",
            "samples",
            "sampling",
            "depth",
            "tolerance",
            "max_steps",
            "method",
            "omega",
            "seed",
        ];
        let mut terms = Terms::new(self, (&word.text, word.span), entries, &known);
        let default = Settings::default();
        let whole = |low: f64, high: f64| move |x: f64| low <= x && x <= high && x.fract() == 0.0;
        let pixels = (
            "whole numbers from 1 to 16384",
            whole(1.0, f64::from(Settings::MAX_SIDE)),
        );
        let size = terms.pair(self, "size", pixels);
        let mut count = |machine: &mut Self, name, words, (low, high), default: u32| {
            terms.number(machine, name, (words, whole(low, high)), f64::from(default)) as u32
        };
        let samples = count(
            self,
            "samples",
            "a whole number from 1 to 65536",
            (1.0, 65_536.0),
            default.samples,
        );
        let depth = count(
            self,
            "depth",
            "a whole number from 0 to 1000",
            (0.0, 1000.0),
            default.depth,
        );
        let max_steps = count(
            self,
            "max_steps",
            "a whole number from 1 to 1000000",
            (1.0, 1e6),
            default.max_steps,
        );
        let omegas = ("at least 1 and below 2", |x: f64| {
            Settings::OMEGAS.contains(&x)
        });
        let seeds = ("a whole number from 0 to 2^53", whole(0.0, 2f64.powi(53)));
        let settings = Settings {
            size: size.map_or(default.size, |s| s.map(|x| x as u32)),
            samples,
            sampling: terms.choice(self, "sampling", &Sampling::ALL, default.sampling),
            depth,
            tolerance: terms.number(self, "tolerance", POSITIVE, default.tolerance),
            max_steps,
            method: terms.choice(self, "method", &Method::ALL, default.method),
            omega: terms.number(self, "omega", omegas, default.omega),
            seed: terms.number(self, "seed", seeds, 0.0) as u64,
        };
        finish(terms, settings)
    }
}

fn finish<T>(terms: Terms<'_>, result: T) -> Eval<T> {
    if terms.is_broken {
        Err(Stop)
    } else {
        Ok(result)
    }
}
