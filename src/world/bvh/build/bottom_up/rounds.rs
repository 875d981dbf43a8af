//! Rounds of joining: each cluster of a row finds the one near it that makes the smallest box with it, and those that find each other are
//! joined, until one is left.

use super::super::boxes::Box32;
use super::cut::Costs;
use super::{Binary, Inner};
use rayon::prelude::*;

/// How far along the row a partner is sought.
const REACH: usize = 8;
/// Clusters that one thread takes at a time.
const CHUNK: usize = 1 << 12;
/// A round that joins fewer than one of so many clusters to another joins neighbours instead.
const FEW: usize = 8;

/// What is still to be joined, in order.
#[derive(Default)]
struct Row {
    bounds: Vec<Box32>,
    ids: Vec<u32>,
    /// None of the first row, which is of items.
    costs: Vec<Costs>,
}

impl Row {
    fn costs(&self, place: usize) -> Costs {
        self.costs.get(place).copied().unwrap_or_else(|| Costs::of_item(self.bounds[place].area()))
    }
}

/// The binary tree over a row of two items or more.
pub(super) fn join(bounds: Vec<Box32>) -> Binary {
    let n = bounds.len();
    let mut inner = vec![Inner::default(); n - 1];
    let first = Row { bounds, ids: (0..n as u32).collect(), costs: Vec::new() };
    // Rows follow one another in the same memory: to ask for more takes as long as a round.
    let (mut row, mut after, mut partners) = (Row::default(), Row::default(), Vec::new());
    let mut made = round(&first, &mut row, &mut partners, &mut inner, 0);
    while row.ids.len() > 1 {
        made += round(&row, &mut after, &mut partners, &mut inner, made);
        std::mem::swap(&mut row, &mut after);
    }
    Binary { bounds: first.bounds, inner }
}

/// Makes the row after another, with nodes that follow the `made` ones of before; gives how many.
fn round(row: &Row, after: &mut Row, partners: &mut Vec<u32>, inner: &mut [Inner], made: usize) -> usize {
    find_partners(&row.bounds, partners);
    let mut counts = count(partners);
    if joined(&counts) * FEW < row.ids.len() {
        take_neighbours(partners);
        counts = count(partners);
    }
    next(row, after, partners, &counts, inner, made);
    joined(&counts)
}

/// For each cluster the one within [`REACH`] that makes the smallest box with it; of equals that whose place differs in the lowest bits.
/// Some two always find each other: those with the smallest box of all.
fn find_partners(bounds: &[Box32], partners: &mut Vec<u32>) {
    partners.resize(bounds.len(), 0);
    partners
        .par_chunks_mut(CHUNK)
        .enumerate()
        .for_each(|(chunk, own)| partners_of(bounds, chunk * CHUNK, own));
}

fn partners_of(bounds: &[Box32], first: usize, partners: &mut [u32]) {
    let (from, end) = (first.saturating_sub(REACH), first + partners.len());
    let until = (end + REACH).min(bounds.len());
    // The area's bits, which grow with it, then those in which the places differ.
    let mut best = vec![u64::MAX; until - from];
    for i in from..end {
        let last = (i + 1 + REACH).min(until);
        let (own, after) = best[i - from..last - from].split_first_mut().expect("a cluster");
        for (j, (other, best)) in (i + 1..).zip(bounds[i + 1..last].iter().zip(after)) {
            let area = bounds[i].with(other).area();
            let key = u64::from(area.to_bits()) << 32 | (i ^ j) as u64;
            *own = key.min(*own);
            *best = key.min(*best);
        }
    }
    for (i, partner) in partners.iter_mut().enumerate() {
        *partner = (first + i) as u32 ^ best[first + i - from] as u32;
    }
}

/// Places 0 and 1, 2 and 3, …; a last one alone is its own.
fn take_neighbours(partners: &mut [u32]) {
    let n = partners.len() as u32;
    partners.iter_mut().zip(0..).for_each(|(partner, i)| *partner = if i ^ 1 < n { i ^ 1 } else { i });
}

