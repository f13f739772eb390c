//! Scripts that mean harm, or run away: each ends in a clear error, soon and in little memory, and never in a crash.

mod stub;

use fieldstone::lang::limits::*;
use fieldstone::lang::{self, LoadError};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use stub::Marcher;

/// How long a script may take to be refused; builds without optimization get more. Twice what the slowest takes alone: where
/// neighbours share the processor, the same work takes up to twice its time.
const PATIENCE: Duration = Duration::from_secs(if cfg!(debug_assertions) { 20 } else { 4 });

/// Measures how long this process works, while no other test of it does.
struct Clock {
    start: Duration,
    _alone: MutexGuard<'static, ()>,
}

impl Clock {
    fn start() -> Self {
        static ALONE: Mutex<()> = Mutex::new(());
        let alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
        Self {
            start: worked(),
            _alone: alone,
        }
    }

    fn elapsed(&self) -> Duration {
        worked().saturating_sub(self.start)
    }
}

/// The processor time of this process so far, which other processes do not lengthen; elsewhere than on Linux the time of
/// day.
fn worked() -> Duration {
    // Fields 14 and 15, in hundredths of a second; the name before them ends with the last parenthesis.
    let ticks = fs::read_to_string("/proc/self/stat").ok().and_then(|stat| {
        let fields = stat.rsplit_once(')')?.1;
        let fields: Vec<&str> = fields.split_whitespace().collect();
        Some(fields.get(11)?.parse::<u64>().ok()? + fields.get(12)?.parse::<u64>().ok()?)
    });
    static EPOCH: Mutex<Option<Instant>> = Mutex::new(None);
    let mut epoch = EPOCH.lock().unwrap_or_else(PoisonError::into_inner);
    let epoch = epoch.get_or_insert_with(Instant::now);
    ticks.map_or_else(
        || epoch.elapsed(),
        |ticks| Duration::from_millis(10 * ticks),
    )
}

/// The most memory that this process ever held, in kB; 0 where nobody knows.
fn peak_memory() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))
        .and_then(|line| line.split_whitespace().next()?.parse().ok())
        .unwrap_or(0)
}

/// The errors of a script, which must come in time.
fn refused(script: &str) -> String {
    let start = Clock::start();
    let result = lang::load_text("hostile.sdf", script, &[], &Marcher);
    let text = match result {
        Err(report) => report.to_string(),
        Ok(_) => panic!("it is not refused"),
    };
    check(start, &text);
    text
}

fn check(start: Clock, text: &str) {
    let took = start.elapsed();
    assert!(took < PATIENCE, "took {took:?}: {text}");
    assert!(text.len() < 40_000, "{} bytes of message", text.len());
    let most = peak_memory();
    assert!(most < 1 << 20, "{most} kB: {text}");
}

/// Checks that a script is refused with a message that has all of these words.
fn refuses(script: &str, words: &[&str]) {
    let text = refused(script);
    for word in words {
        assert!(text.contains(word), "`{word}` is not in\n{text}");
    }
}

/// A folder of its own for files of a test, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("fieldstone-{}-{name}", std::process::id()));
        fs::create_dir_all(&path).expect("a temporary folder");
        Self(path)
    }

    fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.join(name);
        fs::write(&path, content).expect("a temporary file");
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn refused_file(path: &Path) -> String {
    let start = Clock::start();
    let text = match lang::load(path, &[], &Marcher) {
        Err(LoadError::Script(report)) => report.to_string(),
        other => panic!("{other:?}"),
    };
    check(start, &text);
    text
}

#[test]
fn a_million_open_brackets() {
    for bracket in ["(", "[", "{", "f(", "[("] {
        let script = format!("show {}", bracket.repeat(1_000_000));
        refuses(&script, &["MAX_NESTING", "256"]);
    }
    refuses(&"/*".repeat(1_000_000), &["MAX_NESTING"]);
    refuses(&"if x { ".repeat(100_000), &["MAX_NESTING"]);
}

#[test]
fn a_million_closing_brackets() {
    refuses(
        &format!("show {}", ")".repeat(1_000_000)),
        &["closes nothing"],
    );
}

