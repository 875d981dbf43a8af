//! (bvh)
