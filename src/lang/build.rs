//! From pest's pairs to the tree: literals are read, precedence is settled, chains are flattened.

use super::ast::*;
use super::limits::MAX_NESTING;
use super::report::Diagnostic;
use super::source::{Span, Word};
use super::syntax::Rule;
use pest::iterators::{Pair, Pairs};
use pest::pratt_parser::{Assoc, Op, PrattParser};
use std::cell::RefCell;
use std::sync::LazyLock;

/// From the loosest to the tightest.
static PRECEDENCE: LazyLock<PrattParser<Rule>> = LazyLock::new(|| {
    let left = |rule| Op::infix(rule, Assoc::Left);
    PrattParser::new()
        .op(left(Rule::or_word))
        .op(left(Rule::and_word))
        .op(Op::prefix(Rule::not_word))
        .op(left(Rule::less)
            | left(Rule::less_equal)
            | left(Rule::greater)
            | left(Rule::greater_equal)
            | left(Rule::equal)
            | left(Rule::not_equal))
        .op(left(Rule::unite))
        .op(left(Rule::intersect))
        .op(left(Rule::add) | left(Rule::subtract))
        .op(left(Rule::multiply) | left(Rule::divide) | left(Rule::remainder))
        .op(Op::prefix(Rule::negate))
        .op(Op::infix(Rule::power, Assoc::Right))
});

/// Builds the tree of one statement.
pub(super) struct Builder {
    file: u32,
    offset: u32,
    pub diagnostics: Vec<Diagnostic>,
}

/// The pairs inside a pair; the grammar says which come.
pub(super) struct Inner<'i>(std::iter::Peekable<Pairs<'i, Rule>>);

impl<'i> Inner<'i> {
    pub fn of(pair: Pair<'i, Rule>) -> Self {
        Self(pair.into_inner().peekable())
    }

    pub fn take(&mut self) -> Pair<'i, Rule> {
        self.0.next().expect("the grammar demands this part")
    }

    /// The next pair of this rule, past others.
    pub fn find(&mut self, rule: Rule) -> Pair<'i, Rule> {
        self.0
            .find(|pair| pair.as_rule() == rule)
            .expect("the grammar demands this part")
    }

    pub fn take_if(&mut self, rule: Rule) -> Option<Pair<'i, Rule>> {
        self.0.next_if(|pair| pair.as_rule() == rule)
    }

    pub fn all(self, rule: Rule) -> impl Iterator<Item = Pair<'i, Rule>> {
        self.0.filter(move |pair| pair.as_rule() == rule)
    }
}

impl Builder {
    /// A builder for pairs of the text that starts at byte `offset` of file number `file`.
    pub fn new(file: u32, offset: u32) -> Self {
        Self {
            file,
            offset,
            diagnostics: Vec::new(),
        }
    }

    pub fn span(&self, pair: &Pair<'_, Rule>) -> Span {
        let span = pair.as_span();
        // A rule that ends with an optional part also spans the blanks before it.
        let end = span.start() + span.as_str().trim_end().len();
        Span {
            file: self.file,
            start: self.offset + span.start() as u32,
            end: self.offset + end as u32,
        }
    }

    fn word(&self, pair: Pair<'_, Rule>) -> Word {
        Word {
            text: pair.as_str().into(),
            span: self.span(&pair),
        }
    }

    /// Any statement.
    pub fn statement(&mut self, pair: Pair<'_, Rule>) -> Statement {
        let span = self.span(&pair);
        let rule = pair.as_rule();
        let mut inner = Inner::of(pair);
        let kind = match rule {
            Rule::import => {
                let path = self.string_word(inner.find(Rule::string));
                let name = self.word(inner.find(Rule::name));
                StatementKind::Import(Import {
                    path,
                    name,
                    module: None,
                })
            }
            Rule::parameter => {
                let name = self.word(inner.find(Rule::name));
                let default = self.chain(inner.find(Rule::chain));
                let range = inner
                    .take_if(Rule::in_word)
                    .map(|_| self.expression(inner.find(Rule::expression)));
                StatementKind::Parameter(Parameter {
                    name,
                    default,
                    range,
                })
            }
            Rule::local => {
                let (name, value) = self.local(inner);
                StatementKind::Let(name, value)
            }
            Rule::function => self.routine(RoutineKind::Function, inner),
            Rule::field => self.routine(RoutineKind::Field, inner),
            Rule::pattern => self.routine(RoutineKind::Pattern, inner),
            Rule::material => {
                let name = self.word(inner.find(Rule::name));
                StatementKind::Material(name, self.entries(inner.find(Rule::entries)))
            }
            Rule::show => StatementKind::Show(self.expression(inner.find(Rule::expression))),
            Rule::settings => {
                let word = self.word(inner.take());
                StatementKind::Settings(word, self.entries(inner.find(Rule::entries)))
            }
            Rule::test => StatementKind::Test(self.test(inner)),
            other => unreachable!("no statement: {other:?}"),
        };
        Statement { span, kind }
    }

