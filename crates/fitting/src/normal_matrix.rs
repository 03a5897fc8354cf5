//! The normal matrix of the stride fit and its Cholesky factor.
//!
//! Panels form a ring in which each touches its two neighbours on either side, and all of them touch the shared
//! lengths. The last two panels of the ring and the lengths are taken as a border, which leaves a band of blocks:
//!
//! ```text
//! D0                    each column of blocks is stored as one tall matrix:
//! E0 D1                 diagonal, next, next but one, border
//! F0 E1 D2
//!    F1 E2 D3
//! B0 B1 B2 B3 C
//! ```

use nalgebra::{DMatrix, DVector};

use crate::layout::{Layout, PANEL_DOF, SHARED};

const BORDER: usize = 2 * PANEL_DOF + SHARED;
const BAND: usize = 3 * PANEL_DOF;
const ROWS: usize = BAND + BORDER;

/// Symmetric matrix of the band-and-border form; only the lower triangle is kept.
#[derive(Clone, Debug)]
pub struct NormalMatrix {
    columns: Vec<DMatrix<f64>>,
    corner: DMatrix<f64>,
}

/// Where an entry of the lower triangle is kept.
enum Place {
    Column { block: usize, row: usize, column: usize },
    Corner { row: usize, column: usize },
}

impl NormalMatrix {
    /// A zero matrix for a stride of at least four panels.
    pub fn zeros(layout: Layout) -> Self {
        assert!(layout.panels >= 4, "a cyclic second difference needs four panels");
        Self {
            columns: vec![DMatrix::zeros(ROWS, PANEL_DOF); layout.panels - 2],
            corner: DMatrix::zeros(BORDER, BORDER),
        }
    }

    /// Number of unknowns.
    pub fn dimension(&self) -> usize {
        self.columns.len() * PANEL_DOF + BORDER
    }

    fn place(&self, i: usize, j: usize) -> Place {
        let (row, column) = if i >= j { (i, j) } else { (j, i) };
        let border = self.columns.len() * PANEL_DOF;
        if column >= border {
            return Place::Corner { row: row - border, column: column - border };
        }
        let block = column / PANEL_DOF;
        let row = if row >= border { BAND + row - border } else { row - block * PANEL_DOF };
        debug_assert!(row < ROWS && (row < BAND || i.max(j) >= border), "entry outside the band");
        Place::Column { block, row, column: column % PANEL_DOF }
    }