/// What becomes of a cluster.
enum Fate {
    Stays,
    /// Is joined with one that stands after it.
    Joins(usize),
    /// Has been joined with one before it.
    Goes,
}

fn fate(partners: &[u32], i: usize) -> Fate {
    let partner = partners[i] as usize;
    if partner == i || partners[partner] as usize != i {
        Fate::Stays
    } else if partner > i {
        Fate::Joins(partner)
    } else {
        Fate::Goes
    }
}

/// Of each chunk: how many clusters are left, and how many of those are joined.
fn count(partners: &[u32]) -> Vec<[usize; 2]> {
    let of_chunk = |chunk: usize| {
        let end = (chunk + CHUNK).min(partners.len());
        (chunk..end).fold([0, 0], |[left, joined], i| match fate(partners, i) {
            Fate::Stays => [left + 1, joined],
            Fate::Joins(_) => [left + 1, joined + 1],
            Fate::Goes => [left, joined],
        })
    };
    let chunks: Vec<usize> = (0..partners.len()).step_by(CHUNK).collect();
    chunks.into_par_iter().map(of_chunk).collect()
}

fn joined(counts: &[[usize; 2]]) -> usize {
    counts.iter().map(|[_, joined]| joined).sum()
}

/// Makes the row after a round, and its nodes.
fn next(
    row: &Row,
    after: &mut Row,
    partners: &[u32],
    counts: &[[usize; 2]],
    inner: &mut [Inner],
    made: usize,
) {
    let n_items = inner.len() as u32 + 1;
    let left = counts.iter().map(|[left, _]| left).sum();
    after.bounds.resize(left, Box32::EMPTY);
    after.ids.resize(left, 0);
    after.costs.resize(left, Costs::NONE);
    let (done, mut fresh) = inner.split_at_mut(made);
    let (mut bounds, mut ids, mut costs) = (&mut after.bounds[..], &mut after.ids[..], &mut after.costs[..]);
    let mut id = n_items + made as u32;
    let mut chunks = Vec::with_capacity(counts.len());
    for (chunk, &[left, joined]) in counts.iter().enumerate() {
        const COUNTED: &str = "as many as were counted";
        let bounds = bounds.split_off_mut(..left).expect(COUNTED);
        let ids = ids.split_off_mut(..left).expect(COUNTED);
        let costs = costs.split_off_mut(..left).expect(COUNTED);
        let fresh = fresh.split_off_mut(..joined).expect(COUNTED);
        chunks.push((chunk * CHUNK, id, (bounds, ids, costs), fresh));
        id += joined as u32;
    }
    let size = |id: u32| if id < n_items { 1 } else { done[(id - n_items) as usize].n_items };
    chunks.into_par_iter().for_each(|(first, mut id, (bounds, ids, costs), fresh)| {
        let (mut at, mut n_fresh) = (0, 0);
        for i in first..(first + CHUNK).min(partners.len()) {
            match fate(partners, i) {
                Fate::Goes => continue,
                Fate::Stays => (bounds[at], ids[at], costs[at]) = (row.bounds[i], row.ids[i], row.costs(i)),
                Fate::Joins(j) => {
                    let both = row.bounds[i].with(&row.bounds[j]);
                    let halves = [row.ids[i], row.ids[j]];
                    let n_items = size(halves[0]) + size(halves[1]);
                    let (cost, ways) =
                        Costs::of_two(&row.costs(i), &row.costs(j), both.area(), n_items as usize);
                    (bounds[at], ids[at], costs[at]) = (both, id, cost);
                    fresh[n_fresh] = Inner { halves, n_items, ways };
                    (id, n_fresh) = (id + 1, n_fresh + 1);
                }
            }
            at += 1;
        }
    });
}