    fn local(&mut self, mut inner: Inner<'_>) -> (Word, Expression) {
        let name = self.word(inner.find(Rule::name));
        (name, self.expression(inner.find(Rule::expression)))
    }

    fn routine(&mut self, kind: RoutineKind, mut inner: Inner<'_>) -> StatementKind {
        let name = self.word(inner.find(Rule::name));
        let signature = Inner::of(inner.find(Rule::signature));
        let formals = signature.all(Rule::formal).map(|pair| {
            let mut inner = Inner::of(pair);
            let name = self.word(inner.take());
            let default = inner
                .take_if(Rule::equals)
                .map(|_| self.expression(inner.take()));
            Formal { name, default }
        });
        let formals = formals.collect();
        let claim = inner
            .take_if(Rule::claim)
            .map(|pair| self.chain(Inner::of(pair).find(Rule::chain)));
        let body = self.block(inner.find(Rule::block));
        StatementKind::Routine(Routine {
            kind,
            name,
            formals,
            claim,
            body,
        })
    }

    fn entries(&mut self, pair: Pair<'_, Rule>) -> Vec<Entry> {
        let entries = Inner::of(pair).all(Rule::entry).map(|pair| {
            let mut inner = Inner::of(pair);
            let name = self.word(inner.take());
            let value = self.expression(inner.find(Rule::expression));
            Entry { name, value }
        });
        entries.collect()
    }

    fn test(&mut self, mut inner: Inner<'_>) -> TestBlock {
        let name = self.string_word(inner.find(Rule::string));
        let mut steps = Vec::new();
        for pair in inner.0 {
            match pair.as_rule() {
                Rule::local => {
                    let (name, value) = self.local(Inner::of(pair));
                    steps.push(TestStep::Let(name, value));
                }
                Rule::expect => {
                    let value = Inner::of(pair).find(Rule::expression);
                    steps.push(TestStep::Expect(self.expression(value)));
                }
                _ => {}
            }
        }
        TestBlock { name, steps }
    }

    fn block(&mut self, pair: Pair<'_, Rule>) -> Block {
        let mut locals = Vec::new();
        let mut is_return = false;
        let mut value = None;
        for pair in pair.into_inner() {
            match pair.as_rule() {
                Rule::local => locals.push(self.local(Inner::of(pair))),
                Rule::return_word => is_return = true,
                Rule::expression => value = Some(self.expression(pair)),
                _ => {}
            }
        }
        let value = value.expect("a block has an expression");
        if !locals.is_empty() && !is_return {
            let error = Diagnostic::error(value.span, "a block with `let` ends with `return`");
            self.diagnostics
                .push(error.help("write `return` before this expression"));
        }
        Block { locals, value }
    }

    /// A whole expression, perhaps a range.
    pub fn expression(&mut self, pair: Pair<'_, Rule>) -> Expression {
        let span = self.span(&pair);
        let mut inner = Inner::of(pair);
        let low = self.chain(inner.take());
        let Some(mark) = inner.take_if(Rule::range_mark) else {
            return low;
        };
        let high = self.chain(inner.take());
        let step = inner
            .take_if(Rule::step_word)
            .map(|_| self.chain(inner.take()));
        let range = RangeExpression {
            low,
            high,
            is_inclusive: mark.as_str() == "..=",
            step,
        };
        Expression {
            span,
            kind: Kind::Range(Box::new(range)),
        }
    }