    /// Adds to an entry; `(i, j)` and `(j, i)` are the same one.
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        match self.place(i, j) {
            Place::Column { block, row, column } => self.columns[block][(row, column)] += value,
            Place::Corner { row, column } => self.corner[(row, column)] += value,
        }
    }

    /// Entry `(i, j)`.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        match self.place(i, j) {
            Place::Column { block, row, column } => self.columns[block][(row, column)],
            Place::Corner { row, column } => self.corner[(row, column)],
        }
    }

    /// Adds the outer product of a sparse row with itself, times a weight.
    pub fn add_row(&mut self, row: &[(usize, f64)], weight: f64) {
        for (k, &(i, a)) in row.iter().enumerate() {
            let a = weight * a;
            self.add(i, i, a * row[k].1);
            for &(j, b) in &row[..k] {
                // An unknown that stands twice in a row contributes the cross term to the diagonal twice.
                self.add(i, j, if i == j { 2.0 * a * b } else { a * b });
            }
        }
    }

    /// The diagonal.
    pub fn diagonal(&self) -> Vec<f64> {
        (0..self.dimension()).map(|i| self.get(i, i)).collect()
    }

    /// Product with a vector.
    pub fn multiply(&self, x: &[f64]) -> Vec<f64> {
        let border = self.columns.len() * PANEL_DOF;
        let mut y = vec![0.0; x.len()];
        for (block, column) in self.columns.iter().enumerate() {
            let start = block * PANEL_DOF;
            for c in 0..PANEL_DOF {
                let j = start + c;
                for (r, &value) in column.column(c).iter().enumerate().skip(c) {
                    if value == 0.0 {
                        continue;
                    }
                    let i = if r < BAND { start + r } else { border + r - BAND };
                    y[i] += value * x[j];
                    if i != j {
                        y[j] += value * x[i];
                    }
                }
            }
        }
        for c in 0..BORDER {
            for r in c..BORDER {
                let value = self.corner[(r, c)];
                y[border + r] += value * x[border + c];
                if r != c {
                    y[border + c] += value * x[border + r];
                }
            }
        }
        y
    }

    /// Empties the row and column of each pinned unknown but for a one on the diagonal.
    fn pin(&mut self, pinned: &[bool]) {
        let border = self.columns.len() * PANEL_DOF;
        let is_pinned = |i: usize| pinned.get(i).copied().unwrap_or(false);
        for (block, column) in self.columns.iter_mut().enumerate() {
            let start = block * PANEL_DOF;
            for c in 0..PANEL_DOF {
                for r in c..ROWS {
                    let i = if r < BAND { start + r } else { border + r - BAND };
                    if is_pinned(start + c) || is_pinned(i) {
                        column[(r, c)] = if r == c { 1.0 } else { 0.0 };
                    }
                }
            }
        }
        for c in 0..BORDER {
            for r in c..BORDER {
                if is_pinned(border + c) || is_pinned(border + r) {
                    self.corner[(r, c)] = if r == c { 1.0 } else { 0.0 };
                }
            }
        }
    }

    /// Cholesky factor of the matrix with `damping` added to its diagonal and the pinned unknowns taken out; none
    /// when it is not positive definite.
    pub fn factor(&self, damping: &[f64], pinned: &[bool]) -> Option<Factor> {
        let mut work = self.clone();
        for (i, value) in damping.iter().enumerate() {
            work.add(i, i, *value);
        }
        if pinned.iter().any(|p| *p) {
            work.pin(pinned);
        }
        let n = work.columns.len();
        for block in 0..n {
            let (head, tail) = work.columns.split_at_mut(block + 1);
            let column = &mut head[block];
            if block + 1 >= n {
                column.rows_mut(PANEL_DOF, PANEL_DOF).fill(0.0);
            }
            if block + 2 >= n {
                column.rows_mut(2 * PANEL_DOF, PANEL_DOF).fill(0.0);
            }
            eliminate(column)?;
            let transposed = column.rows(PANEL_DOF, ROWS - PANEL_DOF).transpose();
            if let Some(next) = tail.get_mut(0) {
                let rows = column.rows(PANEL_DOF, 2 * PANEL_DOF);
                next.rows_mut(0, 2 * PANEL_DOF).gemm(-1.0, &rows, &transposed.columns(0, PANEL_DOF), 1.0);
                let border = column.rows(BAND, BORDER);
                next.rows_mut(BAND, BORDER).gemm(-1.0, &border, &transposed.columns(0, PANEL_DOF), 1.0);
            }
            if let Some(after) = tail.get_mut(1) {
                let rows = column.rows(2 * PANEL_DOF, PANEL_DOF);
                let right = transposed.columns(PANEL_DOF, PANEL_DOF);
                after.rows_mut(0, PANEL_DOF).gemm(-1.0, &rows, &right, 1.0);
                after.rows_mut(BAND, BORDER).gemm(-1.0, &column.rows(BAND, BORDER), &right, 1.0);
            }
            let right = transposed.columns(2 * PANEL_DOF, BORDER);
            work.corner.gemm(-1.0, &column.rows(BAND, BORDER), &right, 1.0);
        }
        eliminate(&mut work.corner)?;
        Some(Factor { columns: work.columns, corner: work.corner })
    }
}

/// In-place Cholesky of the square head of a tall matrix, applied to the rows below it: `X <- X L^-T`.
fn eliminate(tall: &mut DMatrix<f64>) -> Option<()> {
    let (rows, n) = tall.shape();
    let data = tall.as_mut_slice();
    for k in 0..n {
        let (left, right) = data.split_at_mut(k * rows);
        let column = &mut right[..rows];
        for j in 0..k {
            let factor = left[j * rows + k];
            if factor != 0.0 {
                for (target, source) in column[k..].iter_mut().zip(&left[j * rows + k..(j + 1) * rows]) {
                    *target -= factor * source;
                }
            }
        }
        let pivot = column[k];
        if !(pivot > 0.0 && pivot.is_finite()) {
            return None;
        }
        let root = pivot.sqrt();
        for value in &mut column[k..] {
            *value /= root;
        }
    }
    Some(())
}

/// Cholesky factor; solves systems with the matrix.
#[derive(Clone, Debug)]
pub struct Factor {
    columns: Vec<DMatrix<f64>>,
    corner: DMatrix<f64>,
}

