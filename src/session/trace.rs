//! What `trace` of the language asks: the true surfaces of objects, met by rays while a scene is evaluated.

use crate::diag::{Code, Diagnostic, Severity, Span};
use crate::lang::limits::{Limits, exceeded};
use crate::lang::table::{Trace, Traced};
use crate::scene::assets::{AssetCache, Loader};
use crate::scene::{Node, Object};
use crate::world::{Hit, Kept, World};
use glam::DVec3;
use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;
use std::sync::Arc;

/// No more objects than this are kept ready: a loop may trace a new one in each turn.
const MOST_KEPT: usize = 64;

/// What a hit takes on its way from the world into a list.
const BYTES_A_HIT: u64 = 1 << 10;

/// Objects made ready for rays, each once.
pub(super) struct Tracer<'a> {
    assets: AssetCache<'a>,
    limits: Limits,
    kept: RefCell<Kept>,
    /// By address; the object is kept so that no other takes its place.
    ready: RefCell<HashMap<*const Object, (Arc<Object>, Ready)>>,
}

/// An object's world, or what is wrong with it.
type Ready = Rc<Result<World, Vec<Diagnostic>>>;

impl<'a> Tracer<'a> {
    pub fn new(loader: &'a dyn Loader, limits: Limits) -> Self {
        Tracer {
            assets: AssetCache::new(loader),
            limits,
            kept: RefCell::default(),
            ready: RefCell::default(),
        }
    }

    /// Most hits of one ray, by the guards of lists and of memory.
    fn most_hits(&self) -> usize {
        self.limits.list.min(usize::try_from(self.limits.memory / BYTES_A_HIT).unwrap_or(usize::MAX))
    }

    fn too_many(&self, at: Span) -> Diagnostic {
        let most = self.most_hits();
        let message = format!("this ray meets the object more than {most} times");
        match most < self.limits.list {
            true => exceeded(Code::MemoryLimit, at, message, "memory", self.limits.memory),
            false => exceeded(Code::ListLimit, at, message, "list", most as u64),
        }
    }

    fn ready(&self, object: &Arc<Object>) -> Ready {
        let mut ready = self.ready.borrow_mut();
        if let Some((_, known)) = ready.get(&Arc::as_ptr(object)) {
            return Rc::clone(known);
        }
        let nodes = vec![Node::Object(Arc::clone(object))];
        let (world, found) = World::of_shapes(nodes, &self.assets, &mut self.kept.borrow_mut());
        let errors: Vec<Diagnostic> = found.into_iter().filter(|d| d.severity == Severity::Error).collect();
        let made = Rc::new(if errors.is_empty() { Ok(world) } else { Err(errors) });
        if ready.len() >= MOST_KEPT {
            ready.clear();
        }
        ready.insert(Arc::as_ptr(object), (Arc::clone(object), Rc::clone(&made)));
        made
    }
}

impl Trace for Tracer<'_> {
    fn trace(
        &self,
        object: &Arc<Object>,
        origin: DVec3,
        direction: DVec3,
        at: Span,
    ) -> Result<Vec<Traced>, Vec<Diagnostic>> {
        match &*self.ready(object) {
            Ok(world) => {
                let hits = world.every_hit(origin, direction, self.most_hits());
                hits.ok_or_else(|| vec![self.too_many(at)])?.iter().map(|hit| traced(hit, at)).collect()
            }
            Err(faults) => Err(faults.iter().map(|fault| fault.clone().also(at, "traced here")).collect()),
        }
    }
}

fn traced(hit: &Hit<'_>, at: Span) -> Result<Traced, Vec<Diagnostic>> {
    if let Some(fault) = hit.fault {
        let p = hit.point;
        let message = format!("{} on the way of this ray, at <{}, {}, {}>", fault.kind.text(), p.x, p.y, p.z);
        let said = Diagnostic::new(Code::Undefined, at, message).also(fault.span, "of this function");
        return Err(vec![said]);
    }
    Ok(Traced { t: hit.t, point: hit.point, normal: hit.normal, uv: hit.uv() })
}