#[test]
fn runs_of_operators() {
    refuses(&format!("show {}1", "-".repeat(100_000)), &["MAX_NESTING"]);
    refuses(
        &format!("show {}1", "not ".repeat(100_000)),
        &["MAX_NESTING"],
    );
    refuses(&format!("show 1{}", "^1".repeat(100_000)), &["MAX_NESTING"]);
}

#[test]
fn ten_thousand_nested_unions() {
    let script = format!(
        "show {}sphere(1){}",
        "union(".repeat(10_000),
        ")".repeat(10_000)
    );
    refuses(&script, &["MAX_NESTING"]);
    let mut script = "let a0 = sphere(1)\n".to_string();
    for i in 1..10_000 {
        script.push_str(&format!("let a{i} = union(a{}, sphere(2))\n", i - 1));
    }
    script.push_str("show a9999");
    refuses(&script, &["MAX_DEPTH"]);
    let mut script = "let a0 = sphere(1)\n".to_string();
    for i in 1..10_000 {
        script.push_str(&format!("let a{i} = a{}.translate([1, 0, 0])\n", i - 1));
    }
    refuses(&script, &["MAX_DEPTH"]);
}

#[test]
fn a_union_that_doubles() {
    let mut script = "let a0 = sphere(1)\n".to_string();
    for i in 1..64 {
        let b = i - 1;
        script.push_str(&format!(
            "let a{i} = union(a{b}, a{b}.translate([1, 0, 0]), blend: smooth(0.1))\n"
        ));
    }
    script.push_str("show a63");
    refuses(&script, &["MAX_SIZE"]);
}

#[test]
fn a_large_union_by_a_long_blend() {
    let script = "let s = sphere(1)\nlet all = for i in 0..200000 { s }\nshow union(all, blend: stairs(0.1, 32))";
    refuses(script, &["MAX_SIZE"]);
}

#[test]
fn endless_recursion() {
    refuses(
        "fn f(x) { f(x + 1) }\nshow f(0)",
        &["MAX_CALL_DEPTH", "called here", "more calls"],
    );
    refuses(
        "fn f(x) { g(x) }\nfn g(x) { f(x) }\nshow f(0)",
        &["MAX_CALL_DEPTH"],
    );
    refuses("field f(p) { f(p) }\nshow f", &["MAX_CALL_DEPTH"]);
    refuses("fn f(x) { f(x) + f(x) }\nshow f(0)", &["MAX_CALL_DEPTH"]);
    refuses(
        "fn f(n) { if n == 0 { 0 } else { f(n - 1) + f(n - 1) } }\nshow f(60)",
        &["MAX_STEPS"],
    );
    let deep = format!(
        "fn f(x) {{ {}f(x){} }}\nshow f(0)",
        "(1 + ".repeat(200),
        ")".repeat(200)
    );
    refuses(&deep, &["MAX_OPEN_EXPRESSIONS"]);
    let deep = format!(
        "fn f(x) {{ {}f(x){} }}\nshow f(0)",
        "[".repeat(200),
        "]".repeat(200)
    );
    refuses(&deep, &["MAX_OPEN_EXPRESSIONS"]);
    let deep = format!(
        "fn f(x) {{ {}f(x){} }}\nshow f(0)",
        "abs(".repeat(200),
        ")".repeat(200)
    );
    refuses(&deep, &["MAX_OPEN_EXPRESSIONS"]);
    let deep = format!(
        "fn f(x) {{ {}f(x){} }}\nshow f(0)",
        "if true { for i in 0..1 { ".repeat(100),
        "} } else { 0 }".repeat(100)
    );
    refuses(&deep, &["MAX_"]);
}

#[test]
fn recursion_up_to_the_limit_is_fine() {
    let script = "fn f(n) { if n == 0 { 0 } else { 1 + f(n - 1) } }\nshow sphere(f(990))";
    let loaded = lang::load_text("deep.sdf", script, &[], &Marcher);
    assert!(loaded.is_ok());
}

