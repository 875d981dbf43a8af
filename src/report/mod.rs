//! Speed against error: every variant of a kernel measured the same way, as JSON lines, and those lines as a page with plots.
//!
//! Two steps that share only the rows: measuring ([`mod@measure`]) writes [`row::Row`]s; [`page`] renders them, so that a
//! reader can plot again without measuring again. Topological errors (missed, spurious, wrong first) are counts of their
//! own and never averaged into magnitudes.
//!
//! Tracers are measured on scenes instead ([`tracers`]), and trees on meshes ([`accelerators`]).
//!
//! Case sets are seeded, so that every error comes again; what is compared with is kept here (`naive`) and not in the rooms of the
//! kernels. A [`trial::Trial`] holds the variants of one component on one case set.

pub mod accelerators;
pub mod components;
pub mod measure;
mod naive;
pub mod page;
pub mod plot;
pub mod row;
pub mod store;
pub mod tracers;
pub mod trial;

use row::Row;
use trial::{Only, Plan};

/// Measures the components whose names are in `only`, or all of them where it is empty; tells each name before it begins.
pub fn measure(plan: &Plan, only: &[String], mut tell: impl FnMut(&str)) -> Vec<Row> {
    let asked = |name: &str| only.is_empty() || only.iter().any(|wanted| wanted == name);
    let chosen = components::COMPONENTS.iter().filter(|(name, _)| asked(name));
    let mut all: Vec<Row> = chosen
        .flat_map(|(name, rows)| {
            tell(name);
            rows(plan)
        })
        .collect();
    all.iter_mut().enumerate().for_each(|(order, row)| row.order = order);
    all
}

/// One variant's row for one input. None where there is no such variant, or the input has not as many numbers as it takes.
pub fn reproduce(only: Only) -> Option<Row> {
    measure(&Plan::only(only), &[], |_| ()).pop().filter(|row| row.n == 1)
}
