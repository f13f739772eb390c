//! Scripts that nobody wrote: random ones from the grammar and the catalogue's declarations, and examples with bytes,
//! words and lines changed. A script loads or is refused with a message; what loads is rendered. Nothing ever panics.

#[allow(dead_code)]
#[path = "catalogue/samples.rs"]
mod samples;
mod stub;

use fieldstone::catalogue::*;
use fieldstone::lang;
use fieldstone::render::{Channel, RenderOptions, render};
use fieldstone::scene::Node;
use fieldstone::trace::World;
use rayon::prelude::*;
use samples::{Dice, arguments};
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use stub::Marcher;

/// How many random scripts are tried; their seeds are 0, 1, 2, ...
const SCRIPTS: u64 = 400;

/// How many changes are tried on each example.
const CHANGES: u64 = 40;

/// What became of a script.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fate {
    Refused,
    Loaded,
    Rendered,
}

/// Loads a script and renders 8 x 6 pixels of it, if wanted.
fn fate(name: &str, text: &str, is_rendered: bool) -> Fate {
    let mut loaded = match lang::load_text(name, text, &[], &Marcher) {
        Ok(loaded) => loaded,
        Err(report) => {
            assert!(!report.to_string().is_empty(), "refused without a word");
            return Fate::Refused;
        }
    };
    let _ = loaded.warnings.to_string();
    if !is_rendered {
        return Fate::Loaded;
    }
    let settings = &mut loaded.scene.settings;
    (settings.size, settings.samples) = ([8, 6], settings.samples.min(2));
    // A shape without a constant is refused here.
    let Ok(world) = World::new(&loaded.scene) else {
        return Fate::Loaded;
    };
    let options = RenderOptions {
        channels: &Channel::ALL,
        threads: 1,
        ..RenderOptions::default()
    };
    let picture = render(&loaded.scene, &world, &options);
    let rays = &picture.statistics.primary;
    let samples = u64::from(loaded.scene.settings.samples);
    assert_eq!(
        rays.hits + rays.misses + rays.unknown,
        48 * samples,
        "rays without a verdict"
    );
    Fate::Rendered
}

/// Runs `try_one` on every case, and names those that panic by what `describe` says.
fn survive<C: Send + Sync>(
    cases: &[C],
    try_one: impl Fn(&C) -> Fate + Sync,
    describe: impl Fn(&C) -> String,
) -> Vec<Fate> {
    let fates: Vec<Result<Fate, String>> = cases
        .par_iter()
        .map(|case| {
            catch_unwind(AssertUnwindSafe(|| try_one(case))).map_err(|panic| {
                let text = panic.downcast_ref::<String>().cloned();
                text.or_else(|| panic.downcast_ref::<&str>().map(|s| s.to_string()))
                    .unwrap_or_default()
            })
        })
        .collect();
    let broken: Vec<String> = cases
        .iter()
        .zip(&fates)
        .filter_map(|(case, fate)| Some(format!("{}\n-> {}", describe(case), fate.as_ref().err()?)))
        .collect();
    assert!(
        broken.is_empty(),
        "{} of {}:\n{}",
        broken.len(),
        cases.len(),
        broken[..broken.len().min(3)].join("\n\n")
    );
    fates.into_iter().flatten().collect()
}

#[test]
fn random_scripts_that_load_are_rendered() {
    let scripts: Vec<(u64, String)> = (0..SCRIPTS)
        .map(|seed| (seed, Writer::new(seed).script()))
        .collect();
    let fates = survive(
        &scripts,
        |(_, text)| fate("random.sdf", text, true),
        |(seed, text)| format!("seed {seed}:\n{text}"),
    );
    let count = |fate: Fate| fates.iter().filter(|f| **f == fate).count();
    println!(
        "{} refused, {} without a constant, {} rendered",
        count(Fate::Refused),
        count(Fate::Loaded),
        count(Fate::Rendered)
    );
    // Else the scripts say nothing about rendering.
    assert!(
        2 * count(Fate::Rendered) > scripts.len(),
        "{} rendered only",
        count(Fate::Rendered)
    );
}

#[test]
fn changed_examples_load_or_are_refused() {
    let mut cases = Vec::new();
    for path in examples() {
        let text = fs::read_to_string(&path).expect("an example");
        for seed in 0..CHANGES {
            let mut dice = Dice::new(seed);
            let mut changed = text.clone();
            for _ in 0..1 + dice.below(2) {
                changed = change(&changed, &mut dice);
            }
            cases.push((
                format!("{} changed by seed {seed}", path.display()),
                changed,
            ));
        }
    }
    let fates = survive(
        &cases,
        |(name, text)| fate(name, text, false),
        |(name, _)| name.clone(),
    );
    let refused = fates.iter().filter(|f| **f == Fate::Refused).count();
    println!("{refused} of {} refused", fates.len());
    assert!(refused > 0 && refused < fates.len());
}