#[test]
fn endless_loops() {
    refuses(
        "show for i in 0..1e12 { sphere(1) }",
        &["MAX_LIST", "1000000000000"],
    );
    refuses(
        "show for i in 0..1 step 1e-300 { sphere(1) }",
        &["MAX_LIST"],
    );
    refuses(
        "show for i in 0..1e308 step 1e-308 { sphere(1) }",
        &["MAX_LIST"],
    );
    refuses("show for i in 0..infinity { sphere(1) }", &["finite"]);
    refuses("show for i in 0..(0/0) { sphere(1) }", &["finite"]);
    refuses("show for i in 0..1 step 0 { sphere(1) }", &["step"]);
    refuses("show for i in 0..1 step -1 { sphere(1) }", &["step"]);
    refuses("show for i in 0..1 step (0/0) { sphere(1) }", &["finite"]);
    refuses(
        "show for i in 0..1000 { for j in 0..1000 { for k in 0..1000 { i + j + k } } }",
        &["MAX_"],
    );
    refuses(
        "let n = sum(for i in 0..1000 { sum(for j in 0..1000 { sum(0..1000) }) })",
        &["MAX_STEPS"],
    );
    refuses("show for i in 0..1000000 { sphere(1) }", &["MAX_S"]);
    refuses(
        "let s = for i in 0..999999 { for j in 0..999999 if false { 1 } }",
        &["MAX_STEPS"],
    );
}

#[test]
fn lists_and_strings_that_double() {
    let mut script = "let a0 = [1, 2, 3, 4]\n".to_string();
    for i in 1..100 {
        let b = i - 1;
        script.push_str(&format!("let a{i} = concat(a{b}, a{b})\n"));
    }
    refuses(&script, &["MAX_LIST"]);
    let mut script = "let a0 = [1, 2, 3, 4]\n".to_string();
    for i in 1..100 {
        let b = i - 1;
        script.push_str(&format!("let a{i} = [a{b}, a{b}]\n"));
    }
    refuses(&script, &["MAX_LIST"]);
    let mut script = "let a0 = \"abc\"\n".to_string();
    for i in 1..100 {
        let b = i - 1;
        script.push_str(&format!("let a{i} = a{b} + a{b}\n"));
    }
    refuses(&script, &["MAX_STRING"]);
    let mut script = "let a0 = []\n".to_string();
    for i in 1..10_000 {
        script.push_str(&format!("let a{i} = [a{}]\n", i - 1));
    }
    refuses(&script, &["MAX_LIST_DEPTH"]);
    refuses(
        &format!("let s = \"{}\"", "x".repeat(100_000)),
        &["MAX_STRING"],
    );
}

#[test]
fn graphs_and_patterns_that_double() {
    let mut script = "field f(p) { let a0 = p.x\n".to_string();
    for i in 1..15_000 {
        script.push_str(&format!("let a{i} = sin(a{}) + {i}\n", i - 1));
    }
    script.push_str("return a14999 }\nshow f & box(1)");
    refuses(&script, &["MAX_GRAPH"]);
    let mut script = "field f0(p) { sin(p.x) }\n".to_string();
    for i in 1..64 {
        let b = i - 1;
        script.push_str(&format!("field f{i}(p) {{ f{b}(p) + f{b}(p * 1.1) }}\n"));
    }
    refuses(&script, &["MAX_"]);
    let mut script = "field f0(p) { sin(p.x) }\n".to_string();
    for i in 1..64 {
        let b = i - 1;
        script.push_str(&format!(
            "field f{i}(p) {{ f{b}.at(p) + f{b}.at(p * 1.1) }}\n"
        ));
    }
    refuses(&script, &["MAX_"]);
    let mut script = "let p0 = checker(#000, #fff)\n".to_string();
    for i in 1..40 {
        let b = i - 1;
        script.push_str(&format!("let p{i} = checker(p{b}, p{b}, size: 2)\n"));
    }
    script.push_str("material m { color: p39 }\nshow sphere(1).paint(m)");
    refuses(&script, &["MAX_"]);
}

#[test]
fn many_shapes_of_one_field() {
    let script = "field f(p) { sin(p.x * 3) * sin(p.y * 4.1) + sin(p.z * 5.3) * sin(p.x * p.y) }\n\
         show for i in 0..3000 { (f & sphere(1 + i / 1000)).translate([i, 0, 0]) }";
    let start = Clock::start();
    let result = lang::load_text("hostile.sdf", script, &[], &Marcher);
    let took = start.elapsed();
    assert!(took < PATIENCE, "took {took:?}, {}", result.is_ok());
}

