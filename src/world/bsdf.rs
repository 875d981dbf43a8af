//! (bsdf)
