//! Speed against error: every variant of a kernel measured the same way, as JSON lines, and those lines as a page with plots.
//!
//! Two steps that share only the rows: measuring ([`measure`]) writes [`row::Row`]s; [`page`] renders them, so that a
//! reader can plot again without measuring again. Topological errors (missed, spurious, wrong first) are counts of their
//! own and never averaged into magnitudes. Nothing here judges.

pub mod measure;
pub mod page;
pub mod plot;
pub mod row;
