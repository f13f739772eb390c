//! The results of tests as JUnit's XML, which build servers read, and as JSON.

use serde_json::{Value, json};
use std::fmt::Write;

/// The tests of a script.
pub struct Suite {
    /// The script, as it was given.
    pub script: String,
    /// Its tests; `None` if the script could not be loaded.
    pub cases: Option<Vec<Case>>,
}

/// A test.
pub struct Case {
    /// Its name.
    pub name: String,
    /// What failed, as it is said to people; nothing if it passed.
    pub failure: Option<String>,
    /// What was reached, where that was measured.
    pub reached: Option<Value>,
}

impl Suite {
    fn cases(&self) -> &[Case] {
        self.cases.as_deref().unwrap_or(&[])
    }

    fn failed(&self) -> usize {
        self.cases()
            .iter()
            .filter(|case| case.failure.is_some())
            .count()
    }

    fn errors(&self) -> usize {
        usize::from(self.cases.is_none())
    }
}

/// All results as XML. A script that could not be loaded is one test with an error.
pub fn xml(suites: &[Suite]) -> String {
    let sum = |count: &dyn Fn(&Suite) -> usize| suites.iter().map(count).sum::<usize>();
    let tests = sum(&|s| s.cases().len() + s.errors());
    let (failures, errors) = (sum(&Suite::failed), sum(&Suite::errors));
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    add(
        &mut text,
        format_args!(
            "<testsuites name=\"fieldstone\" tests=\"{tests}\" failures=\"{failures}\" errors=\"{errors}\">\n"
        ),
    );
    for suite in suites {
        let script = escaped(&suite.script);
        let (failures, errors) = (suite.failed(), suite.errors());
        let tests = suite.cases().len() + errors;
        add(
            &mut text,
            format_args!(
                "  <testsuite name=\"{script}\" tests=\"{tests}\" failures=\"{failures}\" errors=\"{errors}\">\n"
            ),
        );
        for case in suite.cases() {
            add_case(&mut text, &script, case);
        }
        if suite.cases.is_none() {
            let error = "<error message=\"the script could not be loaded\"/>";
            add(
                &mut text,
                format_args!(
                    "    <testcase classname=\"{script}\" name=\"load\">{error}</testcase>\n"
                ),
            );
        }
        text.push_str("  </testsuite>\n");
    }
    text.push_str("</testsuites>\n");
    text
}

fn add(text: &mut String, more: std::fmt::Arguments) {
    text.write_fmt(more).expect("a string takes everything");
}

fn add_case(text: &mut String, script: &str, case: &Case) {
    let name = escaped(&case.name);
    let start = format!("    <testcase classname=\"{script}\" name=\"{name}\"");
    match &case.failure {
        None => add(text, format_args!("{start}/>\n")),
        Some(failure) => {
            let message = escaped(failure.lines().next().unwrap_or(""));
            let all = escaped(failure);
            add(
                text,
                format_args!(
                    "{start}>\n      <failure message=\"{message}\">{all}</failure>\n    </testcase>\n"
                ),
            );
        }
    }
}

/// The text with what XML keeps for itself written out; characters that it does not allow are left out.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\n' | '\t' => out.push(c),
            '\u{fffe}' | '\u{ffff}' => {}
            c if c.is_control() => {}
            c => out.push(c),
        }
    }
    out
}

/// All results as JSON.
pub fn in_json(suites: &[Suite]) -> String {
    let case = |case: &Case| json!({ "name": case.name, "passed": case.failure.is_none(), "message": case.failure, "reached": case.reached });
    let suite = |suite: &Suite| {
        let cases: Vec<Value> = suite.cases().iter().map(case).collect();
        json!({ "script": suite.script, "is_loaded": suite.cases.is_some(), "tests": cases })
    };
    let all: usize = suites.iter().map(|s| s.cases().len()).sum();
    let failed: usize = suites.iter().map(Suite::failed).sum();
    let scripts: Vec<Value> = suites.iter().map(suite).collect();
    format!(
        "{:#}\n",
        json!({ "schema": 1, "passed": all - failed, "failed": failed, "scripts": scripts })
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_as_xml() {
        let case = |name: &str, failure: Option<&str>| Case {
            name: name.into(),
            failure: failure.map(String::from),
            reached: None,
        };
        let suites = [
            Suite {
                script: "a.sdf".into(),
                cases: Some(vec![
                    case("<b>", None),
                    case("c", Some("error: 1 & 2\nat \"d\"\u{1b}")),
                ]),
            },
            Suite {
                script: "e.sdf".into(),
                cases: None,
            },
        ];
        let expected = r#"<?xml version="1.0" encoding="UTF-8"?>
<testsuites name="fieldstone" tests="3" failures="1" errors="1">
  <testsuite name="a.sdf" tests="2" failures="1" errors="0">
    <testcase classname="a.sdf" name="&lt;b&gt;"/>
    <testcase classname="a.sdf" name="c">
      <failure message="error: 1 &amp; 2">error: 1 &amp; 2
at &quot;d&quot;</failure>
    </testcase>
  </testsuite>
  <testsuite name="e.sdf" tests="1" failures="0" errors="1">
    <testcase classname="e.sdf" name="load"><error message="the script could not be loaded"/></testcase>
  </testsuite>
</testsuites>
"#;
        assert_eq!(xml(&suites), expected);
    }
}