    /// Operands and operators, by precedence.
    fn chain(&mut self, pair: Pair<'_, Rule>) -> Expression {
        let whole = self.span(&pair);
        let inner = pair.into_inner();
        if inner.len() == 1 {
            return self.operand(inner.peek().expect("it has one part"));
        }
        if let Some(error) = self.too_nested(inner.clone()) {
            self.diagnostics.push(error);
            return Expression {
                span: whole,
                kind: Kind::Literal(Literal::Number(0.0)),
            };
        }
        let builder = RefCell::new(self);
        PRECEDENCE
            .map_primary(|pair| builder.borrow_mut().operand(pair))
            .map_prefix(|operator, operand| {
                let span = builder.borrow().span(&operator).to(operand.span);
                let operand = Box::new(operand);
                let kind = match operator.as_rule() {
                    Rule::not_word => Kind::Not(operand),
                    _ => Kind::Negate(operand),
                };
                Expression { span, kind }
            })
            .map_infix(|left, operator, right| {
                let mut builder = builder.borrow_mut();
                let span = builder.span(&operator);
                builder.infix(left, operator.as_rule(), span, right)
            })
            .parse(inner)
    }

    /// An error where a run of prefix operators or the powers of a chain would nest too deep.
    fn too_nested(&self, pairs: Pairs<'_, Rule>) -> Option<Diagnostic> {
        let (mut run, mut powers) = (0, 0);
        for pair in pairs {
            match pair.as_rule() {
                Rule::negate | Rule::not_word => run += 1,
                Rule::power => (run, powers) = (0, powers + 1),
                _ => run = 0,
            }
            if run > MAX_NESTING || powers > MAX_NESTING {
                let message = format!(
                    "operators are nested deeper than {MAX_NESTING} levels (limit MAX_NESTING)"
                );
                return Some(Diagnostic::error(self.span(&pair), message));
            }
        }
        None
    }

    fn infix(&mut self, left: Expression, rule: Rule, at: Span, right: Expression) -> Expression {
        let span = left.span.to(right.span);
        let kind = match rule {
            Rule::or_word => logic(Connective::Or, left, right),
            Rule::and_word => logic(Connective::And, left, right),
            Rule::unite => chained(Operator::Unite, left, at, right),
            Rule::intersect => chained(Operator::Intersect, left, at, right),
            Rule::add => chained(Operator::Add, left, at, right),
            Rule::subtract => chained(Operator::Subtract, left, at, right),
            Rule::multiply => chained(Operator::Multiply, left, at, right),
            Rule::divide => chained(Operator::Divide, left, at, right),
            Rule::remainder => chained(Operator::Remainder, left, at, right),
            Rule::power => Kind::Power(Box::new((left, right))),
            Rule::less => self.compare(left, Comparison::Less, at, right),
            Rule::less_equal => self.compare(left, Comparison::LessEqual, at, right),
            Rule::greater => self.compare(left, Comparison::Greater, at, right),
            Rule::greater_equal => self.compare(left, Comparison::GreaterEqual, at, right),
            Rule::equal => self.compare(left, Comparison::Equal, at, right),
            Rule::not_equal => self.compare(left, Comparison::NotEqual, at, right),
            other => unreachable!("no infix operator: {other:?}"),
        };
        Expression { span, kind }
    }

    fn compare(
        &mut self,
        left: Expression,
        comparison: Comparison,
        at: Span,
        right: Expression,
    ) -> Kind {
        // The left side of a chain may be as long as the script: it is not kept.
        if matches!(left.kind, Kind::Compare(_)) {
            let error =
                Diagnostic::error(at, "comparisons do not chain").help("write `a < b and b < c`");
            self.diagnostics.push(error);
            return right.kind;
        }
        Kind::Compare(Box::new(Compare {
            left,
            comparison,
            right,
        }))
    }

    /// A value with the calls, indices and members that follow it.
    fn operand(&mut self, pair: Pair<'_, Rule>) -> Expression {
        let span = self.span(&pair);
        let mut inner = Inner::of(pair);
        let base = self.primary(inner.take());
        if inner.0.peek().is_none() {
            return base;
        }
        let steps = inner.0.map(|pair| self.step(pair)).collect();
        Expression {
            span,
            kind: Kind::Postfix(Box::new(Postfix { base, steps })),
        }
    }

