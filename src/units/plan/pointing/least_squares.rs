//! Weighted least squares of a few unknowns, and detection of unknowns that the equations cannot
//! distinguish.

/// Max inflation of the variance of an unknown that is distinguishable from the others.
const MAX_INFLATION: f64 = 1_000.0;
/// Min share of a column that another must make up to be named beside it.
const NAMED_SHARE: f64 = 0.1;

/// Matrix of `N` rows and columns.
pub(super) type Square<const N: usize> = [[f64; N]; N];

/// Equation: coefficients of the unknowns, the coefficient of an unknown of its own group, and the
/// value. Each equation has unit variance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Equation<const N: usize> {
    pub(super) row: [f64; N],
    pub(super) own: f64,
    pub(super) value: f64,
}

/// Sums of the equations.
#[derive(Debug, Clone)]
pub(super) struct Normal<const N: usize> {
    products: Square<N>,
    right: [f64; N],
    /// Squares of the columns before the elimination of the group unknowns.
    squares: [f64; N],
    /// Square of the values.
    value: f64,
    equations: usize,
    /// Number of eliminated unknowns, and the logarithm of their determinant.
    eliminated: usize,
    log_eliminated: f64,
}

/// Omitted unknown.
#[derive(Debug, Clone, Default)]
pub(super) struct LeftOutTerm {
    pub(super) unknown: usize,
    /// Unknowns that largely make up the omitted one.
    pub(super) named: Vec<usize>,
}

/// Values of the unknowns.
#[derive(Debug, Clone)]
pub(super) struct Estimate<const N: usize> {
    pub(super) values: [f64; N],
    /// Covariance for equations of unit variance.
    pub(super) covariance: Square<N>,
    /// Variance of an equation, from the residuals.
    pub(super) variance: f64,
    /// Logarithm of the likelihood of the residuals.
    pub(super) log_likelihood: f64,
}

impl<const N: usize> Estimate<N> {
    /// Returns the covariance with the variance of an equation, in units of `unit`.
    pub(super) fn scaled_covariance(&self, unit: f64) -> Square<N> {
        self.covariance.map(|row| row.map(|value| value * self.variance / unit))
    }
}

impl<const N: usize> Normal<N> {
    pub(super) fn new() -> Self {
        Self {
            products: [[0.0; N]; N],
            right: [0.0; N],
            squares: [0.0; N],
            value: 0.0,
            equations: 0,
            eliminated: 0,
            log_eliminated: 0.0,
        }
    }

    /// Adds the equations of a group, and eliminates the group's own unknown.
    pub(super) fn add(&mut self, group: &[Equation<N>]) {
        let (mut own_row, mut own_value, mut own_square) = ([0.0; N], 0.0, 0.0);
        for Equation { row, own, value } in group {
            self.add_products(row, *value, 1.0);
            for (square, a) in self.squares.iter_mut().zip(row) {
                *square += a * a;
            }
            for (sum, a) in own_row.iter_mut().zip(row) {
                *sum += a * own;
            }
            own_value += own * value;
            own_square += own * own;
        }
        self.equations += group.len();
        if own_square > 0.0 {
            self.add_products(&own_row, own_value, -1.0 / own_square);
            self.eliminated += 1;
            self.log_eliminated += own_square.ln();
        }
    }

    fn add_products(&mut self, row: &[f64; N], value: f64, weight: f64) {
        for ((products, right), a) in self.products.iter_mut().zip(&mut self.right).zip(row) {
            *right += weight * a * value;
            for (product, b) in products.iter_mut().zip(row) {
                *product += weight * a * b;
            }
        }
        self.value += weight * value * value;
    }

    /// Returns the number of equations beyond the unknowns, with `count` common unknowns.
    pub(super) fn freedom(&self, count: usize) -> usize {
        self.equations.saturating_sub(self.eliminated + count).max(1)
    }

    fn product(&self, a: usize, b: usize) -> f64 {
        self.products.get(a).and_then(|row| row.get(b)).copied().unwrap_or_default()
    }

    /// Returns the distinguishable ones of `candidates`, earlier ones first, and the others.
    pub(super) fn told_apart(&self, candidates: &[usize]) -> (Vec<usize>, Vec<LeftOutTerm>) {
        let (mut retained, mut left_out): (Vec<usize>, Vec<LeftOutTerm>) = (Vec::new(), Vec::new());
        for unknown in candidates.iter().copied() {
            let own = self.product(unknown, unknown);
            let square = self.squares.get(unknown).copied().unwrap_or_default();
            let shares = self.factor(&retained).solve(|other| self.product(other, unknown));
            let made: f64 =
                retained.iter().zip(&shares).map(|(k, s)| s * self.product(*k, unknown)).sum();
            if own > 0.0 && own - made > square / MAX_INFLATION {
                retained.push(unknown);
                continue;
            }
            let is_large = |(other, share): &(&usize, &f64)| {
                share.powi(2) * self.product(**other, **other) > NAMED_SHARE.powi(2) * own
            };
            let named = retained.iter().zip(&shares).filter(is_large).map(|(other, _)| *other);
            let named = if own > 0.0 { named.collect() } else { Vec::new() };
            left_out.push(LeftOutTerm { unknown, named });
        }
        (retained, left_out)
    }

