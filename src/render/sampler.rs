//! (sampler)
/// The random numbers of one camera sample.
pub struct Sampler {}
