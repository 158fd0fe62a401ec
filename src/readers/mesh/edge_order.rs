//! Edges that a sweep line meets, in order from below: a list in short pieces, each of which is searched quickly.

/// Number of edges in half a full piece.
const HALF: usize = 256;

/// Number of no piece.
const NONE: u32 = u32::MAX;

/// Place in the list: the rank of the piece, and the index in it.
pub(super) type Place = (usize, usize);

/// Ordered list of edges, which are numbers.
pub(super) struct EdgeOrder {
    pieces: Vec<Vec<u32>>,
    /// Numbers of the pieces from below.
    ranks: Vec<u32>,
    /// Number of the piece of each edge.
    piece_of: Vec<u32>,
}

impl EdgeOrder {
    /// Returns an empty list for edges below `count`.
    pub fn new(count: usize) -> Self {
        Self { pieces: vec![Vec::new()], ranks: vec![0], piece_of: vec![NONE; count] }
    }

    pub fn contains(&self, edge: u32) -> bool {
        self.piece_of[edge as usize] != NONE
    }

    /// Returns the place of an edge; the first place if it is not in the list.
    pub fn place(&self, edge: u32) -> Place {
        let piece = self.piece_of[edge as usize];
        let Some(rank) = self.ranks.iter().position(|&p| p == piece) else { return (0, 0) };
        (rank, self.piece(rank).iter().position(|&e| e == edge).unwrap_or(0))
    }

    /// Returns the place behind the edges of which `is_below` is true.
    pub fn search(&self, is_below: impl Fn(u32) -> bool) -> Place {
        let starts_below = |&p: &u32| self.pieces[p as usize].first().is_some_and(|&e| is_below(e));
        let rank = self.ranks.partition_point(starts_below).saturating_sub(1);
        (rank, self.piece(rank).partition_point(|&e| is_below(e)))
    }

    /// Returns the edge at a place, which may be the end of a piece.
    pub fn at(&self, (rank, i): Place) -> Option<u32> {
        let here = self.piece(rank).get(i);
        here.or_else(|| self.pieces[*self.ranks.get(rank + 1)? as usize].first()).copied()
    }

    pub fn before(&self, (rank, i): Place) -> Option<u32> {
        if i > 0 {
            self.piece(rank).get(i - 1).copied()
        } else {
            self.piece(rank.checked_sub(1)?).last().copied()
        }
    }

    pub fn after(&self, (rank, i): Place) -> Place {
        let is_last = i + 1 >= self.piece(rank).len() && rank + 1 < self.ranks.len();
        if is_last { (rank + 1, 0) } else { (rank, i + 1) }
    }

    pub fn remove(&mut self, edge: u32) {
        let (rank, i) = self.place(edge);
        self.piece_of[edge as usize] = NONE;
        let piece = &mut self.pieces[self.ranks[rank] as usize];
        piece.remove(i);
        if piece.is_empty() && self.ranks.len() > 1 {
            self.ranks.remove(rank);
        }
    }

    /// Inserts an edge above another one, or as the lowest.
    pub fn insert(&mut self, below: Option<u32>, edge: u32) {
        let (rank, i) = below.map_or((0, 0), |below| self.place(below));
        let number = self.ranks[rank];
        let piece = &mut self.pieces[number as usize];
        piece.insert(i + usize::from(below.is_some()), edge);
        self.piece_of[edge as usize] = number;
        if piece.len() > 2 * HALF {
            let upper = piece.split_off(HALF);
            let new = self.pieces.len() as u32;
            for &edge in &upper {
                self.piece_of[edge as usize] = new;
            }
            self.pieces.push(upper);
            self.ranks.insert(rank + 1, new);
        }
    }

    fn piece(&self, rank: usize) -> &[u32] {
        &self.pieces[self.ranks[rank] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_keep_their_order() {
        let mut order = EdgeOrder::new(3_000);
        for edge in 0..3_000 {
            order.insert((edge > 0).then(|| edge - 1), edge);
        }
        for edge in (0..3_000).filter(|edge| edge % 3 != 0) {
            order.remove(edge);
        }
        let mut at = order.search(|edge| edge < 900);
        assert_eq!(order.before(at), Some(897));
        for edge in (900..3_000).step_by(3) {
            assert_eq!(order.at(at), Some(edge));
            at = order.after(at);
        }
        assert_eq!((order.at(at), order.contains(3), order.contains(4)), (None, true, false));
    }
}
