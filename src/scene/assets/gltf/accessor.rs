//! Numbers out of buffers. Nothing of a file is trusted: every count is compared with the bytes that are there before anything is
//! allocated by it, and what all parts of a file together may hold is bounded.

use gltf::json::accessor::{Accessor, ComponentType, Type, sparse::Sparse};
use gltf::json::buffer::View;
use gltf::json::validation::Checked;
use gltf::json::{Index, Root};
use std::cell::Cell;

/// Most numbers that are read of a file, those that are read again counted again: 2 GiB of them. A small file may refer to the same bytes
/// any number of times.
const MOST_NUMBERS: u64 = 1 << 28;

/// Most elements of an accessor without bytes, all 0.
const MOST_ZEROS: u64 = 1 << 22;

/// The numbers of a file.
pub(super) struct Numbers<'a> {
    root: &'a Root,
    buffers: &'a [Vec<u8>],
    left: Cell<u64>,
}

/// Elements of equal width, one after the other.
#[derive(Debug, PartialEq)]
pub(super) struct Elements {
    /// How many numbers each has.
    pub width: usize,
    /// All of them; finite. Normalised integers are brought to −1 … 1 or 0 … 1.
    pub values: Vec<f64>,
    /// The step between two neighbouring values of a normalised integer; 0 for others.
    pub quantum: f64,
}

impl Elements {
    /// How many there are.
    pub fn count(&self) -> usize {
        self.values.len() / self.width
    }

    /// One after the other.
    pub fn each<const N: usize>(&self) -> impl Iterator<Item = [f64; N]> {
        self.values.chunks_exact(self.width).map(|e| std::array::from_fn(|k| e[k]))
    }
}

/// Bytes at equal steps.
struct Layout<'a> {
    bytes: &'a [u8],
    stride: usize,
}

impl<'a> Numbers<'a> {
    /// Of a file's JSON and its buffers.
    pub fn new(root: &'a Root, buffers: &'a [Vec<u8>]) -> Self {
        Numbers { root, buffers, left: Cell::new(MOST_NUMBERS) }
    }

    /// The numbers of an accessor of one of these types.
    pub fn elements(&self, index: Index<Accessor>, types: &[Type]) -> Result<Elements, String> {
        let number = index.value();
        self.checked(index, types).map_err(|why| format!("accessor {number} {why}"))
    }

    /// Whole numbers: indices of vertices, or numbers of joints, each element's one after the other.
    pub fn whole(&self, index: Index<Accessor>, types: &[Type]) -> Result<Vec<u32>, String> {
        let elements = self.elements(index, types)?;
        let whole =
            |x: &f64| (x.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(x)).then_some(*x as u32);
        let all: Option<Vec<u32>> = elements.values.iter().map(whole).collect();
        all.ok_or_else(|| format!("accessor {} holds what is no whole number", index.value()))
    }

