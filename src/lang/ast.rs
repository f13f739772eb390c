//! The tree of a parsed script. Chains of operators are flat lists, so that no chain, however long, nests.

use super::builtin::Builtin;
use super::source::{Span, Word};
use std::sync::Arc;

/// An expression with its place.
#[derive(Clone, Debug)]
pub(super) struct Expression {
    pub span: Span,
    pub kind: Kind,
}

#[derive(Clone, Debug)]
pub(super) enum Kind {
    Literal(Literal),
    Name(Word, Binding),
    List(Vec<Expression>),
    /// Operators of one level, evaluated from left to right.
    Chain(Box<Chain>),
    /// All or any of several conditions.
    Logic(Connective, Vec<Expression>),
    Compare(Box<Compare>),
    Power(Box<(Expression, Expression)>),
    Negate(Box<Expression>),
    Not(Box<Expression>),
    Range(Box<RangeExpression>),
    If(Box<If>),
    For(Box<For>),
    Postfix(Box<Postfix>),
}

#[derive(Clone, Debug)]
pub(super) enum Literal {
    Number(f64),
    /// In radians.
    Angle(f64),
    Bool(bool),
    Text(Arc<str>),
    /// Linear RGB.
    Color([f64; 3]),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Connective {
    And,
    Or,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Operator {
    Unite,
    Intersect,
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
}

impl Operator {
    /// The operator as it is written.
    pub fn mark(self) -> &'static str {
        match self {
            Self::Unite => "|",
            Self::Intersect => "&",
            Self::Add => "+",
            Self::Subtract => "-",
            Self::Multiply => "*",
            Self::Divide => "/",
            Self::Remainder => "%",
        }
    }

    /// Operators of the same level form one chain.
    pub fn level(self) -> u8 {
        match self {
            Self::Unite => 0,
            Self::Intersect => 1,
            Self::Add | Self::Subtract => 2,
            Self::Multiply | Self::Divide | Self::Remainder => 3,
        }
    }
}

#[derive(Clone, Debug)]
pub(super) struct Chain {
    pub first: Expression,
    pub rest: Vec<(Operator, Span, Expression)>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Comparison {
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
}

impl Comparison {
    /// The comparison as it is written.
    pub fn mark(self) -> &'static str {
        match self {
            Self::Less => "<",
            Self::LessEqual => "<=",
            Self::Greater => ">",
            Self::GreaterEqual => ">=",
            Self::Equal => "==",
            Self::NotEqual => "!=",
        }
    }
}

#[derive(Clone, Debug)]
pub(super) struct Compare {
    pub left: Expression,
    pub comparison: Comparison,
    pub right: Expression,
}

#[derive(Clone, Debug)]
pub(super) struct RangeExpression {
    pub low: Expression,
    pub high: Expression,
    pub is_inclusive: bool,
    pub step: Option<Expression>,
}

#[derive(Clone, Debug)]
pub(super) struct If {
    pub arms: Vec<(Expression, Block)>,
    pub otherwise: Block,
}

#[derive(Clone, Debug)]
pub(super) struct For {
    pub variable: Word,
    pub items: Expression,
    pub filter: Option<Expression>,
    pub body: Block,
}

#[derive(Clone, Debug)]
pub(super) struct Postfix {
    pub base: Expression,
    pub steps: Vec<Step>,
}

/// What follows an operand.
#[derive(Clone, Debug)]
pub(super) enum Step {
    Call(Arguments),
    Index(Expression),
    Member(Word),
    Method(Word, Binding, Arguments),
}

#[derive(Clone, Debug)]
pub(super) struct Arguments {
    pub items: Vec<ArgumentExpression>,
    pub span: Span,
}

#[derive(Clone, Debug)]
pub(super) struct ArgumentExpression {
    pub label: Option<Word>,
    pub value: Expression,
}

/// Names for values, then the value of the whole.
#[derive(Clone, Debug)]
pub(super) struct Block {
    pub locals: Vec<(Word, Expression)>,
    pub value: Expression,
}

/// What a name stands for; settled once, before evaluation.
#[derive(Clone, Copy, Debug)]
pub(super) enum Binding {
    /// Not settled yet, or unknown and reported.
    Unknown,
    /// The local of this number in the open call.
    Local(u32),
    /// A global of a module.
    Global(GlobalId),
    Builtin(Builtin),
}

/// A global by module and number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct GlobalId {
    pub module: u32,
    pub index: u32,
}

#[derive(Clone, Debug)]
pub(super) struct Statement {
    pub span: Span,
    pub kind: StatementKind,
}

#[derive(Clone, Debug)]
pub(super) enum StatementKind {
    /// Could not be read, and was reported; names what it was about to define.
    Broken(Option<Word>),
    Import(Import),
    Parameter(Parameter),
    Let(Word, Expression),
    Routine(Routine),
    Material(Word, Vec<Entry>),
    Show(Expression),
    Settings(Word, Vec<Entry>),
    Test(TestBlock),
}

#[derive(Clone, Debug)]
pub(super) struct Import {
    pub path: Word,
    pub name: Word,
    /// The number of the imported module; none if it could not be read.
    pub module: Option<u32>,
}

#[derive(Clone, Debug)]
pub(super) struct Parameter {
    pub name: Word,
    pub default: Expression,
    pub range: Option<Expression>,
}

/// A function, field or pattern.
#[derive(Clone, Debug)]
pub(super) struct Routine {
    pub kind: RoutineKind,
    pub name: Word,
    pub formals: Vec<Formal>,
    pub claim: Option<Expression>,
    pub body: Block,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RoutineKind {
    Function,
    Field,
    Pattern,
}

impl RoutineKind {
    pub fn noun(self) -> &'static str {
        match self {
            Self::Function => "function",
            Self::Field => "field",
            Self::Pattern => "pattern",
        }
    }
}

#[derive(Clone, Debug)]
pub(super) struct Formal {
    pub name: Word,
    pub default: Option<Expression>,
}

#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub name: Word,
    pub value: Expression,
}

#[derive(Clone, Debug)]
pub(super) struct TestBlock {
    pub name: Word,
    pub steps: Vec<TestStep>,
}

#[derive(Clone, Debug)]
pub(super) enum TestStep {
    Let(Word, Expression),
    Expect(Expression),
}