impl Factor {
    /// Solves for one right-hand side.
    pub fn solve(&self, right: &[f64]) -> Vec<f64> {
        let border = self.columns.len() * PANEL_DOF;
        let mut x = DVector::from_column_slice(right);
        for (block, column) in self.columns.iter().enumerate() {
            let start = block * PANEL_DOF;
            for c in 0..PANEL_DOF {
                let value = x[start + c] / column[(c, c)];
                x[start + c] = value;
                let below = &column.column(c);
                for r in c + 1..BAND.min(border - start) {
                    x[start + r] -= value * below[r];
                }
                for r in 0..BORDER {
                    x[border + r] -= value * below[BAND + r];
                }
            }
        }
        for c in 0..BORDER {
            let value = x[border + c] / self.corner[(c, c)];
            x[border + c] = value;
            for r in c + 1..BORDER {
                x[border + r] -= value * self.corner[(r, c)];
            }
        }
        for c in (0..BORDER).rev() {
            let sum: f64 = (c + 1..BORDER).map(|r| self.corner[(r, c)] * x[border + r]).sum();
            x[border + c] = (x[border + c] - sum) / self.corner[(c, c)];
        }
        for (block, column) in self.columns.iter().enumerate().rev() {
            let start = block * PANEL_DOF;
            for c in (0..PANEL_DOF).rev() {
                let below = &column.column(c);
                let band: f64 = (c + 1..BAND.min(border - start)).map(|r| below[r] * x[start + r]).sum();
                let tail: f64 = (0..BORDER).map(|r| below[BAND + r] * x[border + r]).sum();
                x[start + c] = (x[start + c] - band - tail) / column[(c, c)];
            }
        }
        x.as_slice().to_vec()
    }

    /// Diagonal of the inverse: variances, when the matrix is a normal matrix of unit-variance residuals.
    pub fn inverse_diagonal(&self) -> Vec<f64> {
        let n = self.columns.len() * PANEL_DOF + BORDER;
        let mut unit = vec![0.0; n];
        (0..n)
            .map(|i| {
                unit[i] = 1.0;
                let column = self.solve(&unit);
                unit[i] = 0.0;
                column[i]
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A random-looking matrix of the right pattern, and the same as a dense one.
    fn example(panels: usize) -> (NormalMatrix, DMatrix<f64>) {
        let layout = Layout { panels };
        let n = layout.dimension();
        let mut matrix = NormalMatrix::zeros(layout);
        let mut dense = DMatrix::zeros(n, n);
        let mut seed = 1u64;
        let mut random = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 33) as f64 / (1u64 << 31) as f64 - 0.5
        };
        for slot in 0..panels {
            for _ in 0..80 {
                let other = (slot + (random().abs() * 6.0) as usize) % panels;
                let other = if (other + panels - slot) % panels <= 2 { other } else { slot };
                let pick = |r: f64, m: usize| ((r + 0.5) * m as f64) as usize;
                let row = [
                    (layout.panel(slot, pick(random(), PANEL_DOF)), random()),
                    (layout.panel(other, pick(random(), PANEL_DOF)), random()),
                    (layout.shared(pick(random(), SHARED)), random()),
                ];
                matrix.add_row(&row, 1.0);
                for &(i, a) in &row {
                    for &(j, b) in &row {
                        dense[(i, j)] += a * b;
                    }
                }
            }
        }
        for i in 0..n {
            matrix.add(i, i, 1.0);
            dense[(i, i)] += 1.0;
        }
        (matrix, dense)
    }

    #[test]
    fn factor_solves_what_a_dense_solver_solves() {
        for panels in [4, 5, 6, 11, 24] {
            let (matrix, dense) = example(panels);
            let right: Vec<f64> = (0..matrix.dimension()).map(|i| (i as f64 * 0.7).sin()).collect();
            let expected = dense.clone().cholesky().unwrap().solve(&DVector::from_vec(right.clone()));
            let found = matrix.factor(&[], &[]).unwrap().solve(&right);
            let error = found.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(error < 1e-9, "{panels} panels: {error}");
            let product = matrix.multiply(&found);
            let error = product.iter().zip(&right).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(error < 1e-9, "{panels} panels: product off by {error}");
        }
    }

    #[test]
    fn pinned_unknowns_keep_their_right_hand_side_out_of_the_others() {
        let (matrix, mut dense) = example(6);
        let n = matrix.dimension();
        let pinned: Vec<bool> = (0..n).map(|i| i % 7 == 3).collect();
        let right: Vec<f64> = (0..n).map(|i| if pinned[i] { 0.0 } else { (i as f64).cos() }).collect();
        for i in (0..n).filter(|i| pinned[*i]) {
            dense.row_mut(i).fill(0.0);
            dense.column_mut(i).fill(0.0);
            dense[(i, i)] = 1.0;
        }
        let expected = dense.cholesky().unwrap().solve(&DVector::from_vec(right.clone()));
        let found = matrix.factor(&[], &pinned).unwrap().solve(&right);
        assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-9));
    }

    #[test]
    fn an_indefinite_matrix_has_no_factor() {
        let (mut matrix, _) = example(5);
        matrix.add(40, 40, -1e6);
        assert!(matrix.factor(&[], &[]).is_none());
    }
}