#[test]
fn fields_of_large_shapes() {
    let script = "let many = union(for i in 0..20000 { sphere(1).translate([i, 0, 0]) })\n\
         field f(p) lipschitz 0.1 { many.at(p) + many.at(p * 1.1) + many.at(p * 1.2) }\n\
         field g(p) { many.at(p) * p.x }\nshow f & box(100)\nshow g & box(100)";
    refuses(script, &["refuted"]);
}

#[test]
fn many_names_load_in_time() {
    let lets: String = (0..60_000)
        .map(|i| format!("let _a{i} = sphere({i} + 1)\n"))
        .collect();
    let start = Clock::start();
    let result = lang::load_text("names.sdf", &lets, &[], &Marcher);
    let took = start.elapsed();
    assert!(result.is_ok());
    assert!(took < PATIENCE, "{took:?}");
    drop(start);
    let shapes: String = (0..100)
        .map(|i| format!("let _a{i} = for i in 0..1000 {{ sphere(1) }}\n"))
        .collect();
    let filler =
        format!("// {}\n", "x".repeat(MAX_SCRIPT_BYTES / 2)).replace("xxxxxxxx", "xxxxxxx\n//");
    let start = Clock::start();
    let result = lang::load_text("names.sdf", &format!("{filler}{shapes}"), &[], &Marcher);
    let took = start.elapsed();
    assert!(result.is_ok());
    assert!(took < PATIENCE, "{took:?}");
}

#[test]
fn numbers_without_end() {
    refuses("show sphere(1e999)", &["too large"]);
    refuses(
        &format!("show sphere({})", "9".repeat(1_000)),
        &["too large"],
    );
    refuses(
        &format!("show sphere(1e{})", "9".repeat(100_000)),
        &["too large"],
    );
    refuses("show sphere(1e308 * 10)", &["finite"]);
    refuses("show sphere(0 / 0)", &["finite"]);
}

#[test]
fn names_without_end() {
    let name = "a".repeat(500_000);
    refuses(&format!("show {name}"), &["unknown name"]);
    refuses(&format!("{name} {name}"), &["unknown statement"]);
    refuses(&format!("show sphere({name}: 1)"), &["no argument"]);
    refuses(&format!("show sphere(1).{name}"), &["has no"]);
    refuses(&format!("show {}", "?".repeat(1_000_000)), &["expected"]);
    let many: String = (0..50_000).map(|i| format!("show unknown{i}\n")).collect();
    refuses(&many, &["unknown name", "more"]);
    let many: String = (0..50_000)
        .map(|i| format!("let a{i} = {i} {i}\n"))
        .collect();
    refuses(&many, &["expected", "more"]);
    let lets: String = (0..20_000).map(|i| format!("let a{i} = {i}\n")).collect();
    refuses(
        &format!("fn f() {{ {lets} return nothing }}"),
        &["unknown name"],
    );
}

#[test]
fn large_statements_and_scripts() {
    let list = format!("let a = [{}]", "1, ".repeat(600_000));
    refuses(&list, &["MAX_STATEMENT_BYTES"]);
    let folder = Folder::new("large");
    let big = folder.write("big.sdf", "// 100 MB\n".repeat(10_000_000));
    let text = refused_file(&big);
    assert!(
        text.contains("MAX_SCRIPT_BYTES") && text.contains("100000000"),
        "{text}"
    );
    let script = folder.write("imports.sdf", "import \"big.sdf\" as big\n");
    assert!(refused_file(&script).contains("MAX_SCRIPT_BYTES"));
}

#[test]
fn a_script_within_the_limits_loads_in_time() {
    let start = Clock::start();
    let line = "let _a = 1 + 2 * (3 - 4) + abs(-5) # ".replace('#', "+ 6");
    let script: String = (0..MAX_SCRIPT_BYTES / 60)
        .map(|i| line.replace("_a", &format!("_a{i}")) + "\n")
        .collect();
    let result = lang::load_text("long.sdf", &script, &[], &Marcher);
    let took = start.elapsed();
    assert!(result.is_ok());
    assert!(took < PATIENCE, "{took:?}");
}

