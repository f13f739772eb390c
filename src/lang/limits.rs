//! The limits that keep hostile or runaway scripts from taking the machine with them. A message that reports one names
//! it; `docs/language.md` lists them all.

/// How many bytes a script and everything that it imports may have together.
pub const MAX_SCRIPT_BYTES: usize = 2 << 20;

/// How many bytes one statement may have.
pub const MAX_STATEMENT_BYTES: usize = 1 << 19;

/// How deep brackets, block comments, and runs of prefix operators or powers may be nested.
pub const MAX_NESTING: usize = 256;

/// How many errors the parser reports before it gives up.
pub const MAX_PARSE_ERRORS: usize = 64;

/// How many errors and warnings a report shows; the others are counted.
pub const MAX_SHOWN: usize = 20;

/// How many files may import each other in a row.
pub const MAX_IMPORT_DEPTH: usize = 64;

/// How many steps the evaluation of a script may take, or of one test: expressions, list elements, nodes of shapes,
/// and the operations that deriving the constants of fields takes.
pub const MAX_STEPS: u64 = 5_000_000;

/// How many calls of the script's functions, fields and patterns may be open at once.
pub const MAX_CALL_DEPTH: usize = 1000;

/// How many expressions may be open at once, in all open calls together.
pub const MAX_OPEN_EXPRESSIONS: usize = 20_000;

/// How many elements a list or a range may have.
pub const MAX_LIST: usize = 1_000_000;

/// How deep lists and patterns may be nested.
pub const MAX_LIST_DEPTH: u32 = 64;

/// How many bytes a string may have.
pub const MAX_STRING: usize = 1 << 16;

/// How many shapes a script may make, counting each operation on a shape as one.
pub const MAX_SHAPES: u64 = 500_000;

/// How many operations the graph of one field or pattern may have.
pub const MAX_GRAPH: usize = 20_000;

/// The stack of the thread that loads a script, in bytes: [`MAX_OPEN_EXPRESSIONS`] of them fit, in debug builds too.
pub(super) const STACK_BYTES: usize = 256 << 20;
