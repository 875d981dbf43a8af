//! What the kernels are compared with: the formulas of textbooks, as a renderer of average care would have them. They are here to
//! be measured and nowhere else used.

pub mod curves;
pub mod implicits;
pub mod lengths;
pub mod patches;
pub mod reach;
pub mod roots;
pub mod shapes;
pub mod skins;
