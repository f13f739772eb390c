//! Every entry of the catalogue answers a wrong argument with a message that names the entry and the parameter.
//!
//! Calls are made from the declarations and their examples: a new entry is tested without a word here.

use fieldstone::catalogue::{Argument, Kind, Parameter};
use fieldstone::lang::{Loaded, Word, load_text};
use fieldstone::trace::SceneTracer;

/// Every word of the catalogue that takes parameters.
fn entries() -> Vec<Word> {
    let mut all = Word::all();
    all.retain(|word| !word.parameters.is_empty());
    all
}

/// The call of a word in its example: what stands before and behind, and its arguments.
struct Call {
    before: String,
    operands: Vec<String>,
    /// The argument for each parameter, where the example has one.
    given: Vec<Option<String>>,
    behind: String,
}

impl Call {
    fn of(word: &Word) -> Self {
        let example = word.example;
        let start = format!("{}(", word.name);
        let is_whole =
            |at: usize| !example[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_');
        let place = example
            .match_indices(&start)
            .map(|(at, _)| at)
            .find(|at| is_whole(*at));
        let inside = place.expect("the example calls its word") + start.len();
        let end = inside + closing(&example[inside..]);
        let mut call = Self {
            before: example[..inside].into(),
            operands: Vec::new(),
            given: vec![None; word.parameters.len()],
            behind: example[end..].into(),
        };
        let mut place = 0;
        for argument in split(&example[inside..end]) {
            let label = argument
                .split_once(':')
                .map(|(label, value)| (label.trim(), value.trim()));
            let named = label.and_then(|(label, value)| {
                let place = word.parameters.iter().position(|p| p.name == label)?;
                Some((place, value))
            });
            match named {
                Some((place, value)) => call.given[place] = Some(value.into()),
                None if call.operands.len() < word.operands => call.operands.push(argument.into()),
                None => {
                    call.given[place] = Some(argument.into());
                    place += 1;
                }
            }
        }
        call
    }

    /// The example with `value` as the argument for parameter number `place`.
    fn with(&self, word: &Word, place: usize, value: &str) -> String {
        let mut given = self.given.clone();
        given[place] = Some(value.into());
        self.written(word, &given, "")
    }

    fn written(&self, word: &Word, given: &[Option<String>], more: &str) -> String {
        let mut arguments = self.operands.clone();
        for (parameter, value) in word.parameters.iter().zip(given) {
            arguments.extend(
                value
                    .as_ref()
                    .map(|value| format!("{}: {value}", parameter.name)),
            );
        }
        arguments.extend((!more.is_empty()).then(|| more.to_string()));
        format!("{}{}{}", self.before, arguments.join(", "), self.behind)
    }
}

/// Where the bracket that is open at the start of the text is closed.
fn closing(text: &str) -> usize {
    let mut depth = 1;
    let place = text.find(|c| {
        match c {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth -= 1,
            _ => {}
        }
        depth == 0
    });
    place.expect("brackets are closed")
}

/// The parts between commas that stand in no bracket.
fn split(text: &str) -> Vec<&str> {
    let mut depth = 0;
    let parts = text.split(|c| {
        match c {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth -= 1,
            _ => {}
        }
        c == ',' && depth == 0
    });
    parts
        .map(str::trim)
        .filter(|part| !part.is_empty())
        .collect()
}

/// The script's shape, or the first message about it.
fn loaded(expression: &str) -> Result<Loaded, String> {
    let script = format!("let entry = {expression}\n");
    let loaded = load_text("entry.sdf", &script, &[], &SceneTracer::default());
    loaded.map_err(|report| report.to_string())
}

fn number(x: f64) -> String {
    match x {
        x if x.is_nan() => "(0 / 0)".into(),
        x if x.is_infinite() && x > 0.0 => "infinity".into(),
        x if x.is_infinite() => "-infinity".into(),
        x => format!("{x:e}"),
    }
}

/// A value of the parameter's kind in which `x` stands in one place; all places in turn. None where there are no numbers.
fn values(parameter: &Parameter, x: f64) -> Vec<String> {
    let range = parameter.range;
    let usual = 1f64.clamp(range.low, range.high);
    let list = |components: &[f64]| {
        let places = 0..components.len();
        let changed = places.map(|place| {
            let all = components.iter().enumerate();
            let all = all.map(|(i, c)| number(if i == place { x } else { *c }));
            format!("[{}]", all.collect::<Vec<_>>().join(", "))
        });
        changed.collect::<Vec<_>>()
    };
    let default = parameter.default.map(|default| default());
    match (parameter.kind, default) {
        (Kind::Number | Kind::Count, _) => vec![number(x)],
        (Kind::Angle, _) => vec![format!("{} * 1rad", number(x))],
        (_, Some(Argument::Vector2(v))) => list(&v),
        (_, Some(Argument::Vector3(v))) => list(&v),
        (Kind::Vector2, _) => list(&[usual; 2]),
        (Kind::Vector3 | Kind::Factors | Kind::Direction, _) => list(&[usual; 3]),
        (Kind::Points, _) => vec![format!("[[-1, -1], [1, {}], [0, 1]]", number(x))],
        (Kind::Points3, _) => vec![format!("[[0, 0, {}], [0.5, 0, 0]]", number(x))],
        _ => vec![],
    }
}

/// Numbers in and around a range, and those that are no sizes.
fn numbers(parameter: &Parameter) -> Vec<f64> {
    let range = parameter.range;
    let mut all = vec![
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        0.0,
        -1.0,
        1e-300,
        1e300,
    ];
    all.extend(
        [range.low, range.low - 1.0]
            .iter()
            .filter(|x| x.abs() < 1e9),
    );
    all.extend(
        [range.high, range.high + 1.0]
            .iter()
            .filter(|x| x.abs() < 1e9),
    );
    all
}

/// Runs `law` on every parameter of every entry.
fn for_all(law: impl Fn(&Word, &Call, usize) -> Result<(), String>) {
    let mut broken = Vec::new();
    for word in entries() {
        let call = Call::of(&word);
        for place in 0..word.parameters.len() {
            broken.extend(law(&word, &call, place).err());
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn examples_called_by_name_load() {
    for_all(|word, call, _| {
        let expression = call.written(word, &call.given, "");
        loaded(&expression).map(drop)
    });
}

#[test]
fn unknown_arguments_are_named() {
    for_all(|word, call, _| {
        let expression = call.written(word, &call.given, "no_such_argument: 1");
        let expected = format!("`{}` has no argument `no_such_argument`", word.name);
        match loaded(&expression) {
            Err(message) if message.contains(&expected) => Ok(()),
            other => Err(format!("{expression}: {:?}", other.err())),
        }
    });
}

#[test]
fn arguments_of_another_kind_are_told_what_is_expected() {
    for_all(|word, call, place| {
        let parameter = &word.parameters[place];
        let expression = call.with(word, place, "\"none\"");
        let (kind, name) = (parameter.kind.noun(), word.name);
        let expected = format!("`{}` of `{name}` expects {kind}", parameter.name);
        match loaded(&expression) {
            Err(message) if message.contains(&expected) => Ok(()),
            other => Err(format!("{expression}: {:?}", other.err())),
        }
    });
}

#[test]
fn values_out_of_range_are_told_the_range() {
    for_all(|word, call, place| {
        let parameter = &word.parameters[place];
        let numbers = numbers(parameter)
            .into_iter()
            .filter(|x| !parameter.range.contains(*x));
        for value in numbers.flat_map(|x| values(parameter, x)) {
            let expression = call.with(word, place, &value);
            let expected = format!("`{}` of `{}` must be", parameter.name, word.name);
            match loaded(&expression) {
                Err(message) if message.contains(&expected) => {}
                other => return Err(format!("{expression}: {:?}", other.err())),
            }
        }
        Ok(())
    });
}

/// What the range of one parameter allows makes a shape with a constant, or an error that names a parameter; or, where
/// the shape it is applied to has a part in it, says what to do instead.
#[test]
fn degenerate_sizes_make_a_shape_or_a_message() {
    for_all(|word, call, place| {
        let parameter = &word.parameters[place];
        let numbers = numbers(parameter)
            .into_iter()
            .filter(|x| parameter.range.contains(*x));
        for value in numbers.flat_map(|x| values(parameter, x)) {
            let expression = call.with(word, place, &value);
            match loaded(&expression) {
                Ok(loaded) => {
                    let constant = loaded.names["entry"].lipschitz();
                    if constant.is_nan() || constant < 0.0 {
                        return Err(format!("{expression}: the constant is {constant}"));
                    }
                }
                Err(message) => {
                    let error = message.lines().find(|line| line.starts_with("error: "));
                    let error = error.unwrap_or_default();
                    let is_named = |p: &Parameter| error.contains(p.name);
                    if !word.parameters.iter().any(is_named) && !message.contains("= help: ") {
                        return Err(format!("{expression}: {message}"));
                    }
                }
            }
        }
        Ok(())
    });
}
