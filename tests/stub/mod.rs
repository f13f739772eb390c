//! A tracer for tests of the language: plain sphere tracing by walking the tree.

use fieldstone::num::Vec3;
use fieldstone::scene::{Node, Settings, TraceRecord, Tracer};
use std::sync::Arc;

pub struct Marcher;

impl Tracer for Marcher {
    fn trace(
        &self,
        shown: &[Arc<Node>],
        _: &Settings,
        origin: [f64; 3],
        direction: [f64; 3],
    ) -> Result<TraceRecord, String> {
        let length = direction.iter().map(|c| c * c).sum::<f64>().sqrt();
        let direction = direction.map(|c| c / length);
        let at = |t: f64| std::array::from_fn(|i| origin[i] + t * direction[i]);
        let field = |p: [f64; 3]| {
            let p: Vec3<f64> = Vec3::splat(p);
            shown
                .iter()
                .map(|node| node.evaluate(&p) / node.lipschitz().max(1.0))
                .fold(f64::INFINITY, f64::min)
        };
        let mut record = TraceRecord {
            verdict: "miss",
            t: 0.0,
            point: [0.0; 3],
            normal: [0.0; 3],
            steps: 0,
            evaluations: 0,
        };
        while record.t < 1e3 && record.steps < 1000 {
            let distance = field(at(record.t));
            record.steps += 1;
            record.evaluations += 1;
            if distance < 1e-9 {
                record.verdict = "hit";
                record.point = at(record.t);
                record.normal = std::array::from_fn(|i| {
                    let mut beside = [record.point; 2];
                    beside[0][i] += 1e-6;
                    beside[1][i] -= 1e-6;
                    (field(beside[0]) - field(beside[1])) / 2e-6
                });
                break;
            }
            record.t += distance;
        }
        Ok(record)
    }
}
