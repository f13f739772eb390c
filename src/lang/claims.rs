//! Lipschitz constants that a script claims, put to the test where the field is used.

use super::ast::{GlobalId, StatementKind};
use super::machine::Machine;
use super::report::Diagnostic;
use super::value::{Value, number};
use crate::catalogue::{Bounds, Modifier, with_modifier};
use crate::scene::{FieldShape, Node, Shape, refute};
use std::collections::HashMap;
use std::sync::Arc;

/// How many different regions one field is tested on.
const MOST_REGIONS: usize = 16;

/// The regions on which each claiming field is evaluated, by the name of the field.
type Regions = HashMap<*const FieldShape, (Arc<FieldShape>, Vec<Bounds>)>;

impl Machine<'_> {
    /// Reports every claim that a point refutes: over the bounds of what shows the field, or, where nothing shows it,
    /// within ten units of the origin.
    pub fn check_claims(&mut self) {
        let mut regions = Regions::new();
        for node in &self.shown {
            collect(node, node.bounds(), &mut regions);
        }
        let mut refuted = HashMap::new();
        for (field, regions) in regions.values() {
            for region in regions {
                self.test_claim(field, *region, &mut refuted);
            }
        }
        let shown: Vec<String> = regions
            .values()
            .map(|(field, _)| field.name.clone())
            .collect();
        for node in self.fields.values().flatten() {
            if let Shape::Field(field) = node.shape()
                && !shown.contains(&field.name)
            {
                self.test_claim(field, Bounds::EVERYWHERE, &mut refuted);
            }
        }
        for (name, (point, slope, claimed)) in refuted {
            self.report_refuted(&name, point, slope, claimed);
        }
    }

    fn test_claim(
        &self,
        field: &FieldShape,
        region: Bounds,
        refuted: &mut HashMap<String, ([f64; 3], f64, f64)>,
    ) {
        let Some(claimed) = field.claimed else {
            return;
        };
        if let Some(found) = refute(&field.graph, claimed, region) {
            let steepest =
                refuted
                    .entry(field.name.clone())
                    .or_insert((found.point, found.slope, claimed));
            if found.slope > steepest.1 {
                *steepest = (found.point, found.slope, claimed);
            }
        }
    }

    fn report_refuted(&mut self, name: &str, point: [f64; 3], slope: f64, claimed: f64) {
        let Some(span) = self.claim_span(name) else {
            return;
        };
        let message = format!("the claimed Lipschitz constant of `{name}` is refuted");
        let error = Diagnostic::error(span, message)
            .label(format!(
                "claimed {}, but the slope is {} at {}",
                number(&claimed),
                number(&slope),
                Value::Vector3(point)
            ))
            .help(format!(
                "claim at least {}, or leave `lipschitz` out to have it derived",
                number(&slope)
            ));
        self.diagnostics.push(error);
    }

    /// Where the field of this name makes its claim.
    fn claim_span(&self, name: &str) -> Option<super::source::Span> {
        let modules = self.program.modules.iter().enumerate();
        modules
            .flat_map(|(module, m)| {
                (0..m.globals.len()).map(move |index| GlobalId {
                    module: module as u32,
                    index: index as u32,
                })
            })
            .find_map(|id| match &self.statement(id).kind {
                StatementKind::Routine(routine) if &*routine.name.text == name => {
                    routine.claim.as_ref().map(|claim| claim.span)
                }
                _ => None,
            })
    }
}

/// Notes the regions on which fields below `node` are evaluated for points of `region`.
fn collect(node: &Node, region: Bounds, regions: &mut Regions) {
    match node.shape() {
        Shape::Primitive(_) => {}
        Shape::Field(field) => {
            if field.claimed.is_some() {
                let (_, known) = regions
                    .entry(Arc::as_ptr(field))
                    .or_insert_with(|| (field.clone(), Vec::new()));
                if known.len() < MOST_REGIONS && !known.contains(&region) {
                    known.push(region);
                }
            }
        }
        Shape::Combination(_, children) => {
            for child in children {
                collect(child, region, regions);
            }
        }
        Shape::Modifier(modifier, child) => {
            let inner = with_modifier!(modifier, m => m.domain(region));
            collect(child, inner, regions);
        }
    }
}