    /// Returns the change of each unknown in `retained` by one unit of the omitted term.
    pub(super) fn moves(&self, retained: &[usize], left_out: &LeftOutTerm) -> Vec<(usize, f64)> {
        let shares = self.factor(retained).solve(|other| self.product(other, left_out.unknown));
        retained.iter().copied().zip(shares).collect()
    }

    /// Solves for the unknowns `retained`. `log_scale`: logarithm of the determinant by which the
    /// equations were scaled.
    pub(super) fn solve(&self, retained: &[usize], log_scale: f64) -> Estimate<N> {
        let factor = self.factor(retained);
        let right = |unknown: usize| self.right.get(unknown).copied().unwrap_or_default();
        let found = factor.solve(right);
        let explained: f64 = retained.iter().zip(&found).map(|(k, value)| right(*k) * value).sum();
        let (mut values, mut covariance) = ([0.0; N], [[0.0; N]; N]);
        for (unknown, value) in retained.iter().zip(found) {
            if let Some(place) = values.get_mut(*unknown) {
                *place = value;
            }
            let column = factor.solve(|other| f64::from(u8::from(other == *unknown)));
            for (other, value) in retained.iter().zip(column) {
                let place = covariance.get_mut(*other).and_then(|row| row.get_mut(*unknown));
                if let Some(place) = place {
                    *place = value;
                }
            }
        }
        let freedom = self.freedom(retained.len()) as f64;
        let variance = ((self.value - explained) / freedom).max(f64::MIN_POSITIVE);
        let log_determinant = log_scale + self.log_eliminated + factor.log_determinant();
        let log_likelihood = -0.5 * (freedom * variance.ln() + log_determinant);
        Estimate { values, covariance, variance, log_likelihood }
    }

    /// Factors the equations of `retained`, by Cholesky with columns of length one.
    fn factor(&self, retained: &[usize]) -> Factor {
        let lengths: Vec<f64> = retained.iter().map(|k| self.product(*k, *k).sqrt()).collect();
        let mut rows: Vec<Vec<f64>> = Vec::new();
        for (a, length) in retained.iter().zip(&lengths) {
            let mut row: Vec<f64> = Vec::new();
            for ((b, other_length), other) in retained.iter().zip(&lengths).zip(&rows) {
                let product = self.product(*a, *b) / (length * other_length);
                let (before, own) = (dot(&row, other), other.last().copied().unwrap_or(1.0));
                row.push((product - before) / own);
            }
            let own = (1.0 - dot(&row, &row)).max(f64::MIN_POSITIVE).sqrt();
            row.push(own);
            rows.push(row);
        }
        Factor { retained: retained.to_vec(), lengths, rows }
    }
}

/// Cholesky factor of the equations of some unknowns.
struct Factor {
    retained: Vec<usize>,
    lengths: Vec<f64>,
    /// Lower triangle, for columns of length one.
    rows: Vec<Vec<f64>>,
}

impl Factor {
    fn log_determinant(&self) -> f64 {
        let diagonal = self.rows.iter().filter_map(|row| row.last());
        2.0 * diagonal.zip(&self.lengths).map(|(value, length)| (value * length).ln()).sum::<f64>()
    }

    /// Solves the equations for a right-hand side.
    fn solve(&self, right: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut found: Vec<f64> = Vec::new();
        for ((unknown, length), row) in self.retained.iter().zip(&self.lengths).zip(&self.rows) {
            let rest = right(*unknown) / length - dot(row, &found);
            found.push(rest / row.last().copied().unwrap_or(1.0));
        }
        for (index, row) in self.rows.iter().enumerate().rev() {
            let diagonal = row.last().copied().unwrap_or(1.0);
            let value = found.get(index).copied().unwrap_or_default() / diagonal;
            for (before, part) in found.iter_mut().zip(row).take(index) {
                *before -= part * value;
            }
            if let Some(place) = found.get_mut(index) {
                *place = value;
            }
        }
        found.iter().zip(&self.lengths).map(|(value, length)| value / length).collect()
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
