//! Weighted least squares of a few unknowns, and which of them the equations cannot tell apart.

/// An unknown whose variance the others inflate by more than this is not told apart from them.
const MAX_INFLATION: f64 = 1_000.0;
/// Share of a column that another must make up to be named beside it.
const NAMED_SHARE: f64 = 0.1;

/// A matrix of so many rows and columns.
pub(super) type Square<const N: usize> = [[f64; N]; N];

/// The sums of the equations.
#[derive(Debug, Clone)]
pub(super) struct Normal<const N: usize> {
    products: Square<N>,
    right: [f64; N],
}

/// An unknown that is left out.
#[derive(Debug, Clone, Default)]
pub(super) struct LeftOut {
    pub(super) unknown: usize,
    /// Unknowns that largely make it up.
    pub(super) named: Vec<usize>,
    /// Each unknown that is kept, and by how much one unit of what is left out changes it.
    pub(super) moves: Vec<(usize, f64)>,
}

impl<const N: usize> Normal<N> {
    pub(super) fn new() -> Self {
        Self { products: [[0.0; N]; N], right: [0.0; N] }
    }

    /// Adds one equation.
    pub(super) fn add(&mut self, row: &[f64; N], value: f64, weight: f64) {
        for ((products, right), a) in self.products.iter_mut().zip(&mut self.right).zip(row) {
            *right += weight * a * value;
            for (product, b) in products.iter_mut().zip(row) {
                *product += weight * a * b;
            }
        }
    }

    fn product(&self, a: usize, b: usize) -> f64 {
        self.products.get(a).and_then(|row| row.get(b)).copied().unwrap_or_default()
    }

    /// Those of `wanted` that can be told apart, the first ones first, and the others.
    pub(super) fn told_apart(&self, wanted: &[usize]) -> (Vec<usize>, Vec<LeftOut>) {
        let (mut kept, mut left_out): (Vec<usize>, Vec<LeftOut>) = (Vec::new(), Vec::new());
        for unknown in wanted.iter().copied() {
            let own = self.product(unknown, unknown);
            let shares = self.solved(&kept, |other| self.product(other, unknown));
            let made: f64 =
                kept.iter().zip(&shares).map(|(k, s)| s * self.product(*k, unknown)).sum();
            if own > 0.0 && own - made > own / MAX_INFLATION {
                kept.push(unknown);
                continue;
            }
            let is_large = |(other, share): &(&usize, &f64)| {
                share.powi(2) * self.product(**other, **other) > NAMED_SHARE.powi(2) * own
            };
            let named = kept.iter().zip(&shares).filter(is_large).map(|(other, _)| *other);
            let named = if own > 0.0 { named.collect() } else { Vec::new() };
            left_out.push(LeftOut { unknown, named, moves: Vec::new() });
        }
        for out in &mut left_out {
            let shares = self.solved(&kept, |other| self.product(other, out.unknown));
            out.moves = kept.iter().copied().zip(shares).collect();
        }
        (kept, left_out)
    }

    /// The unknowns `kept`, and their covariance for a variance of one.
    pub(super) fn solve(&self, kept: &[usize]) -> ([f64; N], Square<N>) {
        let found =
            self.solved(kept, |unknown| self.right.get(unknown).copied().unwrap_or_default());
        let (mut values, mut covariance) = ([0.0; N], [[0.0; N]; N]);
        for (unknown, value) in kept.iter().zip(found) {
            if let Some(place) = values.get_mut(*unknown) {
                *place = value;
            }
            let column = self.solved(kept, |other| f64::from(u8::from(other == *unknown)));
            for (other, value) in kept.iter().zip(column) {
                let place = covariance.get_mut(*other).and_then(|row| row.get_mut(*unknown));
                if let Some(place) = place {
                    *place = value;
                }
            }
        }
        (values, covariance)
    }

    /// Solves the equations of `kept` for a right side, by Cholesky with columns of length one.
    fn solved(&self, kept: &[usize], right: impl Fn(usize) -> f64) -> Vec<f64> {
        let length = |unknown: usize| self.product(unknown, unknown).sqrt();
        let mut rows: Vec<Vec<f64>> = Vec::new();
        let mut forward: Vec<f64> = Vec::new();
        for a in kept {
            let mut row: Vec<f64> = Vec::new();
            for (b, other) in kept.iter().zip(&rows) {
                let product = self.product(*a, *b) / (length(*a) * length(*b));
                let (before, own) = (dot(&row, other), other.last().copied().unwrap_or(1.0));
                row.push((product - before) / own);
            }
            let rest = right(*a) / length(*a) - dot(&row, &forward);
            let own = (1.0 - dot(&row, &row)).max(f64::MIN_POSITIVE).sqrt();
            forward.push(rest / own);
            row.push(own);
            rows.push(row);
        }
        let mut found = forward;
        for (index, row) in rows.iter().enumerate().rev() {
            let own = row.last().copied().unwrap_or(1.0);
            let value = found.get(index).copied().unwrap_or_default() / own;
            for (before, part) in found.iter_mut().zip(row).take(index) {
                *before -= part * value;
            }
            if let Some(place) = found.get_mut(index) {
                *place = value;
            }
        }
        found.iter().zip(kept).map(|(value, unknown)| value / length(*unknown)).collect()
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