    /// The bytes of a view.
    pub fn view(&self, index: Index<View>) -> Result<&'a [u8], String> {
        let named = |why: &str| format!("view {} of a buffer {why}", index.value());
        let view = self.root.buffer_views.get(index.value()).ok_or_else(|| named("does not exist"))?;
        let buffer = self
            .buffers
            .get(view.buffer.value())
            .ok_or_else(|| named("is of a buffer that does not exist"))?;
        let start = view.byte_offset.map_or(0, |o| o.0);
        let end = start.checked_add(view.byte_length.0).and_then(|end| usize::try_from(end).ok());
        let bytes = end.and_then(|end| buffer.get(start as usize..end));
        bytes.ok_or_else(|| named(&format!("leaves its buffer of {} bytes", buffer.len())))
    }

    fn checked(&self, index: Index<Accessor>, types: &[Type]) -> Result<Elements, String> {
        let accessor = self.root.accessors.get(index.value()).ok_or("does not exist")?;
        let (Checked::Valid(kind), Checked::Valid(component)) = (&accessor.type_, &accessor.component_type)
        else {
            return Err("is of an unknown type".into());
        };
        if !types.contains(kind) {
            return Err(format!("is of type {kind:?}, which cannot be used here"));
        }
        let (width, component) = (kind.multiplicity(), component.0);
        if *kind as u32 >= Type::Mat2 as u32 && component.size() < 4 {
            return Err("holds matrices of short integers, which are not read".into());
        }
        let count = accessor.count.0;
        self.spend(count.saturating_mul(width as u64))?;
        let mut values = match accessor.buffer_view {
            None if count > MOST_ZEROS => return Err(format!("has {count} elements, but no bytes for them")),
            None => vec![0.0; count as usize * width],
            Some(view) => {
                let stride =
                    self.root.buffer_views.get(view.value()).and_then(|v| v.byte_stride).map(|s| s.0);
                let offset = accessor.byte_offset.map_or(0, |o| o.0);
                let layout = self.layout(view, offset, count, stride, width * component.size())?;
                let mut values = Vec::with_capacity(count as usize * width);
                layout.read(count as usize, width, component, accessor.normalized, &mut values);
                values
            }
        };
        if let Some(sparse) = &accessor.sparse {
            self.replace(accessor, sparse, width, component, &mut values)?;
        }
        match values.iter().position(|x| !x.is_finite()) {
            Some(at) => Err(format!("holds {} in element {}", values[at], at / width)),
            None => Ok(Elements {
                width,
                values,
                quantum: if accessor.normalized { quantum(component) } else { 0.0 },
            }),
        }
    }

    fn spend(&self, numbers: u64) -> Result<(), String> {
        let left = self.left.get().checked_sub(numbers);
        self.left.set(left.ok_or("is one too many: the parts of the file hold more than 2^28 numbers")?);
        Ok(())
    }

    /// The bytes of `count` elements, none of them outside the view.
    fn layout(
        &self,
        view: Index<View>,
        offset: u64,
        count: u64,
        stride: Option<usize>,
        size: usize,
    ) -> Result<Layout<'a>, String> {
        let stride = stride.unwrap_or(size);
        if stride < size {
            return Err(format!("has elements of {size} bytes at steps of {stride}"));
        }
        let all = self.view(view)?;
        let needed = match count {
            0 => Some(0),
            n => (n - 1).checked_mul(stride as u64).and_then(|x| x.checked_add(size as u64)),
        };
        let end = needed.and_then(|n| n.checked_add(offset)).and_then(|end| usize::try_from(end).ok());
        let bytes = end.and_then(|end| all.get(offset as usize..end));
        let bytes =
            bytes.ok_or_else(|| format!("has {count} elements, but only {} bytes are there", all.len()))?;
        Ok(Layout { bytes, stride })
    }

    /// Puts in the elements that a sparse accessor gives apart.
    fn replace(
        &self,
        accessor: &Accessor,
        sparse: &Sparse,
        width: usize,
        component: ComponentType,
        values: &mut [f64],
    ) -> Result<(), String> {
        let Checked::Valid(index_type) = &sparse.indices.component_type else {
            return Err("has sparse indices of an unknown type".into());
        };
        let count = sparse.count.0;
        self.spend(count.saturating_mul(width as u64 + 1))?;
        let (at, new) = (&sparse.indices, &sparse.values);
        let indices = self.layout(at.buffer_view, at.byte_offset.0, count, None, index_type.0.size())?;
        let elements =
            self.layout(new.buffer_view, new.byte_offset.0, count, None, width * component.size())?;
        let (mut places, mut given) = (Vec::new(), Vec::new());
        indices.read(count as usize, 1, index_type.0, false, &mut places);
        elements.read(count as usize, width, component, accessor.normalized, &mut given);
        for (place, element) in places.iter().zip(given.chunks_exact(width)) {
            let start = *place as usize * width;
            let slot = values.get_mut(start..start + width);
            slot.ok_or_else(|| format!("has no element {place} to replace"))?.copy_from_slice(element);
        }
        Ok(())
    }
}

impl Layout<'_> {
    fn read(
        &self,
        count: usize,
        width: usize,
        component: ComponentType,
        normalised: bool,
        into: &mut Vec<f64>,
    ) {
        for element in 0..count {
            let start = element * self.stride;
            let bytes = &self.bytes[start..start + width * component.size()];
            into.extend(bytes.chunks_exact(component.size()).map(|bytes| {
                let x = number(bytes, component);
                if normalised && component != ComponentType::F32 {
                    (x * quantum(component)).max(-1.0)
                } else {
                    x
                }
            }));
        }
    }
}

/// One over the largest value of an integer.
fn quantum(component: ComponentType) -> f64 {
    match component {
        ComponentType::I8 => 1.0 / 127.0,
        ComponentType::U8 => 1.0 / 255.0,
        ComponentType::I16 => 1.0 / 32767.0,
        ComponentType::U16 => 1.0 / 65535.0,
        ComponentType::U32 => 1.0 / 4_294_967_295.0,
        ComponentType::F32 => 0.0,
    }
}

/// A number of exactly as many bytes as its type has.
fn number(bytes: &[u8], component: ComponentType) -> f64 {
    let two = || [bytes[0], bytes[1]];
    let four = || [bytes[0], bytes[1], bytes[2], bytes[3]];
    match component {
        ComponentType::I8 => f64::from(bytes[0] as i8),
        ComponentType::U8 => f64::from(bytes[0]),
        ComponentType::I16 => f64::from(i16::from_le_bytes(two())),
        ComponentType::U16 => f64::from(u16::from_le_bytes(two())),
        ComponentType::U32 => f64::from(u32::from_le_bytes(four())),
        ComponentType::F32 => f64::from(f32::from_le_bytes(four())),
    }
}
