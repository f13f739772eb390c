//! Noise and what is made of it: words that take a point.

use super::arguments::Given;
use super::machine::{Eval, Machine};
use super::numeric::Arithmetic;
use super::report::Diagnostic;
use super::source::Span;
use super::value::{Form, Quantity, Scalar, Value};
use crate::catalogue::Function;

/// How many octaves may be summed: below the last, cells are smaller than a millionth of the first.
const MAX_OCTAVES: f64 = 20.0;

/// How far octaves are moved against each other, so that their zeros do not meet.
const OCTAVE_SHIFT: [f64; 3] = [17.137, 9.743, 31.389];

/// The octaves of a sum of noise.
#[derive(Clone, Copy, Debug)]
pub(super) struct Octaves {
    pub count: u32,
    /// The amplitude of each in terms of the one before.
    pub gain: f64,
    /// The frequency of each in terms of the one before.
    pub lacunarity: f64,
}

impl Octaves {
    /// So many octaves, each of half the size and half the amplitude of the one before.
    pub const fn halved(count: u32) -> Self {
        Self {
            count,
            gain: 0.5,
            lacunarity: 2.0,
        }
    }
}

impl<'a> Machine<'a> {
    /// `noise(p)` and `voronoi(p)`.
    pub fn lattice(&mut self, function: Function, given: &Given<'a>, at: Span) -> Eval<Value> {
        let point = self.place_of(given, function)?;
        let value = self.apply(function, &point);
        self.number(value, at)
    }

    /// The three components of a point; a third that is missing is 0.
    fn place_of(&mut self, given: &Given<'a>, function: Function) -> Eval<[Scalar; 3]> {
        let callee = match function {
            Function::Voronoi3 => "voronoi",
            _ => "noise",
        };
        match given.value.quantity() {
            Some(quantity) if quantity.form == Form::Vector => Ok(quantity.scalars),
            _ => self.unfit(given, callee, "a point"),
        }
    }

    /// `fbm(p, octaves: 4, gain: 0.5, lacunarity: 2)`
    pub fn fbm_call(
        &mut self,
        p: &Given<'a>,
        rest: [Option<Given<'a>>; 3],
        at: Span,
    ) -> Eval<Value> {
        let [octaves, gain, lacunarity] = rest;
        let point = self.place_of(p, Function::Noise3)?;
        let place = octaves.as_ref().map_or(at, |given| given.span);
        let count = self.positive_or(octaves, "octaves", "fbm", 4.0)?;
        if count.fract() != 0.0 || count > MAX_OCTAVES {
            let message = format!("`octaves` of `fbm` must be a whole number up to {MAX_OCTAVES}");
            let error = Diagnostic::error(place, message);
            return self.fail(error.label(Value::Number(count).shown()));
        }
        let octaves = Octaves {
            count: count as u32,
            gain: self.positive_or(gain, "gain", "fbm", 0.5)?,
            lacunarity: self.positive_or(lacunarity, "lacunarity", "fbm", 2.0)?,
        };
        let value = self.fbm(point, octaves);
        self.number(value, at)
    }

    /// The sum of noise of ever higher frequency and smaller amplitude, the first of both 1. Source: Musgrave 1989.
    pub fn fbm(&mut self, p: [Scalar; 3], octaves: Octaves) -> Scalar {
        let mut sum = Scalar::Known(0.0);
        let (mut amplitude, mut frequency) = (1.0, 1.0);
        for octave in 0..octaves.count {
            let mut q = p;
            for (coordinate, shift) in q.iter_mut().zip(OCTAVE_SHIFT) {
                let scaled = self.scaled(*coordinate, frequency);
                let shift = Scalar::Known(shift * f64::from(octave));
                *coordinate = self.arithmetic(Arithmetic::Add, scaled, shift);
            }
            let noise = self.apply(Function::Noise3, &q);
            let noise = self.scaled(noise, amplitude);
            sum = self.arithmetic(Arithmetic::Add, sum, noise);
            amplitude *= octaves.gain;
            frequency *= octaves.lacunarity;
        }
        sum
    }

    fn scaled(&mut self, x: Scalar, factor: f64) -> Scalar {
        self.arithmetic(Arithmetic::Multiply, x, Scalar::Known(factor))
    }

    /// The point in terms of a size.
    fn shrunk(&mut self, point: &Value, size: f64) -> [Scalar; 3] {
        let mut q = point
            .quantity()
            .map_or([Scalar::Known(0.0); 3], |p: Quantity| p.scalars);
        for coordinate in &mut q {
            *coordinate = self.scaled(*coordinate, 1.0 / size);
        }
        q
    }

    /// The share of the veins of marble: (1 - |sin(pi t)|)^3, with t along a slant and shaken by noise.
    pub fn marble_share(&mut self, point: &Value, size: f64, turbulence: f64) -> Scalar {
        let q = self.shrunk(point, size);
        let noise = self.fbm(q, Octaves::halved(5));
        let mut along = self.scaled(noise, 0.8 * turbulence);
        for (coordinate, slant) in q.into_iter().zip([0.8, 0.5, 0.3]) {
            let part = self.scaled(coordinate, slant);
            along = self.arithmetic(Arithmetic::Add, along, part);
        }
        let angle = self.scaled(along, std::f64::consts::PI);
        let wave = self.apply(Function::Sin, &[angle]);
        let wave = self.apply(Function::Abs, &[wave]);
        let vein = self.arithmetic(Arithmetic::Subtract, Scalar::Known(1.0), wave);
        self.arithmetic(Arithmetic::Power, vein, Scalar::Known(3.0))
    }

    /// The share of late wood: rings around the y axis, shaken by noise, that darken outwards and end sharply.
    pub fn wood_share(&mut self, point: &Value, width: f64, turbulence: f64) -> Scalar {
        let q = self.shrunk(point, width);
        let [x, y, z] = q;
        // Trunks are longer than they are thick, and so is their noise.
        let slow = [(x, 0.2), (y, 0.05), (z, 0.2)].map(|(c, scale)| self.scaled(c, scale));
        let noise = self.fbm(slow, Octaves::halved(3));
        let bend = self.scaled(noise, 1.2 * turbulence);
        let radius = self.apply(Function::Hypot, &[x, z]);
        let radius = self.arithmetic(Arithmetic::Add, radius, bend);
        let ring = self.apply(Function::Fract, &[radius]);
        let mut step = |low: f64, high: f64| {
            self.apply(
                Function::Smoothstep,
                &[Scalar::Known(low), Scalar::Known(high), ring],
            )
        };
        let (rise, fall) = (step(0.1, 0.85), step(0.88, 1.0));
        let late = self.arithmetic(Arithmetic::Subtract, rise, fall);
        let fine = [(x, 5.0), (y, 0.25), (z, 5.0)].map(|(c, scale)| self.scaled(c, scale));
        let grain = self.apply(Function::Noise3, &fine);
        let grain = self.scaled(grain, 0.25);
        let share = self.arithmetic(Arithmetic::Add, late, grain);
        self.apply(
            Function::Clamp,
            &[share, Scalar::Known(0.0), Scalar::Known(1.0)],
        )
    }
}