fn examples() -> Vec<PathBuf> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("examples");
    let mut all: Vec<PathBuf> = fs::read_dir(folder)
        .expect("the examples")
        .flatten()
        .map(|file| file.path())
        .filter(|path| path.extension().is_some_and(|e| e == "sdf"))
        .collect();
    all.sort();
    assert!(all.len() > 10, "{} examples", all.len());
    all
}

/// Bytes that mean something, or nothing at all.
const ODD: &[u8] = b"(){}[]\",.:=+-*/%^&|<>#0123456789\n\0\xff";

/// A text with one thing changed: a byte, a word, a line.
fn change(text: &str, dice: &mut Dice) -> String {
    let mut bytes = text.as_bytes().to_vec();
    if bytes.is_empty() {
        return String::new();
    }
    let place = dice.below(bytes.len());
    let kind = dice.below(8);
    match kind {
        0 => bytes[place] ^= 1 << dice.below(7),
        1 => bytes[place] = ODD[dice.below(ODD.len())],
        2 => {
            bytes.remove(place);
        }
        3 => {
            let end = (place + 1 + dice.below(40)).min(bytes.len());
            bytes.drain(place..end);
        }
        4 => {
            let end = (place + 1 + dice.below(40)).min(bytes.len());
            let part = bytes[place..end].to_vec();
            let to = dice.below(bytes.len());
            bytes.splice(to..to, part);
        }
        5 => {
            let mut lines: Vec<&str> = text.lines().collect();
            let (a, b) = (dice.below(lines.len()), dice.below(lines.len()));
            lines.swap(a, b);
            return lines.join("\n");
        }
        _ => {
            // Words: one in the place of another, or two swapped.
            let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
            let starts: Vec<(usize, &str)> = text
                .split(|c| !is_word(c))
                .filter(|word| !word.is_empty())
                .map(|word| (word.as_ptr() as usize - text.as_ptr() as usize, word))
                .collect();
            let [mut a, mut b] = [0; 2].map(|_: usize| starts[dice.below(starts.len())]);
            if a.0 > b.0 {
                (a, b) = (b, a);
            }
            if a.0 == b.0 {
                return text.replacen(a.1, "1e9", 1);
            }
            let (before, between) = (&text[..a.0], &text[a.0 + a.1.len()..b.0]);
            let first = if kind == 6 { a.1 } else { b.1 };
            return format!(
                "{before}{first}{between}{}{}",
                a.1,
                &text[b.0 + b.1.len()..]
            );
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Writes random scripts, most of which are right.
struct Writer {
    dice: Dice,
    text: String,
    shapes: Vec<String>,
    fields: Vec<String>,
    materials: Vec<String>,
    numbers: Vec<String>,
}

impl Writer {
    fn new(seed: u64) -> Self {
        Self {
            dice: Dice::new(seed ^ 0x5c21),
            text: String::new(),
            shapes: Vec::new(),
            fields: Vec::new(),
            materials: Vec::new(),
            numbers: Vec::new(),
        }
    }

    fn script(mut self) -> String {
        if self.dice.unit() < 0.4 {
            self.line("param n = 3 in 1..=5 \"copies\"");
            self.numbers.push("n".into());
        }
        for i in 0..self.dice.below(3) {
            let value = self.number(2);
            self.line(&format!("let a{i} = {value}"));
            self.numbers.push(format!("a{i}"));
        }
        if self.dice.unit() < 0.4 {
            let body = self.number(2);
            self.line(&format!(
                "fn twice(x, y = 2) {{ let z = x * y return if z > {body} {{ z }} else {{ -z }} }}"
            ));
            self.numbers.push("twice(0.3)".into());
            self.numbers.push("twice(0.3, y: 1)".into());
        }
        for i in 0..self.dice.below(3) {
            let body = self.of_point(3);
            self.line(&format!("field f{i}(p, k = 3) {{ {body} }}"));
            self.fields.push(format!("f{i}"));
        }
        for i in 0..self.dice.below(3) {
            let pattern = self.of_point(2);
            let term = match self.dice.below(3) {
                0 => "#c84".into(),
                1 => {
                    self.line(&format!(
                        "pattern t{i}(p) {{ mix(#123456, #fed, clamp({pattern}, 0, 1)) }}"
                    ));
                    format!("t{i}")
                }
                _ => "checker(#eee, #345, size: 0.5)".into(),
            };
            let (reflect, refract) = (0.5 * self.dice.unit(), 0.5 * self.dice.unit());
            self.line(&format!("material m{i} {{ color: {term}, reflect: {reflect}, refract: {refract}, ior: 1.3 }}"));
            self.materials.push(format!("m{i}"));
        }
        for i in 0..1 + self.dice.below(3) {
            let shape = self.shape(3);
            self.line(&format!("let s{i} = {shape}"));
            self.shapes.push(format!("s{i}"));
        }
        for _ in 0..1 + self.dice.below(2) {
            let shape = self.shape(2);
            let paint = match self.dice.below(self.materials.len() + 1) {
                0 => String::new(),
                i => format!(".paint({})", self.materials[i - 1]),
            };
            self.line(&format!("show ({shape}){paint}"));
        }
        if self.dice.unit() < 0.3 {
            self.line("show plane(\"y\", -1)");
        }
        let eye: Vec<f64> = (0..3).map(|_| self.dice.between(-3.0, 3.0)).collect();
        match self.dice.below(3) {
            0 => self.line(&format!(
                "camera {{ eye: [{}, {}, {}], at: [0, 0.1, 0] }}",
                eye[0], eye[1], eye[2]
            )),
            1 => self.line("camera { projection: \"orthographic\", height: 3 }"),
            _ => {}
        }
        if self.dice.unit() < 0.5 {
            self.line(
                "light { position: [2, 4, 3], intensity: 0.8 }\nlight { toward: [-1, 2, 1] }",
            );
        }
        if self.dice.unit() < 0.2 {
            self.line("fog { density: 0.05 }");
        }
        if self.dice.unit() < 0.3 {
            let number = self.number(2);
            self.line(&format!("test \"t\" {{ expect {number} <= 3 }}"));
        }
        self.text
    }

    fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    fn one_of<'a>(&mut self, all: &[&'a str]) -> &'a str {
        all[self.dice.below(all.len())]
    }

    /// A number of moderate size, now and then an odd one.
    fn literal(&mut self) -> String {
        match self.dice.below(40) {
            0 => "0".into(),
            1 => "-1".into(),
            2 => "1e9".into(),
            3 => "1e-9".into(),
            _ => format!("{}", (self.dice.between(0.1, 2.0) * 100.0).round() / 100.0),
        }
    }

    /// An expression that is a number.
    fn number(&mut self, depth: u32) -> String {
        if depth == 0 {
            return match self.dice.below(self.numbers.len() + 2) {
                i if i < self.numbers.len() => self.numbers[i].clone(),
                _ => self.literal(),
            };
        }
        let (a, b) = (self.number(depth - 1), self.number(depth - 1));
        match self.dice.below(9) {
            0 => format!("({a} + {b})"),
            1 => format!("({a} * {b})"),
            2 => format!("max({a}, {b})"),
            3 => format!("mix({a}, {b}, 0.5)"),
            4 => format!("(if {a} < {b} {{ {a} }} else {{ {b} }})"),
            5 => format!("length([{a}, {b}])"),
            6 => format!("abs({a} - {b})"),
            7 => format!("sum(for i in 0..3 {{ {a} * i }}) / 3"),
            _ => format!("[{a}, {b}][1]"),
        }
    }

    /// An expression that is a number for a point p.
    fn of_point(&mut self, depth: u32) -> String {
        if depth == 0 {
            return match self.dice.below(6) {
                0 => self.number(0),
                1 => "length(p)".into(),
                2 => "p[1]".into(),
                _ => format!("p.{}", self.one_of(&["x", "y", "z"])),
            };
        }
        let (a, b) = (self.of_point(depth - 1), self.of_point(depth - 1));
        if self.dice.unit() < 0.25 {
            // Any function of the language.
            let function = Function::ALL[self.dice.below(Function::ALL.len())];
            let arguments = match function.arguments().len() {
                1 => a,
                2 => format!("{a}, {b}"),
                _ => format!("{a}, {b}, 1.5"),
            };
            return format!("{}({arguments})", function.name());
        }
        match self.dice.below(9) {
            0 => format!("({a} + {b})"),
            1 => format!("({a} - {b})"),
            2 => format!("({a} * {b})"),
            3 => format!("min({a}, {b})"),
            4 => format!("max({a}, {b})"),
            5 => format!("sin(3 * {a})"),
            6 => format!("(if {a} < {b} {{ {a} }} else {{ {b} }})"),
            7 => format!("hypot({a}, {b})"),
            _ => format!("abs({a})"),
        }
    }

    /// A call of one of these entries with arguments that `suits` takes; positional or by name, perhaps without those
    /// that have defaults, now and then with one that is out of its range.
    fn call(
        &mut self,
        all: &[&'static Declaration],
        suits: impl Fn(&'static Declaration, &[Argument]) -> bool,
    ) -> (&'static str, Vec<String>) {
        for _ in 0..10_000 {
            let declaration = all[self.dice.below(all.len())];
            let values = arguments(declaration, &mut self.dice);
            if suits(declaration, &values) {
                return (declaration.name, self.arguments(declaration, &values));
            }
        }
        panic!("none of {} entries suits", all.len());
    }

    fn arguments(&mut self, declaration: &Declaration, values: &[Argument]) -> Vec<String> {
        const ODD: [&str; 6] = ["0", "-1", "1e300", "\"x\"", "[]", "45deg"];
        let by_name = self.dice.unit() < 0.5;
        let is_short = by_name && self.dice.unit() < 0.2;
        let odd = (self.dice.unit() < 0.03).then(|| self.dice.below(values.len().max(1)));
        let mut words = Vec::new();
        for (i, (parameter, value)) in declaration.parameters.iter().zip(values).enumerate() {
            if is_short && parameter.default.is_some() {
                continue;
            }
            let value = if odd == Some(i) {
                self.one_of(&ODD).to_string()
            } else {
                value.to_string().replace("inf", "infinity")
            };
            words.push(if by_name {
                format!("{}: {value}", parameter.name)
            } else {
                value
            });
        }
        words
    }

    /// A primitive that is or is not a profile.
    fn leaf(&mut self, is_planar: bool) -> String {
        let (name, words) = self.call(AnyPrimitive::DECLARATIONS, |d, values| {
            let primitive = AnyPrimitive::from_arguments(d.name, values).expect("listed by name");
            Node::primitive(primitive).is_ok_and(|node| node.traits().is_planar == is_planar)
        });
        format!("{name}({})", words.join(", "))
    }

    /// A modifier that a shape in space takes.
    fn modifier(&mut self) -> String {
        let ball = Node::primitive(AnyPrimitive::Sphere(Sphere::new(0.5))).expect("a ball");
        let (name, words) = self.call(AnyModifier::DECLARATIONS, |d, values| {
            let modifier = AnyModifier::from_arguments(d.name, values).expect("listed by name");
            Node::modifier(modifier, ball.clone()).is_ok()
        });
        format!("{name}({})", words.join(", "))
    }

    /// Two shapes as one, by any blend in any of its uses.
    fn joined(&mut self, a: &str, b: &str) -> String {
        let made = |d: &Declaration, values: &[Argument]| {
            AnyBlend::from_arguments(d.name, values).expect("listed by name")
        };
        let is_seam = self.dice.unit() < 0.7;
        let (name, mut words) = self.call(AnyBlend::DECLARATIONS, |d, values| {
            (made(d, values).manner() == Manner::Seam) == is_seam
        });
        if is_seam {
            let operation = self.one_of(&["union", "intersection", "difference"]);
            return format!("{operation}({a}, {b}, blend: {name}({}))", words.join(", "));
        }
        words.insert(0, format!("{a}, {b}"));
        format!("{name}({})", words.join(", "))
    }

    /// An expression that is a shape in space.
    fn shape(&mut self, depth: u32) -> String {
        if depth == 0 {
            return match self.dice.below(8) {
                0 if !self.shapes.is_empty() => {
                    self.shapes[self.dice.below(self.shapes.len())].clone()
                }
                1 if !self.fields.is_empty() => {
                    format!(
                        "({} & box(1.4))",
                        self.fields[self.dice.below(self.fields.len())]
                    )
                }
                2 => {
                    let profile = self.leaf(true);
                    format!(
                        "{profile}{}",
                        self.one_of(&[".extrude(0.4)", ".revolve()", ".revolve(offset: 0.6)"])
                    )
                }
                _ => self.leaf(false),
            };
        }
        match self.dice.below(10) {
            0..=3 => {
                let shape = self.shape(depth - 1);
                let call = self.modifier();
                format!("{shape}.{call}")
            }
            4 => {
                let (a, b) = (self.shape(depth - 1), self.shape(depth - 1));
                format!("({a} {} {b})", self.one_of(&["|", "&", "-"]))
            }
            5 | 6 => {
                let (a, b) = (self.shape(depth - 1), self.shape(depth - 1));
                self.joined(&a, &b)
            }
            7 => {
                let shape = self.shape(depth - 1);
                format!("union(for i in 0..3 {{ {shape}.translate([0.7 * i, 0, 0]) }})")
            }
            8 => {
                let (a, b) = (self.shape(depth - 1), self.shape(depth - 1));
                let number = self.number(1);
                format!("(if {number} > 1 {{ {a} }} else {{ {b} }})")
            }
            _ => self.shape(depth - 1),
        }
    }
}