#[test]
fn bytes_that_are_no_text() {
    let folder = Folder::new("bytes");
    let text = refused_file(&folder.write("latin.sdf", b"show sphere(1) // caf\xe9\n"));
    assert!(
        text.contains("not UTF-8") && text.contains(":1:22"),
        "{text}"
    );
    let text = refused_file(&folder.write("nul.sdf", b"show sphere(1)\nshow\0 box(1)"));
    assert!(text.contains("NUL") && text.contains(":2:5"), "{text}");
    let text = refused_file(&folder.write("noise.sdf", vec![0xff; 1 << 20]));
    assert!(text.contains("not UTF-8"), "{text}");
    for byte in 1..=255u8 {
        let path = folder.write("byte.sdf", [b's', b'h', byte, b'(', byte]);
        refused_file(&path);
    }
}

#[test]
fn imports_in_circles() {
    let folder = Folder::new("cycle");
    let a = folder.write("a.sdf", "import \"b.sdf\" as b\n");
    folder.write("b.sdf", "import \"c.sdf\" as c\n");
    folder.write("c.sdf", "import \"a.sdf\" as a\n");
    let text = refused_file(&a);
    assert!(text.contains("cycle"), "{text}");
    for name in ["a.sdf -> ", "b.sdf -> ", "c.sdf -> "] {
        assert!(text.contains(name), "{text}");
    }
    let own = folder.write("own.sdf", "import \"own.sdf\" as me\n");
    assert!(refused_file(&own).contains("cycle"));
}

#[test]
fn imports_in_a_long_row() {
    let folder = Folder::new("row");
    for i in 0..1000 {
        folder.write(
            &format!("m{i}.sdf"),
            format!("import \"m{}.sdf\" as next\n", i + 1),
        );
    }
    folder.write("m1000.sdf", "let a = 1");
    assert!(refused_file(&folder.0.join("m0.sdf")).contains("MAX_IMPORT_DEPTH"));
}

#[test]
fn files_that_are_no_files() {
    assert!(matches!(
        lang::load(Path::new("/"), &[], &Marcher),
        Err(LoadError::Io { .. })
    ));
    let folder = Folder::new("nofile");
    let script = folder.write(
        "a.sdf",
        "import \"/\" as root\nimport \"none.sdf\" as none\n",
    );
    let text = refused_file(&script);
    assert!(
        text.contains("cannot read `/`") && text.contains("there is no such file"),
        "{text}"
    );
    if Path::new("/dev/zero").exists() {
        let script = folder.write("zero.sdf", "import \"/dev/zero\" as zero\n");
        assert!(refused_file(&script).contains("MAX_SCRIPT_BYTES"));
    }
}

#[test]
fn every_prefix_and_every_cut_of_a_script_is_answered() {
    let script = "param n = 3 in 1..=9 \"n\"\nfn f(x, y = 2) { let z = x * y return if z > 3 { [z, 1] } else { [1, 2] } }\n\
        field g(p) { sin(p.x) + p[1]^2 }\nmaterial m { color: #abc, reflect: 0.1 }\n\
        show for i in 0..n if i % 2 == 0 { sphere(1 + i).translate([f(i).x, 0, 0]).paint(m) } /* c /* d */ */\n\
        test \"t\" { expect trace([0, 0, 9], [0, 0, -1]).hit and not false }";
    let load = |text: &str| {
        let _ =
            lang::load_text("cut.sdf", text, &[], &Marcher).map_err(|report| report.to_string());
    };
    for (i, c) in script.char_indices() {
        load(&script[..i]);
        let without = format!("{}{}", &script[..i], &script[i + c.len_utf8()..]);
        load(&without);
        let twice = format!("{}{c}{}", &script[..i], &script[i..]);
        load(&twice);
    }
}

#[test]
fn ten_thousand_shapes_load_at_once() {
    let script = "show for i in 0..10000 { sphere(0.1).translate([i, 0, 0]) }";
    let start = Clock::start();
    let loaded = lang::load_text("many.sdf", script, &[], &Marcher);
    let took = start.elapsed();
    assert_eq!(loaded.map(|l| l.scene.shown.len()).ok(), Some(10_000));
    assert!(took < PATIENCE / 4, "{took:?}");
}