    fn step(&mut self, pair: Pair<'_, Rule>) -> Step {
        match pair.as_rule() {
            Rule::arguments => Step::Call(self.arguments(pair)),
            Rule::index => Step::Index(self.expression(Inner::of(pair).find(Rule::expression))),
            _ => {
                let mut inner = Inner::of(pair);
                let word = self.word(inner.find(Rule::word));
                match inner.take_if(Rule::arguments) {
                    Some(pair) => Step::Method(word, Binding::Unknown, self.arguments(pair)),
                    None => Step::Member(word),
                }
            }
        }
    }

    fn arguments(&mut self, pair: Pair<'_, Rule>) -> Arguments {
        let span = self.span(&pair);
        let items = Inner::of(pair).all(Rule::argument).map(|pair| {
            let mut inner = Inner::of(pair);
            let label = inner
                .take_if(Rule::label)
                .map(|pair| self.word(Inner::of(pair).take()));
            let value = self.expression(inner.take());
            ArgumentExpression { label, value }
        });
        let items = items.collect();
        Arguments { items, span }
    }

    fn primary(&mut self, pair: Pair<'_, Rule>) -> Expression {
        let span = self.span(&pair);
        let kind = match pair.as_rule() {
            Rule::bad_number => Kind::Literal(self.bad_number(&pair)),
            Rule::quantity => Kind::Literal(self.quantity(pair)),
            Rule::string => Kind::Literal(Literal::Text(self.string_word(pair).text)),
            Rule::color => Kind::Literal(self.color(&pair)),
            Rule::true_word => Kind::Literal(Literal::Bool(true)),
            Rule::false_word => Kind::Literal(Literal::Bool(false)),
            Rule::name => Kind::Name(self.word(pair), Binding::Unknown),
            Rule::group => return self.group(pair),
            Rule::list => {
                let items = Inner::of(pair).all(Rule::expression);
                Kind::List(items.map(|pair| self.expression(pair)).collect())
            }
            Rule::conditional => self.conditional(pair),
            Rule::r#loop => self.for_loop(pair),
            other => unreachable!("no operand: {other:?}"),
        };
        Expression { span, kind }
    }

    /// What stands in parentheses; the span takes them in, and a comparison in them does not chain.
    fn group(&mut self, pair: Pair<'_, Rule>) -> Expression {
        let span = self.span(&pair);
        let inner = self.expression(Inner::of(pair).find(Rule::expression));
        match inner.kind {
            Kind::Compare(_) => Expression {
                span,
                kind: Kind::Logic(Connective::And, vec![inner]),
            },
            kind => Expression { span, kind },
        }
    }

    fn conditional(&mut self, pair: Pair<'_, Rule>) -> Kind {
        let mut arms = Vec::new();
        let mut condition = None;
        let mut otherwise = None;
        for pair in pair.into_inner() {
            match pair.as_rule() {
                Rule::expression => condition = Some(self.expression(pair)),
                Rule::block => {
                    let block = self.block(pair);
                    match condition.take() {
                        Some(condition) => arms.push((condition, block)),
                        None => otherwise = Some(block),
                    }
                }
                _ => {}
            }
        }
        let otherwise = otherwise.expect("the grammar demands an else");
        Kind::If(Box::new(If { arms, otherwise }))
    }

    fn for_loop(&mut self, pair: Pair<'_, Rule>) -> Kind {
        let mut inner = Inner::of(pair);
        let variable = self.word(inner.find(Rule::name));
        let items = self.expression(inner.find(Rule::expression));
        let filter = inner
            .take_if(Rule::if_word)
            .map(|_| self.expression(inner.take()));
        let body = self.block(inner.take());
        Kind::For(Box::new(For {
            variable,
            items,
            filter,
            body,
        }))
    }
}

fn logic(connective: Connective, left: Expression, right: Expression) -> Kind {
    match left.kind {
        Kind::Logic(same, mut all) if same == connective => {
            all.push(right);
            Kind::Logic(connective, all)
        }
        _ => Kind::Logic(connective, vec![left, right]),
    }
}

fn chained(operator: Operator, left: Expression, at: Span, right: Expression) -> Kind {
    match left.kind {
        Kind::Chain(mut chain) if has_level(&chain, operator.level()) => {
            chain.rest.push((operator, at, right));
            Kind::Chain(chain)
        }
        _ => Kind::Chain(Box::new(Chain {
            first: left,
            rest: vec![(operator, at, right)],
        })),
    }
}

fn has_level(chain: &Chain, level: u8) -> bool {
    chain.rest[0].0.level() == level
}
